"""The scheme of a mechanism as in books: bars and plates, pins, hatched ground, blocks, and the
arrow of the driver's rotation."""

import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from itertools import chain, combinations, pairwise
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Arc, Circle
from matplotlib.patches import Polygon as Patch
from matplotlib.path import Path

from analytic.kinematics import reach, solve_driven
from analytic.lectures.drawings.polygon import PlacedMechanism, quarter_turn
from models.array import Array, Mask
from models.errors import CrankcheckError, ReachError
from models.scene import GROUND, Link, Scene
from models.scene.laws import Oscillating
from reports.figures.style import INK
from reports.lectures.drawing.sheets.letters import Letter, together
from reports.lectures.drawing.sheets.paper import arrow_head, line


def range_about(scene: Scene, theta: float) -> tuple[float, float]:
    """The reachable range [rad] around an angle of the driver, near to that angle.

    Raises CrankcheckError where the scene can not be assembled there.
    """
    for low, high in reach(scene):
        shift = 0.0
        if scene.driver.slider is None:
            shift = math.tau * round((theta - 0.5 * (low + high)) / math.tau)
        if low + shift - 1e-9 <= theta <= high + shift + 1e-9:
            return low + shift, high + shift
    slides = scene.driver.slider is not None
    place = f"{theta:g} m" if slides else f"{math.degrees(theta):g} deg"
    raise CrankcheckError(f"{scene.name}: can not be assembled at {place}")


def assembled(scene: Scene, theta: Array) -> Mask:
    """True at driver angles (T,) where the scene can be assembled; a range may have single
    exceptions, singular positions."""
    possible = np.ones(theta.shape, dtype=bool)
    parts, one = [np.arange(theta.size)], np.ones(1)
    while parts:
        part = parts.pop()
        try:
            solve_driven(
                scene, theta[part], one, 0.0 * one, links=(), points=(), sliders=(), bound=False
            )
        except ReachError:
            if part.size == 1:
                possible[part] = False
            else:
                parts += np.array_split(part, 2)
    return possible


def sense_of_law(scene: Scene) -> float:
    """1 for a driver that starts counter-clockwise, -1 for one that starts clockwise."""
    return math.copysign(1.0, float(scene.driver.law.at(np.zeros(1))[1][0]))


def range_of_law(scene: Scene) -> tuple[float, float]:
    """The range of the driver by its law, or from its start [rad or m]; as `range_about`."""
    law = scene.driver.law
    if isinstance(law, Oscillating):
        swing = abs(law.amplitude_rad)
        return law.centre_rad - swing, law.centre_rad + swing
    start = float(law.at(np.zeros(1))[0][0])
    if scene.driver.slider is not None:  # it goes no further than the way of a run
        end = float(law.at(np.array([law.period_s]))[0][0])
        return min(start, end), max(start, end)
    return range_about(scene, start)


SLOT_MM, SLOT_SPARE_MM = 1.5, 4.0
"""Half the width of a slot in a link, and its length beyond the block's travel [mm]."""
TRAVEL, LONGEST = 73, 2.0
"""Number of driver angles in the search for travel; the longest drawn travel to either side, over
the longest link: near a singular position a block goes far away."""
ALONG = 0.005
"""Distance of a bar from a slider's line, over the longest link, below which it is its guide."""
LOOKED_AT = 61
"""Places along a slot at which the bar may be joined to it."""

Travel = tuple[Array, Array]


