"""A vector polygon in a box: known vectors full, directions dashed, crossings marked."""

from __future__ import annotations

from typing import Any

from matplotlib.axes import Axes
from matplotlib.patches import Circle

from analytic.lectures.drawings.polygon import Polygon, Vector
from analytic.lectures.drawings.vector_equation import Kind
from reports.figures.style import INK, TINY, width_in
from reports.lectures.drawing.sheets.canvas import Canvas, arrow, layer_words, line, text
from reports.lectures.drawing.sheets.paper import MM_PER_IN, Box
from reports.lectures.drawing.sheets.polygons.magnified_errors import draw_errors
from reports.lectures.drawing.sheets.polygons.polygon_on_paper import (
    DrawnPolygon,
    crossing_line,
    image_lines,
)

COLOURS: dict[Kind, str] = {
    "whole": INK,
    "rotation": "#2e6f9e",
    "normal": "#3a7d44",
    "tangential": "#2e6f9e",
    "coriolis": "#b7791f",
    "sliding": "#d1495b",
}
WORDS: dict[Kind, str] = {
    "whole": "of a point",
    "rotation": "about a pin",
    "normal": "normal",
    "tangential": "tangential",
    "coriolis": "Coriolis",
    "sliding": "sliding",
}
IMAGE = "#8a94a0"


def draw_polygon(canvas: Canvas, drawn: DrawnPolygon, box: Box) -> None:
    """The polygon, a layer for each step of drawing, one for the images, one for letters, which
    holds the legend alone."""
    quantity = drawn.polygon.quantity
    for number, step in enumerate(drawn.polygon.steps, 1):
        axes = canvas.layer(f"{quantity}-{number}-{layer_words(step.title)}")
        for vector in step.vectors:
            _draw_vector(drawn, vector, axes, quantity)
        for at in step.nodes.values():
            axes.add_patch(Circle(tuple(drawn.at(at)), 0.55, fc="white", ec=INK, lw=0.7, zorder=6))
    if edges := [*image_lines(drawn)]:
        axes = canvas.layer(f"{quantity}-images")
        for start, end in edges:
            line(axes, start, end, color=IMAGE, linewidth=0.6)
    if drawn.logged is not None:
        axes = canvas.layer(f"{quantity}-log")
        draw_errors(axes, drawn.logged, drawn.polygon.images.values(), f"{quantity}-error")
    axes = canvas.layer(f"{quantity}-letters")
    _legend(axes, drawn.polygon, box)


def _draw_vector(drawn: DrawnPolygon, vector: Vector, axes: Axes, quantity: str) -> None:
    start, end = drawn.at(vector.start), drawn.at(vector.end)
    colour = COLOURS[vector.kind]
    if (dashes := crossing_line(drawn, vector)) is not None:
        dashed: dict[str, Any] = {"linewidth": 0.5, "linestyle": (0, (4, 2)), "zorder": 1}
        line(axes, *dashes, color=colour, **dashed)
    arrow(axes, start, end, f"{quantity}-{vector.name}", colour)


def _legend(axes: Axes, polygon: Polygon, box: Box) -> None:
    """What the colours of the vectors are, of those that there are."""
    there = {vector.kind for vector in polygon.vectors}
    words = [(WORDS[kind], colour) for kind, colour in COLOURS.items() if kind in there]
    x = box.left + 1.5
    for told, colour in words:
        text(axes, x, box.bottom + 1.8, told, TINY, color=colour)
        x += MM_PER_IN * width_in(told, TINY) + 3.0
