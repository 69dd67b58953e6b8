"""Paper: its size, and the boxes on it, in millimetres from the lower left corner; and the
canvas of a sheet, in layers that an SVG keeps apart.

Source: lecture "Phan tich dong hoc": K is the real value over the length drawn in mm, and is taken
from 1, 2, 5 times a power of ten. The problem book takes the scale that makes the vector of the
crank's pin k times as long as the drawn crank, p b = k AB.
"""

from __future__ import annotations

import itertools
import math
import re
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Polygon as Patch

from models.array import Array
from models.errors import CrankcheckError
from models.scene import Scene
from reports.figures.style import FRONT, INK, LARGE, QUIET, SMALL, TINY, cut, saved, width_in
from reports.output.write import crankcheck_version

STEPS = (1.0, 2.0, 5.0)
ROUNDING = 1e-9
"""Share by which a size may exceed the room and still fit."""


def round_scale(size: float, room_mm: float) -> float:
    """The finest round scale [unit/mm] at which a size [unit] fits into a room [mm].

    Raises ValueError for a size or a room that is not above 0.
    """
    if not (0.0 < size < math.inf and 0.0 < room_mm < math.inf):
        raise ValueError(f"size {size!r} in {room_mm!r} mm: a scale needs both above 0")
    least = size / room_mm
    power = 10.0 ** math.floor(math.log10(least))
    tried = [step * power for step in (*STEPS, 10.0)]
    return next(scale for scale in tried if scale * (1.0 + ROUNDING) >= least)


def book_scales(length_scale: float, omega: float, k: float) -> tuple[float, float]:
    """The scales of velocities [m/s/mm] and accelerations [m/s^2/mm] of the problem book.

    With a scale of lengths [m/mm], a crank of constant ``omega`` [rad/s] and a wanted ``k``, the
    vectors of the crank's pin are k times as long as the crank is drawn.
    """
    rate = abs(omega)
    return rate * length_scale / k, rate * rate * length_scale / k


SIZES = {
    "A5": (210.0, 148.0),
    "A4": (297.0, 210.0),
    "A3": (420.0, 297.0),
    "A2": (594.0, 420.0),
}
LEAST_MM, MOST_MM = (180.0, 120.0), 2000.0
"""Least width and height of a sheet, and its greatest length [mm]."""
ECHO = 20
"""Number of letters of an invalid size that a message quotes."""
MM_PER_IN = 25.4


@dataclass(frozen=True)
class Paper:
    """A sheet: width and height [mm]."""

    width: float
    height: float

    @staticmethod
    def of(text: str) -> Paper:
        """Parse A4 and the like, across, or WIDTHxHEIGHT in mm. Raises CrankcheckError."""
        told = text if len(text) <= ECHO else f"{text[:ECHO]}..."
        match = re.fullmatch(r"(\d+(?:\.\d+)?)x(\d+(?:\.\d+)?)", text)
        if text.upper() not in SIZES and match is None:
            raise CrankcheckError(
                f"--paper {told}: no size; use {', '.join(SIZES)}, or WIDTHxHEIGHT in mm, such as "
                "297x210"
            )
        width, height = SIZES.get(text.upper()) or (float(match[1]), float(match[2]))  # type: ignore[index]  # checked above
        if width < LEAST_MM[0] or height < LEAST_MM[1] or max(width, height) > MOST_MM:
            raise CrankcheckError(
                f"--paper {told}: {width:g} x {height:g} mm; a sheet that can be read needs "
                f"{LEAST_MM[0]:g} x {LEAST_MM[1]:g} mm or more, and at most {MOST_MM:g} mm"
            )
        return Paper(width, height)


