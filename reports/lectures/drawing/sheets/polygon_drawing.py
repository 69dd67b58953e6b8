"""A vector polygon in a box: known vectors full, directions dashed, crossings marked."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Circle

from analytic.lectures.drawings.polygon import SUPERSCRIPTS, Kind, Polygon, Quantity, Vector
from models.array import Array
from reports.figures.style import INK, QUIET, SIZE, SMALL, TINY, width_in
from reports.lectures.drawing.sheets import paper, polygon_on_paper
from reports.lectures.drawing.sheets.graph_drawing import LOGGED
from reports.lectures.drawing.sheets.letters import Letter, together

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


def draw_polygon(
    canvas: paper.Canvas, drawn: polygon_on_paper.DrawnPolygon, box: paper.Box
) -> None:
    """Draw the polygon, a layer for each step of drawing, one for the images, one for letters,
    which holds the legend alone."""
    quantity = drawn.polygon.quantity
    for number, step in enumerate(drawn.polygon.steps, 1):
        axes = canvas.layer(f"{quantity}-{number}-{paper.layer_words(step.title)}")
        for vector in step.vectors:
            _draw_vector(drawn, vector, axes, quantity)
        for at in step.nodes.values():
            axes.add_patch(Circle(tuple(drawn.at(at)), 0.55, fc="white", ec=INK, lw=0.7, zorder=6))
    if edges := [*polygon_on_paper.image_lines(drawn)]:
        axes = canvas.layer(f"{quantity}-images")
        for start, end in edges:
            paper.line(axes, start, end, color=IMAGE, linewidth=0.6)
    if drawn.logged is not None:
        axes = canvas.layer(f"{quantity}-log")
        polygon_on_paper.draw_errors(
            axes, drawn.logged, drawn.polygon.images.values(), f"{quantity}-error"
        )
    axes = canvas.layer(f"{quantity}-letters")
    _legend(axes, drawn.polygon, box)


def _draw_vector(
    drawn: polygon_on_paper.DrawnPolygon, vector: Vector, axes: Axes, quantity: str
) -> None:
    start, end = drawn.at(vector.start), drawn.at(vector.end)
    colour = COLOURS[vector.kind]
    if (dashes := polygon_on_paper.crossing_line(drawn, vector)) is not None:
        dashed: dict[str, Any] = {"linewidth": 0.5, "linestyle": (0, (4, 2)), "zorder": 1}
        paper.line(axes, *dashes, color=colour, **dashed)
    paper.arrow(axes, start, end, f"{quantity}-{vector.name}", colour)


def _legend(axes: Axes, polygon: Polygon, box: paper.Box) -> None:
    there = {vector.kind for vector in polygon.vectors}
    words = [(WORDS[kind], colour) for kind, colour in COLOURS.items() if kind in there]
    x = box.left + 1.5
    for told, colour in words:
        paper.text(axes, x, box.bottom + 1.8, told, TINY, color=colour)
        x += paper.MM_PER_IN * width_in(told, TINY) + 3.0


POLES: Mapping[Quantity, str] = {"velocity": "pᵥ", "acceleration": "pₐ"}
NEAR_MM, APART_MM = 0.3, 1.2
"""Distances [mm]: images nearer than the first have their letters in one label; ends between
images, nearer to one than the second, have no letter."""
NODE_MM = 0.6
"""Half the size of the circle about an image [mm]."""


def polygon_letters(drawn: polygon_on_paper.DrawnPolygon) -> list[Letter]:
    """The letters of the images, of ends between them and of the pole."""
    images = _images(drawn)
    between = _between(drawn, [*images.values()])
    letters = [
        Letter(
            name, at[None], NODE_MM, SIZE, LOGGED if name.endswith(polygon_on_paper.STAR) else INK
        )
        for name, at in images.items()
    ]
    return letters + [Letter(name, at[None], 0.0, SMALL, QUIET) for name, at in between.items()]


def _images(drawn: polygon_on_paper.DrawnPolygon) -> dict[str, Array]:
    """The places of the pole, the images, and a log's images [mm], by letters."""
    polygon = drawn.polygon
    prime = "'" if polygon.quantity == "acceleration" else ""
    at: dict[str, Array] = {POLES[polygon.quantity]: drawn.pole}
    nodes = polygon.nodes
    at |= {
        lower_case(name) + prime: drawn.at(end)
        for name, end in polygon.ends.items()
        if np.any(end) or name in nodes  # the ground's points are the pole
    }
    if drawn.logged is not None:
        at |= {
            lower_case(n) + prime + polygon_on_paper.STAR: tip
            for n, tip in drawn.logged.tips.items()
        }
    return together(at, NEAR_MM)


def _between(drawn: polygon_on_paper.DrawnPolygon, images: Sequence[Array]) -> dict[str, Array]:
    """The ends of normal and Coriolis components that are no images: n' and k' as in the lecture,
    with the rest of the vector's name where there are several."""
    ends = [
        (vector, drawn.at(vector.end))
        for vector in drawn.polygon.vectors
        if vector.kind in ("normal", "coriolis")
    ]
    free = [
        (vector, at)
        for vector, at in ends
        if all(np.hypot(*(at - image)) > APART_MM for image in images)
    ]
    letters = [SUPERSCRIPTS[vector.kind] + "'" for vector, _ in free]
    alone = {letter for letter in letters if letters.count(letter) == 1}
    names = {
        letter + ("" if letter in alone else vector.name.partition("_")[2]): at
        for letter, (vector, at) in zip(letters, free, strict=True)
    }
    return together(names, NEAR_MM)


def lower_case(name: str) -> str:
    """The name of the image of a point: its small letter."""
    point, bracket, body = name.partition("(")
    return point.lower() + bracket + body
