"""The scheme of a mechanism as books draw it: bars and plates, pins, hatched ground, blocks, slots,
and the arrow of the driver's rotation."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Arc, Circle
from matplotlib.patches import Polygon as Patch

from analytic.drawings.placed_mechanism import PlacedMechanism, quarter_turn
from analytic.kinematics import solve_driven
from models.array import Array
from models.laws import Oscillating
from models.scene import GROUND
from reports.figures.style import INK
from reports.sheets.canvas import arrow_head, line
from reports.sheets.driver_range import range_about
from reports.sheets.letters import Letter, together

PIN_MM, BLOCK_MM, FOOT_MM = 1.0, (6.0, 3.6), 3.8
HATCH_MM, HATCHES = 1.3, 6
SLOT_MM, SLOT_SPARE_MM = 1.5, 4.0
"""Half the width of a slot in a link, and how far it goes on beyond the block's travel."""
TRAVEL = 73
"""Driver angles over which travel is looked for."""
TURN_MM, TURN_SHARE, TURN_DEG = (5.0, 9.0), 0.4, (22.0, 85.0)
"""The arrow of rotation: least and largest radius, share of the crank, and angles off the crank."""
FOOT_DEG = 42.0
"""Half the angle about a pin that its foot is in."""
NEAR_MM = 0.5
"""Points that stand nearer have their letters in one label."""
FRONT = 6
"""Pins lie over everything."""


def draw_scheme(axes: Axes, placement: PlacedMechanism, places: Mapping[str, Array]) -> None:
    """The mechanism with its points at ``places`` [mm]."""
    scene = placement.scene
    _slots(axes, placement, places)
    for name, slider in scene.sliders.items():
        along = placement.along(name)
        if slider.link is not None and slider.on == GROUND:
            bar = [places[point] for point in scene.links[slider.link].points]
            _rails(axes, np.mean(bar, axis=0), along)
            continue
        _block(axes, places[slider.point], along)
        if slider.on == GROUND:
            _rails(axes, places[slider.point], along)
    for link in scene.links.values():
        corners = np.array([places[point] for point in link.points])
        if len(corners) > 2 and not _flat(corners):
            axes.add_patch(
                Patch(corners, closed=True, fc="#eef1f4", ec=INK, lw=1.3, joinstyle="round")
            )
        else:
            for start, end in _segments(corners):
                line(axes, start, end, f"scheme-{link.name}", linewidth=1.5)
    pinned = [point for point, bodies in placement.structure.pins.items() if len(bodies) > 1]
    for point in scene.ground:
        if point in pinned:
            _foot(axes, places[point])
    for point, at in places.items():
        radius = PIN_MM if point in pinned else 0.5 * PIN_MM
        face = "white" if point in pinned else INK
        axes.add_patch(Circle(tuple(at), radius, fc=face, ec=INK, lw=0.7, zorder=FRONT))
    _turning(axes, placement, places)


def point_letters(placement: PlacedMechanism, places: Mapping[str, Array]) -> list[Letter]:
    """The letters of the points at ``places`` [mm]; of points that fall together, one label."""
    joined = together(places, NEAR_MM)
    return [
        Letter(names, at, max(symbol_radius(placement, name) for name in names.split(", ")))
        for names, at in joined.items()
    ]


def symbol_radius(placement: PlacedMechanism, point: str) -> float:
    """How far what is drawn at a point reaches from it at least [mm]."""
    sliding = any(slider.point == point for slider in placement.scene.sliders.values())
    return 0.5 * BLOCK_MM[1] if sliding else PIN_MM


def _segments(corners: Array) -> Iterator[tuple[Array, Array]]:
    """The bar from end to end of points on a line, or of two."""
    if len(corners) > 1:
        apart = np.linalg.norm(corners[:, None] - corners[None], axis=-1)
        i, j = np.unravel_index(int(apart.argmax()), apart.shape)
        yield corners[i], corners[j]


def _flat(corners: Array) -> bool:
    """Whether points stand in a line."""
    spread = np.linalg.svd(corners - corners.mean(axis=0), compute_uv=False)
    return bool(spread[1] < 1e-6 * spread[0])


