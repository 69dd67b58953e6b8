"""A sheet to draw on, in millimetres, in layers that an SVG keeps apart."""

from __future__ import annotations

import itertools
import math
import re
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Polygon as Patch

from models.array import Array
from reports.figures.saving import saved
from reports.figures.style import FRONT, INK, LARGE, QUIET, SMALL, TINY, cut
from reports.lectures.drawing.sheets.paper import MM_PER_IN, Box, Paper

ROUND = 721
"""Places along a whole circle."""


def cut_line(places: Array, low: Array, high: Array) -> list[Array]:
    """The parts of a line through places (n, 2) that are in a box, each (k, 2) of two or more.

    A step from outside to outside that is longer than the box is wide and high is a jump of a curve
    that comes back from infinity, and is left out.
    """
    start, step = places[:-1], np.diff(places, axis=0)
    near, far = _shares(start, step, low, high)
    outside = (near > 0.0) & (far < 1.0)
    jump = outside & (np.hypot(*step.T) > math.dist(low, high)) & (len(places) > 2)
    parts: list[list[Array]] = []
    on = False  # whether the part before goes on
    for k in np.flatnonzero((near < far) & ~jump):
        first, last = start[k] + near[k] * step[k], start[k] + far[k] * step[k]
        on = on and near[k] == 0.0 and bool(np.array_equal(parts[-1][-1], start[k]))
        if not on:
            parts.append([first])
        # the next one begins exactly where this one ends
        parts[-1].append(places[k + 1] if far[k] == 1.0 else last)
        on = far[k] == 1.0
    return [np.array(part) for part in parts]


def _shares(start: Array, step: Array, low: Array, high: Array) -> tuple[Array, Array]:
    """Between which shares of their steps lines are in a box (Liang and Barsky), (n,) each."""
    with np.errstate(divide="ignore", invalid="ignore"):
        one, other = (low - start) / step, (high - start) / step
    within = (low <= start) & (start <= high)
    enters = np.where(step == 0.0, np.where(within, -np.inf, np.inf), np.minimum(one, other))
    leaves = np.where(step == 0.0, np.where(within, np.inf, -np.inf), np.maximum(one, other))
    return np.maximum(enters.max(axis=1), 0.0), np.minimum(leaves.min(axis=1), 1.0)


def near_angles(middle: Array, radius: float, low: Array, high: Array) -> tuple[float, float]:
    """Between which angles [rad] a circle may be in a box: of one that is far larger than the box,
    most is of no use, and slow to draw."""
    away = (low + high) / 2 - middle
    reach = math.dist(low, high) / 2
    half = math.asin(reach / radius) if radius > reach else math.pi
    angle = math.atan2(away[1], away[0])
    return angle - half, angle + half


def arc_places(middle: Array, radius: float, start: float, end: float) -> Array:
    """Places along an arc between two angles [rad], (n, 2), closely."""
    angle = np.linspace(start, end, ROUND)
    return np.asarray(middle + radius * np.stack([np.cos(angle), np.sin(angle)], axis=1))


HEAD_MM, HEAD_WIDE_MM = 2.2, 0.8
"""Length and width of the head of an arrow; shorter arrows have smaller ones."""
LAYER = re.compile(r'<g id="layer-([^"]*)">')
INKSCAPE = "http://www.inkscape.org/namespaces/inkscape"


class Canvas:
    """A sheet; coordinates are millimetres from its lower left corner."""

    def __init__(self, paper: Paper) -> None:
        self.paper = paper
        size = (paper.width / MM_PER_IN, paper.height / MM_PER_IN)
        self.figure = Figure(figsize=size, dpi=150)
        self.layers: list[Axes] = []

    def layer(self, name: str) -> Axes:
        """A new layer over the others, the whole sheet wide."""
        axes = self.figure.add_axes((0.0, 0.0, 1.0, 1.0))
        axes.set(xlim=(0.0, self.paper.width), ylim=(0.0, self.paper.height))
        axes.set_axis_off()
        axes.set_gid(f"layer-{name}")
        self.layers.append(axes)
        return axes

    def named(self, name: str) -> Axes:
        """The layer of a name that is there."""
        return next(axes for axes in self.layers if axes.get_gid() == f"layer-{name}")

    def saved(self, kind: str, title: str) -> bytes:
        """The file of the sheet, of a kind in `reports.figures.saving.FORMATS`."""
        raw = saved(self.figure, kind, title)
        return _layered(raw.decode()).encode() if kind == "svg" else raw


def _layered(svg: str) -> str:
    """The drawing with its layers as those of a drawing program."""
    marked = LAYER.sub(r'<g id="layer-\1" inkscape:groupmode="layer" inkscape:label="\1">', svg)
    return marked.replace("<svg ", f'<svg xmlns:inkscape="{INKSCAPE}" ', 1)


def layer_words(title: str) -> str:
    """Words as they stand in the name of a layer."""
    return "".join(c if c.isalnum() else "-" for c in title).strip("-")


def line(axes: Axes, start: Array, end: Array, gid: str = "", **look: Any) -> None:
    """A straight line [mm]."""
    drawn = Line2D([start[0], end[0]], [start[1], end[1]], **({"color": INK} | look))
    if gid:
        drawn.set_gid(gid)
    axes.add_line(drawn)


def arrow(axes: Axes, start: Array, end: Array, gid: str, color: str, width: float = 0.9) -> None:
    """An arrow whose line is as long as the vector, its head within that [mm]."""
    line(axes, start, end, gid, color=color, linewidth=width, solid_capstyle="butt")
    along = end - start
    length = float((along @ along) ** 0.5)
    if length < 0.3:
        return
    arrow_head(axes, end, along / length, color, min(HEAD_MM, 0.4 * length))


def arrow_head(axes: Axes, tip: Array, along: Array, color: str, length: float = HEAD_MM) -> None:
    """The head of an arrow, its tip at a place, along a unit vector [mm]."""
    side = along[::-1] * (-1.0, 1.0) * length * HEAD_WIDE_MM / HEAD_MM / 2
    back = tip - length * along
    axes.add_patch(Patch([tip, back + side, back - side], closed=True, fc=color, ec=color, lw=0.2))


def text(axes: Axes, x: float, y: float, words: str, size: float = SMALL, **look: Any) -> None:
    """Words with the left end of their base line at a place [mm]."""
    # a dollar in a name is a dollar
    plain: dict[str, Any] = {"size": size, "ha": "left", "va": "baseline", "parse_math": False}
    axes.text(x, y, words, **(plain | look))


MARGIN, HEAD, FOOT = 8.0, 9.0, 6.0
"""Around the sheet, and of title and note [mm]."""


def inner_box(paper: Paper) -> Box:
    """What is left between title and note."""
    width, height = paper.width - 2 * MARGIN, paper.height - 2 * MARGIN - HEAD - FOOT
    return Box(MARGIN, MARGIN + FOOT, width, height)


def write_head(axes: Axes, paper: Paper, title: str, note: str) -> None:
    """The title, and the note at the foot."""
    text(axes, MARGIN, paper.height - MARGIN - 4.0, title, LARGE, weight="bold")
    room = (paper.width - 2 * MARGIN) / MM_PER_IN
    text(axes, MARGIN, MARGIN, cut(note, room, TINY), TINY, color=QUIET)


def draw_border(axes: Axes, box: Box) -> None:
    """A thin line around a box."""
    corners = np.array([[0, 0], [1, 0], [1, 1], [0, 1], [0, 0]]) * (box.width, box.height)
    for start, end in itertools.pairwise(corners + np.array([box.left, box.bottom])):
        line(axes, start, end, color=FRONT, linewidth=0.6)
