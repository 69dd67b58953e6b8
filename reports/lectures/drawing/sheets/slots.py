"""Slots of moving links that are not along their bars: as long as the block travels, and joined to
the bar where they stand off it."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import combinations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Polygon as Patch
from matplotlib.path import Path

from analytic.kinematics import solve_driven
from analytic.lectures.drawings.placed_mechanism import PlacedMechanism, quarter_turn
from models.array import Array
from models.scene import GROUND
from reports.figures.style import INK
from reports.lectures.drawing.sheets.canvas import line
from reports.lectures.drawing.sheets.driver_range import assembled, range_about

SLOT_MM, SLOT_SPARE_MM = 1.5, 4.0
"""Half the width of a slot in a link, and how far it goes on beyond the block's travel."""
TRAVEL, LONGEST = 73, 2.0
"""Driver angles over which travel is looked for; the longest that is drawn, to either side, over
the longest link: near a singular position a block goes far away."""
ALONG = 0.005
"""A bar that is nearer to the line of a slider, over the longest link, is its guide."""
LOOKED_AT = 61
"""Places along a slot at which the bar may be joined to it."""

Travel = tuple[Array, Array]


def travels(placement: PlacedMechanism) -> dict[str, Travel]:
    """The ends of the travel [m], (2,) each, of every block that needs a slot, as its link stands.

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
    """Whether a slider runs along the bar of its guide, which is drawn through its block then."""
    slider = placement.scene.sliders[name]
    points = placement.scene.links[slider.on].points
    ends = [placement.points[point] - placement.points[slider.point] for point in points]
    across = quarter_turn(placement.along(name))
    return max(abs(float(end @ across)) for end in ends) < ALONG * placement.scene.longest_m


def draw_slots(
    axes: Axes, placement: PlacedMechanism, places: Mapping[str, Array], ends: Mapping[str, Travel]
) -> None:
    """Slots with the ends of travel at ``ends``, the points of the links at ``places`` [mm]."""
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
    """Whether a place is on a plate."""
    return len(corners) > 2 and bool(Path(np.array(corners)).contains_point(tuple(place)))


def _draw_arm(axes: Axes, slot: Array, corners: list[Array]) -> None:
    """The shortest arm from a link to the slot (n, 2) that it carries, where they do not meet."""
    nearest = [_foot(at, *edge) for edge in combinations(corners, 2) for at in slot]
    nearest = nearest or [corners[0]] * len(slot)  # a link of one point
    froms = np.tile(slot, (len(nearest) // len(slot), 1))
    apart = np.hypot(*(froms - nearest).T)
    best = int(apart.argmin())
    if apart[best] > SLOT_MM:
        line(axes, froms[best], nearest[best], linewidth=1.5, zorder=1)


def _foot(place: Array, start: Array, end: Array) -> Array:
    """The nearest place of a bar."""
    along = end - start
    share = float((place - start) @ along) / max(float(along @ along), 1e-30)
    return np.asarray(start + min(max(share, 0.0), 1.0) * along)
