"""The letters of a polygon: of its pole, of images, of ends between them, of a log's images."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

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
    joined = together(at, NEAR_MM)
    between = _between(drawn, [*joined.values()])
    caption = CAPTION_MM if drawn.logged is None else 2 * CAPTION_MM
    box = Box(box.left, box.bottom + LEGEND_MM, box.width, box.height - LEGEND_MM - caption)
    corner = np.array([box.left, box.bottom])
    labels = [
        Label(
            name, (width_in(name, size), size / POINTS), ((spot - corner) / MM_PER_IN)[None], 0.03
        )
        for names, size in ((joined, SIZE), (between, SMALL))
        for name, spot in names.items()
    ]
    spots = [*joined.values(), *between.values()]
    dots = [_sampled(drawn.at(v.start), drawn.at(v.end)) for v in polygon.vectors]
    if (log := drawn.logged) is not None:
        dots += [_sampled(log.exact[name], tip) for name, tip in log.tips.items()]
    heavy = (np.vstack([*dots, *(s[None] for s in spots)]) - corner) / MM_PER_IN
    obstacles = np.column_stack([heavy, np.full(len(heavy), 0.01)])
    frame = (box.width / MM_PER_IN, box.height / MM_PER_IN)
    thin = [each for v in polygon.vectors if (each := crossing_line(drawn, v)) is not None]
    thin += image_lines(drawn)
    if log is not None:
        thin += logged_lines(log, polygon.images.values())
    light = np.vstack([np.zeros((0, 2)), *(_sampled(*each) for each in thin)])
    centres = place(labels, obstacles, (light - corner) / MM_PER_IN, frame)
    for label, (x, y) in zip(labels, centres, strict=True):
        at_x, at_y = corner + MM_PER_IN * np.array([x, y])
        size = SIZE if label.text in joined else SMALL
        colour = LOGGED if label.text.endswith(STAR) else INK if size == SIZE else QUIET
        text(axes, at_x, at_y, label.text, size, ha="center", va="center", color=colour)


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