def travels(placement: PlacedMechanism) -> dict[str, Travel]:
    """The ends of the travel [m], (2,) each, of every block that needs a slot, its link as placed.

    Raises CrankcheckError as `range_about`.
    """
    scene, here = placement.scene, placement.driver.theta
    names = [n for n, s in scene.sliders.items() if s.on != GROUND and not _on_bar(placement, n)]
    if not names:
        return {}
    looked_at = np.linspace(*range_about(scene, here), TRAVEL)[1:-1]
    angles = np.append(looked_at[assembled(scene, looked_at)], here)
    ones = np.ones_like(angles)
    motion = solve_driven(
        scene, angles, ones, 0.0 * ones, links=(), points=(), sliders=names, bound=False
    )
    ends = {}
    most = LONGEST * scene.longest_m
    for name in names:
        moved = motion.sliders[name].displacement - motion.sliders[name].displacement[-1]
        block, along = placement.points[scene.sliders[name].point], placement.along(name)
        low, high = np.clip([moved.min(), moved.max()], -most, most)
        ends[name] = (block + low * along, block + high * along)
    return ends


def _on_bar(placement: PlacedMechanism, name: str) -> bool:
    """True if a slider runs along the bar of its guide, which is then drawn through its block."""
    slider = placement.scene.sliders[name]
    points = placement.scene.links[slider.on].points
    ends = [placement.points[point] - placement.points[slider.point] for point in points]
    across = quarter_turn(placement.along(name))
    return max(abs(float(end @ across)) for end in ends) < ALONG * placement.scene.longest_m


def draw_slots(
    axes: Axes, placement: PlacedMechanism, places: Mapping[str, Array], ends: Mapping[str, Travel]
) -> None:
    """Draw slots with the ends of travel at ``ends``, the links' points at ``places`` [mm]."""
    for name, (low, high) in ends.items():
        along = placement.along(name)
        start, end = low - SLOT_SPARE_MM * along, high + SLOT_SPARE_MM * along
        guide = placement.scene.links[placement.scene.sliders[name].on]
        corners = [places[point] for point in guide.points]
        if not _within(corners, (start + end) / 2):
            _draw_arm(axes, np.linspace(start, end, LOOKED_AT), corners)
        aside = SLOT_MM * quarter_turn(along)
        ring = [start + aside, end + aside, end - aside, start - aside]
        axes.add_patch(Patch(ring, closed=True, fc="white", ec=INK, lw=1.0, zorder=2))


def _within(corners: list[Array], place: Array) -> bool:
    return len(corners) > 2 and bool(Path(np.array(corners)).contains_point(tuple(place)))


