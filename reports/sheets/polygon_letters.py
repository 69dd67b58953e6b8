"""The letters of a polygon: of its pole, of images, of ends between them, of a log's images."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes

from analytic.drawings.polygon import Quantity
from analytic.drawings.vector_equation import SUPERSCRIPTS
from models.array import Array
from reports.drawing.lettering import Label, place
from reports.figures.style import INK, POINTS, QUIET, SIZE, SMALL, width_in
from reports.sheets.canvas import text
from reports.sheets.letters import together
from reports.sheets.magnified_errors import LOGGED, STAR, logged_lines
from reports.sheets.paper import MM_PER_IN, Box
from reports.sheets.polygon_on_paper import DrawnPolygon, crossing_line, image_lines

POLES: Mapping[Quantity, str] = {"velocity": "pᵥ", "acceleration": "pₐ"}
NEAR_MM, APART_MM = 0.3, 1.2
"""Images that stand nearer have their letters in one label; ends between images that stand nearer
to one than the second have no letter."""
CAPTION_MM, LEGEND_MM = 4.0, 4.0
"""Of a box, a line above and one below: no letter stands there."""


def write_images(axes: Axes, drawn: DrawnPolygon, box: Box) -> None:
    """The letters of the images, of ends between them and of the pole, clear of lines and of one
    another."""
    caption = CAPTION_MM if drawn.logged is None else 2 * CAPTION_MM
    box = Box(box.left, box.bottom + LEGEND_MM, box.width, box.height - LEGEND_MM - caption)
    corner = np.array([box.left, box.bottom])
    images = _images(drawn)
    between = _between(drawn, [*images.values()])
    labels = [
        Label(
            name, (width_in(name, size), size / POINTS), ((spot - corner) / MM_PER_IN)[None], 0.03
        )
        for names, size in ((images, SIZE), (between, SMALL))
        for name, spot in names.items()
    ]
    spots = [spot[None] for spot in (*images.values(), *between.values())]
    heavy = (np.vstack([*spots, *_thick(drawn)]) - corner) / MM_PER_IN
    obstacles = np.column_stack([heavy, np.full(len(heavy), 0.01)])
    light = np.vstack([np.zeros((0, 2)), *_thin(drawn)])
    frame = (box.width / MM_PER_IN, box.height / MM_PER_IN)
    centres = place(labels, obstacles, (light - corner) / MM_PER_IN, frame)
    for label, (x, y) in zip(labels, centres, strict=True):
        at_x, at_y = corner + MM_PER_IN * np.array([x, y])
        size = SIZE if label.text in images else SMALL
        colour = LOGGED if label.text.endswith(STAR) else INK if size == SIZE else QUIET
        text(axes, at_x, at_y, label.text, size, ha="center", va="center", color=colour)


def _images(drawn: DrawnPolygon) -> dict[str, Array]:
    """Where the pole, the images, and those of a log stand [mm], by letters."""
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
        at |= {lower_case(n) + prime + STAR: tip for n, tip in drawn.logged.tips.items()}
    return together(at, NEAR_MM)


def _thick(drawn: DrawnPolygon) -> Iterator[Array]:
    """Points along the vectors, and along the errors of a log, (n, 2) [mm]."""
    for vector in drawn.polygon.vectors:
        yield _sampled(drawn.at(vector.start), drawn.at(vector.end))
    if (log := drawn.logged) is not None:
        for name, tip in log.tips.items():
            yield _sampled(log.exact[name], tip)


def _thin(drawn: DrawnPolygon) -> Iterator[Array]:
    """Points along dashed directions and the lines of images, (n, 2) [mm]."""
    for vector in drawn.polygon.vectors:
        if (ends := crossing_line(drawn, vector)) is not None:
            yield _sampled(*ends)
    lines = [*image_lines(drawn)]
    if drawn.logged is not None:
        lines += logged_lines(drawn.logged, drawn.polygon.images.values())
    for start, end in lines:
        yield _sampled(start, end)


def _between(drawn: DrawnPolygon, images: Sequence[Array]) -> dict[str, Array]:
    """The ends of normal and of Coriolis' components that are no images: n' and k' as the lecture
    has them, with what they are of where there are several."""
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


def _sampled(start: Array, end: Array) -> Array:
    """Points along a line [mm], closely."""
    return np.linspace(start, end, max(int(np.hypot(*(end - start))), 1) + 1)


def lower_case(name: str) -> str:
    """The image of a point is called by its small letter."""
    point, bracket, body = name.partition("(")
    return point.lower() + bracket + body
