"""A kinematic chain as books draw it: bars and plates, pins, sliders, a hatched ground."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Circle
from matplotlib.patches import Polygon as Patch

from analytic.lectures.chains.chain import Chain, Joint
from analytic.lectures.drawings.placed_mechanism import quarter_turn
from models.array import Array
from reports.figures.style import INK
from reports.lectures.drawing.sheets.canvas import line

PIN_MM, BLOCK_MM = 0.75, (3.4, 2.2)
HATCH_MM, EVERY_MM = 1.1, 1.1
"""Length of the strokes beside a bar of the ground, and their distance."""
PLATE, GROUND_PLATE = "#dfe6ee", "white"
FRONT = 6


def draw_chain(
    axes: Axes, chain: Chain, at: Mapping[Joint, Array], ground: int | None = None
) -> None:
    """The chain with its joints at places [mm]; the ground, if there is one, hatched."""
    for link in range(chain.links):
        corners = _around(np.array([at[joint] for joint in chain.joints_of(link)]))
        if len(corners) == 2:
            line(axes, corners[0], corners[1], linewidth=1.5)
            if link == ground:
                _strokes(axes, corners, np.mean(list(at.values()), axis=0))
        else:
            _plate(axes, corners, is_ground=link == ground)
    for joint in chain.joints:
        if joint in chain.sliders:
            _block(axes, at[joint], _along(chain, joint, at))
        else:
            axes.add_patch(
                Circle(tuple(at[joint]), PIN_MM, fc="white", ec=INK, lw=0.7, zorder=FRONT)
            )


def _around(corners: Array) -> Array:
    """The corners in order around their middle."""
    to = corners - corners.mean(axis=0)
    return np.asarray(corners[np.argsort(np.arctan2(to[:, 1], to[:, 0]))])


def _plate(axes: Axes, corners: Array, *, is_ground: bool) -> None:
    look = {"hatch": "///////", "fc": GROUND_PLATE} if is_ground else {"fc": PLATE}
    plate = Patch(corners, closed=True, ec=INK, lw=1.3, joinstyle="round", **look)
    plate.set_hatch_linewidth(0.45)
    axes.add_patch(plate)


def _strokes(axes: Axes, ends: Array, middle: Array) -> None:
    """The strokes of a bar that is the ground, on its side away from the chain's middle."""
    along = ends[1] - ends[0]
    length = float(np.hypot(*along))
    unit = along / length
    side = quarter_turn(unit)
    if side @ (middle - ends[0]) > 0.0:
        side = -side
    stroke = HATCH_MM * (side - unit) / np.sqrt(2)
    for share in np.linspace(0.0, 1.0, max(int(length / EVERY_MM), 2) + 1)[1:-1]:
        at = ends[0] + share * along
        line(axes, at, at + stroke, linewidth=0.45)


def _block(axes: Axes, place: Array, along: Array) -> None:
    """A slider: a block on the bar that it slides on."""
    half, aside = 0.5 * BLOCK_MM[0] * along, 0.5 * BLOCK_MM[1] * quarter_turn(along)
    signs = ((1, 1), (-1, 1), (-1, -1), (1, -1))
    corners = [place + a * half + b * aside for a, b in signs]
    axes.add_patch(Patch(corners, closed=True, fc="white", ec=INK, lw=0.8, zorder=FRONT))
    line(axes, place - half, place + half, linewidth=0.5, zorder=FRONT)


def _along(chain: Chain, joint: Joint, at: Mapping[Joint, Array]) -> Array:
    """The direction of a slider: that of an edge of its first link, of a bar where one is."""
    link = min(joint, key=lambda one: chain.degrees[one])
    others = [one for one in chain.joints_of(link) if one != joint]
    way = np.asarray(at[others[0]] - at[joint])
    return np.asarray(way / np.hypot(*way))