def _foot(axes: Axes, place: Array) -> None:
    """A pin's support on hatched ground."""
    side, spare = np.array([0.6 * FOOT_MM, 0.0]), np.array([1.0, 0.0])
    left, right = place - (0.0, FOOT_MM) - side, place - (0.0, FOOT_MM) + side
    axes.add_patch(Patch([place, left, right], closed=True, fc="white", ec=INK, lw=0.7))
    _hatched(axes, left - spare, right + spare)


def _hatched(axes: Axes, start: Array, end: Array) -> None:
    """Ground: a line with short strokes on its right side."""
    along = end - start
    length = math.hypot(*along)
    unit = along / length
    stroke = HATCH_MM * np.array([unit[1] - unit[0], -unit[0] - unit[1]]) / math.sqrt(2)
    line(axes, start, end, linewidth=0.8)
    for share in np.linspace(0.15, 1.0, HATCHES):
        at = start + share * along
        line(axes, at, at + stroke, linewidth=0.5)


def _block(axes: Axes, place: Array, along: Array) -> None:
    """The block of a slider."""
    half, aside = 0.5 * BLOCK_MM[0] * along, 0.5 * BLOCK_MM[1] * quarter_turn(along)
    corners = [
        place + half + aside,
        place - half + aside,
        place - half - aside,
        place + half - aside,
    ]
    axes.add_patch(Patch(corners, closed=True, fc="white", ec=INK, lw=0.8, zorder=3))


def _rails(axes: Axes, place: Array, along: Array) -> None:
    """A guide of the ground, hatched on both sides of what slides in it."""
    reach, aside = 1.2 * BLOCK_MM[0] * along, 0.5 * BLOCK_MM[1] * quarter_turn(along)
    for side in (-1.0, 1.0):
        _hatched(axes, place + side * (aside + reach), place + side * (aside - reach))


def _slots(axes: Axes, placement: PlacedMechanism, places: Mapping[str, Array]) -> None:
    """Slots of moving links that are not along their bars, as long as the block travels."""
    scene = placement.scene
    slotted = [name for name, s in scene.sliders.items() if s.on != GROUND]
    crossing = [n for n in slotted if not _along_bar(placement, places, n)]
    if not crossing:
        return
    travels = _travels(placement, crossing)
    scale = _paper_per_metre(placement, places)
    for name in crossing:
        along, block = placement.along(name), places[scene.sliders[name].point]
        low, high = (scale * each for each in travels[name])
        start, end = block + (low - SLOT_SPARE_MM) * along, block + (high + SLOT_SPARE_MM) * along
        aside = SLOT_MM * quarter_turn(along)
        corners = [start + aside, end + aside, end - aside, start - aside]
        axes.add_patch(Patch(corners, closed=True, fc="white", ec=INK, lw=1.0, zorder=2))


def _along_bar(placement: PlacedMechanism, places: Mapping[str, Array], name: str) -> bool:
    """Whether a slider runs along the bar of its guide, which is drawn through its block then."""
    slider = placement.scene.sliders[name]
    points = placement.scene.links[slider.on].points
    ends = [places[point] - places[slider.point] for point in points]
    across = quarter_turn(placement.along(name))
    return max(abs(float(end @ across)) for end in ends) < 0.5 * SLOT_MM


def _travels(placement: PlacedMechanism, names: list[str]) -> dict[str, tuple[float, float]]:
    """How far sliders go to both sides of where they are [m]."""
    scene, here = placement.scene, placement.driver.theta
    angles = np.append(np.linspace(*range_about(scene, here), TRAVEL)[1:-1], here)
    ones = np.ones_like(angles)
    motion = solve_driven(
        scene, angles, ones, 0.0 * ones, links=(), points=(), sliders=names, bound=False
    )
    moved = {n: motion.sliders[n].displacement - motion.sliders[n].displacement[-1] for n in names}
    return {name: (float(each.min()), float(each.max())) for name, each in moved.items()}


def _paper_per_metre(placement: PlacedMechanism, places: Mapping[str, Array]) -> float:
    """Millimetres of paper to a metre, from the two points that are farthest apart along x or y."""
    real = np.array(list(placement.points.values()))
    drawn = np.array([places[name] for name in placement.points])
    axis = int(np.ptp(real, axis=0).argmax())
    return float(np.ptp(drawn[:, axis]) / np.ptp(real[:, axis]))


def _turning(axes: Axes, placement: PlacedMechanism, places: Mapping[str, Array]) -> None:
    """The arrow of the driver's rotation about its pivot; one that swings has two heads."""
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
