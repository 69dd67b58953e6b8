"""A vector polygon in a box: known vectors full, directions dashed, crossings marked."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Circle
from matplotlib.patches import Polygon as Patch

from analytic.drawings.paper_scale import round_scale
from analytic.drawings.polygon import Polygon, Quantity, Vector
from analytic.drawings.vector_equation import Kind
from models.array import Array
from models.errors import CrankcheckError
from reports.figures.style import INK, SIZE, TINY, width_in
from reports.sheets.canvas import Canvas, arrow, line, text
from reports.sheets.letters import Letter, together, write_letters
from reports.sheets.paper import MM_PER_IN, Box

PADDING_MM = 9.0
"""Room for letters around a polygon."""
BEYOND_MM = 6.0
"""By how much a dashed direction goes on beyond the crossing."""
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
POLES: dict[Quantity, str] = {"velocity": "pᵥ", "acceleration": "pₐ"}
NODE_MM, NEAR_MM = 0.55, 0.3
"""Radius of a crossing; images that stand nearer than the second have one label."""


@dataclass(frozen=True)
class DrawnPolygon:
    """A polygon, how much a millimetre of it stands for, and where its pole is [mm]."""

    polygon: Polygon
    scale: float
    pole: Array

    def at(self, vector: Array) -> Array:
        """Where the end of a vector from the pole stands [mm]."""
        return np.asarray(self.pole + vector / self.scale)


def extent(polygon: Polygon) -> tuple[Array, Array]:
    """The corners of the box that holds the polygon [its unit]."""
    ends = [np.zeros(2), *polygon.nodes.values()]
    ends += [v for image in polygon.images.values() for v in image.values()]
    ends += [end for vector in polygon.vectors for end in (vector.start, vector.end)]
    places = np.array(ends)
    return places.min(axis=0), places.max(axis=0)


def fitted(polygon: Polygon, box: Box, scale: float | None = None) -> DrawnPolygon:
    """The polygon in the middle of a box, at a scale, or at the finest round one that fits.

    Raises CrankcheckError where a wanted scale makes it larger than the box.
    """
    return DrawnPolygon(polygon, *frame_of([polygon], box, scale))


def frame_of(
    polygons: Sequence[Polygon], box: Box, scale: float | None = None
) -> tuple[float, Array]:
    """The scale, and the place of the pole [mm], of polygons in a box; as `fitted`."""
    corners = [extent(polygon) for polygon in polygons]
    low = np.min([each[0] for each in corners], axis=0)
    high = np.max([each[1] for each in corners], axis=0)
    room = np.array([box.width, box.height]) - 2 * PADDING_MM
    if scale is None:
        wanted = [round_scale(s, r) for s, r in zip(high - low, room, strict=True) if s > 0.0]
        scale = max(wanted, default=1.0)
    elif np.any(high - low > scale * room):
        wide, tall = (high - low) / scale + 2 * PADDING_MM
        raise CrankcheckError(
            f"the {polygons[0].quantity} polygon needs {wide:.0f} x {tall:.0f} mm at this scale, "
            f"and has {box.width:.0f} x {box.height:.0f} mm; take larger paper, or a smaller --k"
        )
    return scale, np.array(box.middle) - (low + high) / 2 / scale


def draw_polygon(canvas: Canvas, drawn: DrawnPolygon, box: Box) -> None:
    """The polygon, a layer for each step of drawing, one for the images, one for the letters."""
    quantity = drawn.polygon.quantity
    for number, step in enumerate(drawn.polygon.steps, 1):
        axes = canvas.layer(f"{quantity}-{number}-{_plain(step.title)}")
        for vector in step.vectors:
            _draw_vector(drawn, vector, axes, quantity)
        for at in step.nodes.values():
            axes.add_patch(
                Circle(tuple(drawn.at(at)), NODE_MM, fc="white", ec=INK, lw=0.7, zorder=6)
            )
    axes = canvas.layer(f"{quantity}-images")
    for image in drawn.polygon.images.values():
        corners = np.array([drawn.at(v) for v in image.values()])
        if len(corners) > 1:
            axes.add_patch(
                Patch(corners, closed=len(corners) > 2, fill=False, ec=IMAGE, lw=0.6, zorder=1)
            )
    axes = canvas.layer(f"{quantity}-letters")
    _legend(axes, drawn.polygon, box)
    write_letters(canvas, axes, _letters(drawn), box)


def _draw_vector(drawn: DrawnPolygon, vector: Vector, axes: Axes, quantity: str) -> None:
    start, end = drawn.at(vector.start), drawn.at(vector.end)
    colour = COLOURS[vector.kind]
    if (dashes := _direction(drawn, vector)) is not None:
        dashed: dict[str, Any] = {"linewidth": 0.5, "linestyle": (0, (4, 2)), "zorder": 1}
        line(axes, *dashes, color=colour, **dashed)
    arrow(axes, start, end, f"{quantity}-{vector.name}", colour)


def _direction(drawn: DrawnPolygon, vector: Vector) -> tuple[Array, Array] | None:
    """The ends of the dashed line along a direction that crosses another [mm]; None of a vector
    that was known."""
    start, end = drawn.at(vector.start), drawn.at(vector.end)
    length = float(np.hypot(*(end - start)))
    if not vector.direction or length < 1e-9:
        return None
    spare = BEYOND_MM * (end - start) / length
    return start - spare, end + spare


def _legend(axes: Axes, polygon: Polygon, box: Box) -> None:
    """What the colours of the vectors are, of those that there are."""
    there = {vector.kind for vector in polygon.vectors}
    words = [(WORDS[kind], colour) for kind, colour in COLOURS.items() if kind in there]
    x = box.left + 1.5
    for told, colour in words:
        text(axes, x, box.bottom + 1.8, told, TINY, color=colour)
        x += MM_PER_IN * width_in(told, TINY) + 3.0


def _letters(drawn: DrawnPolygon) -> list[Letter]:
    """The letters of the images and the pole."""
    polygon = drawn.polygon
    prime = "'" if polygon.quantity == "acceleration" else ""
    at: dict[str, Array] = {POLES[polygon.quantity]: drawn.pole}
    for image in polygon.images.values():
        at |= {lower_case(name) + prime: drawn.at(v) for name, v in image.items() if np.any(v)}
    at |= {lower_case(name) + prime: drawn.at(v) for name, v in polygon.nodes.items()}
    return [Letter(name, spot, NODE_MM, SIZE) for name, spot in together(at, NEAR_MM).items()]


def lower_case(name: str) -> str:
    """The image of a point is called by its small letter."""
    point, bracket, body = name.partition("(")
    return point.lower() + bracket + body


def _plain(title: str) -> str:
    return "".join(c if c.isalnum() else "-" for c in title).strip("-")
