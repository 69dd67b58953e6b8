"""The letters of a polygon: of its pole, of images, of ends between them, of a log's images."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from analytic.lectures.drawings.polygon import Quantity
from analytic.lectures.drawings.vector_equation import SUPERSCRIPTS
from models.array import Array
from reports.figures.style import INK, QUIET, SIZE, SMALL
from reports.lectures.drawing.sheets.letters import Letter, together
from reports.lectures.drawing.sheets.polygons.magnified_errors import STAR
from reports.lectures.drawing.sheets.polygons.polygon_on_paper import DrawnPolygon
from reports.lectures.drawing.sheets.sheet_log import LOGGED

POLES: Mapping[Quantity, str] = {"velocity": "pᵥ", "acceleration": "pₐ"}
NEAR_MM, APART_MM = 0.3, 1.2
"""Images that stand nearer have their letters in one label; ends between images that stand nearer
to one than the second have no letter."""
NODE_MM = 0.6
"""Half the size of the circle about an image."""


def polygon_letters(drawn: DrawnPolygon) -> list[Letter]:
    """The letters of the images, of ends between them and of the pole."""
    images = _images(drawn)
    between = _between(drawn, [*images.values()])
    letters = [
        Letter(name, at[None], NODE_MM, SIZE, LOGGED if name.endswith(STAR) else INK)
        for name, at in images.items()
    ]
    return letters + [Letter(name, at[None], 0.0, SMALL, QUIET) for name, at in between.items()]


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


def lower_case(name: str) -> str:
    """The image of a point is called by its small letter."""
    point, bracket, body = name.partition("(")
    return point.lower() + bracket + body