def _draw_arm(axes: Axes, slot: Array, corners: list[Array]) -> None:
    """Draw the shortest arm from a link to the slot (n, 2) that it carries, unless they meet."""
    nearest = [_foot(at, *edge) for edge in combinations(corners, 2) for at in slot]
    nearest = nearest or [corners[0]] * len(slot)  # a link of one point
    froms = np.tile(slot, (len(nearest) // len(slot), 1))
    apart = np.hypot(*(froms - nearest).T)
    best = int(apart.argmin())
    if apart[best] > SLOT_MM:
        line(axes, froms[best], nearest[best], linewidth=1.5, zorder=1)


def _foot(place: Array, start: Array, end: Array) -> Array:
    """The nearest point of a bar to a place."""
    along = end - start
    share = float((place - start) @ along) / max(float(along @ along), 1e-30)
    return np.asarray(start + min(max(share, 0.0), 1.0) * along)


PIN_MM, BLOCK_MM, FOOT_MM = 1.0, (6.0, 3.6), 3.8
HATCH_MM, HATCHES = 1.3, 6
TURN_MM, TURN_SHARE, TURN_DEG = (5.0, 9.0), 0.4, (22.0, 85.0)
"""The arrow of rotation: least and largest radius, share of the crank, and angles off the crank."""
FOOT_DEG = 42.0
"""Half the angle about a pin that its foot occupies."""
NEAR_MM = 0.5
"""Distance of points [mm] below which their letters share a label."""
PLATE = "#eef1f4"
FRONT = 6
"""Drawing order of pins: over everything."""


def extent_of(placement: PlacedMechanism) -> Array:
    """The places that the scheme must contain: points, and ends of slots [m], (n, 2)."""
    return np.array([*placement.points.values(), *chain(*travels(placement).values())])


def draw_scheme(
    axes: Axes, placement: PlacedMechanism, at: Callable[[Array], Array], plate: str = PLATE
) -> None:
    """Draw the mechanism; ``at`` gives the place on the sheet [mm] of a place [m], ``plate`` is the
    colour of plates, "none" for plates that hide nothing."""
    scene = placement.scene
    places = {name: at(place) for name, place in placement.points.items()}
    slots = {name: (at(low), at(high)) for name, (low, high) in travels(placement).items()}
    draw_slots(axes, placement, places, slots)
    for name, slider in scene.sliders.items():
        along = placement.along(name)
        if slider.link is not None and slider.on == GROUND:
            bar = [places[point] for point in scene.links[slider.link].points]
            _rails(axes, np.mean(bar, axis=0), along)
            continue
        draw_block(axes, places[slider.point], along, BLOCK_MM)
        if slider.on == GROUND:
            _rails(axes, places[slider.point], along)
    for link in scene.links.values():
        corners = np.array([places[point] for point in link.points])
        if len(corners) > 2 and not _flat(corners):
            axes.add_patch(Patch(corners, closed=True, fc=plate, ec=INK, lw=1.3, joinstyle="round"))
        else:
            for start, end in _segments(corners):
                line(axes, start, end, f"scheme-{link.name}", linewidth=1.5)
    pinned = [point for point, bodies in placement.structure.pins.items() if len(bodies) > 1]
    for point in scene.ground:
        if point in pinned:
            draw_foot(axes, places[point])
    for point, spot in places.items():
        radius = PIN_MM if point in pinned else 0.5 * PIN_MM
        face = "white" if point in pinned else INK
        axes.add_patch(Circle(tuple(spot), radius, fc=face, ec=INK, lw=0.7, zorder=FRONT))
    if scene.driver.is_crank:
        _turning(axes, placement, places)
    else:
        _moved_joint(axes, placement, places)


def draw_outline(
    axes: Axes, links: Iterable[Link], places: Mapping[str, Array], color: str, width: float
) -> None:
    """Draw links as lines between their points at ``places`` [mm]."""
    for link in links:
        ring = [places[name] for name in link.points]
        ring = [*ring, ring[0]] if len(ring) > 2 else ring
        for start, end in pairwise(ring):
            line(axes, start, end, color=color, linewidth=width)


def point_letters(placement: PlacedMechanism, places: Mapping[str, Array]) -> list[Letter]:
    """The letters of the points at ``places`` [mm]; points that coincide have one label."""
    joined = together(places, NEAR_MM)
    return [
        Letter(names, at, max(symbol_radius(placement, name) for name in names.split(", ")))
        for names, at in joined.items()
    ]


def symbol_radius(placement: PlacedMechanism, point: str) -> float:
    """Least radius of the symbol drawn at a point [mm]."""
    sliding = any(slider.point == point for slider in placement.scene.sliders.values())
    return 0.5 * BLOCK_MM[1] if sliding else PIN_MM


def _segments(corners: Array) -> Iterator[tuple[Array, Array]]:
    """The bar from end to end of points on a line, or of two."""
    if len(corners) > 1:
        apart = np.linalg.norm(corners[:, None] - corners[None], axis=-1)
        i, j = np.unravel_index(int(apart.argmax()), apart.shape)
        yield corners[i], corners[j]


def _flat(corners: Array) -> bool:
    spread = np.linalg.svd(corners - corners.mean(axis=0), compute_uv=False)
    return bool(spread[1] < 1e-6 * spread[0])


def draw_foot(axes: Axes, place: Array) -> None:
    """Draw a pin's support on hatched ground."""
    side, spare = np.array([0.6 * FOOT_MM, 0.0]), np.array([1.0, 0.0])
    left, right = place - (0.0, FOOT_MM) - side, place - (0.0, FOOT_MM) + side
    axes.add_patch(Patch([place, left, right], closed=True, fc="white", ec=INK, lw=0.7))
    _hatched(axes, left - spare, right + spare)


def _hatched(axes: Axes, start: Array, end: Array) -> None:
    """Draw ground: a line with short strokes on its right side."""
    along = end - start
    length = math.hypot(*along)
    unit = along / length
    stroke = HATCH_MM * np.array([unit[1] - unit[0], -unit[0] - unit[1]]) / math.sqrt(2)
    line(axes, start, end, linewidth=0.8)
    for share in np.linspace(0.15, 1.0, HATCHES):
        at = start + share * along
        line(axes, at, at + stroke, linewidth=0.5)


def draw_block(
    axes: Axes, place: Array, along: Array, size: tuple[float, float], zorder: int = 3
) -> None:
    """Draw a block of a length and width [mm] along a unit vector."""
    half, aside = 0.5 * size[0] * along, 0.5 * size[1] * quarter_turn(along)
    signs = ((1, 1), (-1, 1), (-1, -1), (1, -1))
    corners = [place + a * half + b * aside for a, b in signs]
    axes.add_patch(Patch(corners, closed=True, fc="white", ec=INK, lw=0.8, zorder=zorder))


def _rails(axes: Axes, place: Array, along: Array) -> None:
    """Draw a guide of the ground, hatched on both sides of the sliding part."""
    reach, aside = 1.2 * BLOCK_MM[0] * along, 0.5 * BLOCK_MM[1] * quarter_turn(along)
    for side in (-1.0, 1.0):
        _hatched(axes, place + side * (aside + reach), place + side * (aside - reach))


def _turning(axes: Axes, placement: PlacedMechanism, places: Mapping[str, Array]) -> None:
    """Draw the arrow of the driver's rotation about its pivot; a swing has two heads."""
    scene, theta = placement.scene, math.degrees(placement.driver.theta)
    middle = places[scene.driver_pivot]
    crank = max(math.dist(places[p], middle) for p in scene.links[scene.driver.link].points)
    radius = min(max(TURN_SHARE * crank, TURN_MM[0]), TURN_MM[1])
    sense = math.copysign(1.0, placement.driver.omega)
    near, far = TURN_DEG
    # before the crank, or behind it where its foot is before it
    ahead = theta + sense * (near + far) / 2
    off_foot = abs((ahead + 90.0 + 180.0) % 360.0 - 180.0)
    start, end = (near, far) if off_foot > FOOT_DEG + (far - near) / 2 else (-far, -near)
    ends = [theta + sense * start, theta + sense * end]
    look: dict[str, Any] = {"theta1": min(ends), "theta2": max(ends), "color": INK, "lw": 0.8}
    axes.add_patch(Arc(tuple(middle), 2 * radius, 2 * radius, **look))
    heads = [(ends[1], sense)]
    if isinstance(scene.driver.law, Oscillating):
        heads.append((ends[0], -sense))
    for angle, way in heads:
        radial = np.array([math.cos(math.radians(angle)), math.sin(math.radians(angle))])
        arrow_head(axes, middle + radius * radial, way * quarter_turn(radial), INK)


def _moved_joint(axes: Axes, placement: PlacedMechanism, places: Mapping[str, Array]) -> None:
    """Draw a driver that is no crank: a slider with an arrow along its line, a pin with a dot."""
    driver = placement.scene.driver
    if driver.slider is None:
        spot = tuple(places[placement.scene.driver_pivot])
        axes.add_patch(Circle(spot, 0.5 * PIN_MM, fc=INK, ec=INK, zorder=FRONT + 1))
        return
    way = math.copysign(1.0, placement.driver.omega) * placement.along(driver.slider)
    start = places[placement.scene.sliders[driver.slider].point] + 0.6 * BLOCK_MM[0] * way
    line(axes, start, start + 4.0 * way, linewidth=0.8)
    arrow_head(axes, start + 4.0 * way, way, INK)