@dataclass(frozen=True)
class Box:
    """A part of the sheet: its lower left corner, width and height [mm]."""

    left: float
    bottom: float
    width: float
    height: float

    @property
    def top(self) -> float:
        return self.bottom + self.height

    @property
    def right(self) -> float:
        return self.left + self.width

    @property
    def middle(self) -> tuple[float, float]:
        return self.left + self.width / 2, self.bottom + self.height / 2

    @property
    def corners(self) -> tuple[Array, Array]:
        """The lower left and the upper right corner [mm]."""
        low = np.array([self.left, self.bottom])
        return low, low + np.array([self.width, self.height])

    def side_by_side(self, width: float, gap: float) -> tuple[Box, Box]:
        """The box in two, with a gap between: the right one so wide [mm]."""
        rest = self.width - width - gap
        right = self.left + rest + gap
        return (
            Box(self.left, self.bottom, rest, self.height),
            Box(right, self.bottom, width, self.height),
        )

    def fitted(self, places: Array, padding: float) -> tuple[float, Array]:
        """The finest round scale [unit/mm] at which places (n, 2) have so much room around them
        [mm] in the box, 1 for places that coincide; and their middle (2,)."""
        low, high = places.min(axis=0), places.max(axis=0)
        room = np.array([self.width, self.height]) - 2 * padding
        scales = [round_scale(s, r) for s, r in zip(high - low, room, strict=True) if s > 0.0]
        return max(scales, default=1.0), (low + high) / 2


@dataclass(frozen=True)
class ToScale:
    """A drawing in a box at a scale [m/mm], a place [m] in the middle of the box."""

    box: Box
    scale: float
    middle: Array

    def at(self, places: Array) -> Array:
        """Places [m], (..., 2), on the sheet [mm]."""
        return np.asarray(self.box.middle + (places - self.middle) / self.scale)


def sheet_note(scene: Scene) -> str:
    """The note of a sheet: version of crankcheck, and source of the mechanism."""
    return f"crankcheck {crankcheck_version()}, closed form; {scene.source}"


def of_elastic(scene: Scene, words: str) -> str:
    """The words for a scene with elastic links, which sheets take as rigid; "" for others."""
    return words if scene.elastic else ""


ROUND = 721
"""Number of places along a whole circle."""


def cut_line(places: Array, low: Array, high: Array) -> list[Array]:
    """The parts of a line through places (n, 2) that are in a box, each (k, 2) of two or more.

    A step from outside to outside that is longer than the box's diagonal is a jump of a curve that
    comes back from infinity, and is left out.
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
    """The shares of their steps between which lines are in a box (Liang and Barsky), (n,) each."""
    with np.errstate(divide="ignore", invalid="ignore"):
        one, other = (low - start) / step, (high - start) / step
    within = (low <= start) & (start <= high)
    enters = np.where(step == 0.0, np.where(within, -np.inf, np.inf), np.minimum(one, other))
    leaves = np.where(step == 0.0, np.where(within, np.inf, -np.inf), np.maximum(one, other))
    return np.maximum(enters.max(axis=1), 0.0), np.minimum(leaves.min(axis=1), 1.0)


def near_angles(middle: Array, radius: float, low: Array, high: Array) -> tuple[float, float]:
    """The angles [rad] between which a circle may be in a box: most of a circle far larger than the
    box is useless, and slow to draw."""
    away = (low + high) / 2 - middle
    reach = math.dist(low, high) / 2
    half = math.asin(reach / radius) if radius > reach else math.pi
    angle = math.atan2(away[1], away[0])
    return angle - half, angle + half


def arc_places(middle: Array, radius: float, start: float, end: float) -> Array:
    """Places along an arc between two angles [rad], (n, 2), closely spaced."""
    angle = np.linspace(start, end, ROUND)
    return np.asarray(middle + radius * np.stack([np.cos(angle), np.sin(angle)], axis=1))


HEAD_MM, HEAD_WIDE_MM = 2.2, 0.8
"""Length and width of the head of an arrow [mm]; shorter arrows have smaller heads."""
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
        """Add a layer over the others, as wide as the sheet."""
        axes = self.figure.add_axes((0.0, 0.0, 1.0, 1.0))
        axes.set(xlim=(0.0, self.paper.width), ylim=(0.0, self.paper.height))
        axes.set_axis_off()
        axes.set_gid(f"layer-{name}")
        self.layers.append(axes)
        return axes

    def named(self, name: str) -> Axes:
        """The existing layer named ``name``."""
        return next(axes for axes in self.layers if axes.get_gid() == f"layer-{name}")

    def saved(self, kind: str, title: str) -> bytes:
        """The file of the sheet, of a kind in `reports.figures.layout.DOTS_PER_IN`."""
        raw = saved(self.figure, kind, title)
        return _layered(raw.decode()).encode() if kind == "svg" else raw


def _layered(svg: str) -> str:
    marked = LAYER.sub(r'<g id="layer-\1" inkscape:groupmode="layer" inkscape:label="\1">', svg)
    return marked.replace("<svg ", f'<svg xmlns:inkscape="{INKSCAPE}" ', 1)


def layer_words(title: str) -> str:
    """Words in the form of a layer's name."""
    return "".join(c if c.isalnum() else "-" for c in title).strip("-")


