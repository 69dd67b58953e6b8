"""A sheet to draw on, in millimetres, in layers that an SVG keeps apart."""

from __future__ import annotations

import re
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Polygon as Patch

from models.array import Array
from reports.figures.saving import saved
from reports.figures.style import INK, SMALL
from reports.lectures.drawing.sheets.paper import MM_PER_IN, Paper

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