Place = Array | tuple[float, float]


def line(axes: Axes, start: Place, end: Place, gid: str = "", **look: Any) -> None:
    """Draw a straight line [mm]."""
    drawn = Line2D([start[0], end[0]], [start[1], end[1]], **({"color": INK} | look))
    if gid:
        drawn.set_gid(gid)
    axes.add_line(drawn)


def arrow(axes: Axes, start: Array, end: Array, gid: str, color: str, width: float = 0.9) -> None:
    """Draw an arrow whose line is as long as the vector, its head within that [mm]."""
    line(axes, start, end, gid, color=color, linewidth=width, solid_capstyle="butt")
    along = end - start
    length = float((along @ along) ** 0.5)
    if length < 0.3:
        return
    arrow_head(axes, end, along / length, color, min(HEAD_MM, 0.4 * length))


def arrow_head(axes: Axes, tip: Array, along: Array, color: str, length: float = HEAD_MM) -> None:
    """Draw the head of an arrow, its tip at a place, along a unit vector [mm]."""
    side = along[::-1] * (-1.0, 1.0) * length * HEAD_WIDE_MM / HEAD_MM / 2
    back = tip - length * along
    axes.add_patch(Patch([tip, back + side, back - side], closed=True, fc=color, ec=color, lw=0.2))


def text(axes: Axes, x: float, y: float, words: str, size: float = SMALL, **look: Any) -> None:
    """Write words with the left end of their base line at a place [mm]."""
    # a dollar in a name is a dollar
    plain: dict[str, Any] = {"size": size, "ha": "left", "va": "baseline", "parse_math": False}
    axes.text(x, y, words, **(plain | look))


MARGIN, HEAD, FOOT = 8.0, 9.0, 6.0
"""Margin around the sheet, and heights of title and note [mm]."""


def inner_box(paper: Paper) -> Box:
    """The box between title and note."""
    width, height = paper.width - 2 * MARGIN, paper.height - 2 * MARGIN - HEAD - FOOT
    return Box(MARGIN, MARGIN + FOOT, width, height)


def write_head(axes: Axes, paper: Paper, title: str, note: str) -> None:
    """Write the title, and the note at the foot."""
    text(axes, MARGIN, paper.height - MARGIN - 4.0, title, LARGE, weight="bold")
    room = (paper.width - 2 * MARGIN) / MM_PER_IN
    text(axes, MARGIN, MARGIN, cut(note, room, TINY), TINY, color=QUIET)


def headed(paper: Paper, title: str, note: str, *boxes: Box) -> tuple[Canvas, Axes]:
    """A sheet, and its first layer: title, note at the foot, and borders of boxes."""
    canvas = Canvas(paper)
    frame = canvas.layer("frame")
    write_head(frame, paper, title, note)
    for box in boxes:
        draw_border(frame, box)
    return canvas, frame


def write_middle(
    axes: Axes, box: Box, y: float, words: str, size: float, margin: float = 1.0, **look: Any
) -> None:
    """Write words in the middle of a box on a base line at ``y``, cut to its width [mm]."""
    short = cut(words, (box.width - 2 * margin) / MM_PER_IN, size)
    left = box.middle[0] - MM_PER_IN * width_in(short, size) / 2
    text(axes, left, y, short, size, **look)


def draw_border(axes: Axes, box: Box) -> None:
    """Draw a thin line around a box."""
    corners = np.array([[0, 0], [1, 0], [1, 1], [0, 1], [0, 0]]) * (box.width, box.height)
    for start, end in itertools.pairwise(corners + np.array([box.left, box.bottom])):
        line(axes, start, end, color=FRONT, linewidth=0.6)
