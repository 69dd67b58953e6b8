"""The sheet of a scene's assemblies: each as a scheme in a field of its own, to one scale."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import partial

import numpy as np

from analytic.lectures.drawings.placed_mechanism import PlacedMechanism
from models.array import Array
from models.errors import CrankcheckError
from reports.figures.style import INK, QUIET, SMALL, cut, width_in
from reports.lectures.drawing.sheets.canvas import Canvas, draw_border, inner_box, text, write_head
from reports.lectures.drawing.sheets.letters import write_letters
from reports.lectures.drawing.sheets.paper import MM_PER_IN, Box, Paper
from reports.lectures.drawing.sheets.scheme import draw_scheme, extent_of, point_letters

PADDING, WORDS_MM = 11.0, 7.0
LEAST_MM = 34.0
"""A field that can be read is so wide and high."""


def draw_assemblies(
    drawn: Sequence[tuple[PlacedMechanism, str, bool]], title: str, note: str, paper: Paper
) -> Canvas:
    """The sheet of placements, each with its words, and whether it is the scene's own.

    Raises CrankcheckError for paper on which they can not be read.
    """
    fields = _fields(len(drawn), paper)
    if min(fields[0].width, fields[0].height) < LEAST_MM:
        raise CrankcheckError(
            f"{len(drawn)} assemblies do not fit on {paper.width:g} x {paper.height:g} mm; take a "
            "larger --paper, such as A2"
        )
    canvas = Canvas(paper)
    frame = canvas.layer("frame")
    write_head(frame, paper, title, note)
    schemes, letters = canvas.layer("mechanism"), canvas.layer("letters")
    boxes = [
        Box(one.left, one.bottom + WORDS_MM, one.width, one.height - WORDS_MM) for one in fields
    ]
    everything = np.concatenate([extent_of(placement) for placement, _, _ in drawn])
    scale, middle = boxes[0].fitted(everything, PADDING)
    for (placement, words, is_own), field, box in zip(drawn, fields, boxes, strict=True):
        draw_border(frame, field)
        at = partial(_at, box=box, scale=scale, middle=middle)
        draw_scheme(schemes, placement, at)
        short = cut(words, (field.width - 4.0) / MM_PER_IN, SMALL)
        left = field.middle[0] - MM_PER_IN * width_in(short, SMALL) / 2
        weight, color = ("bold", INK) if is_own else ("normal", QUIET)
        text(frame, left, field.bottom + 2.5, short, weight=weight, color=color)
    for (placement, _, _), box in zip(drawn, boxes, strict=True):
        places = {name: _at(place, box, scale, middle) for name, place in placement.points.items()}
        write_letters(canvas, letters, point_letters(placement, places), box)
    return canvas


def _at(places: Array, box: Box, scale: float, middle: Array) -> Array:
    """Where places [m], (..., 2), stand on the sheet [mm]."""
    return np.asarray(box.middle + (places - middle) / scale)


def _fields(many: int, paper: Paper) -> list[Box]:
    """A field for each, side by side and then below, about as wide as high."""
    inner = inner_box(paper)
    columns = min(range(1, many + 1), key=lambda n: _unlike(many, n, inner))
    rows = math.ceil(many / columns)
    wide, tall = inner.width / columns, inner.height / rows
    top = inner.bottom + inner.height
    return [
        Box(inner.left + (k % columns) * wide, top - (k // columns + 1) * tall, wide, tall)
        for k in range(many)
    ]


def _unlike(many: int, columns: int, inner: Box) -> float:
    """How far so many columns are from fields as wide as high, with none of them blank."""
    rows = math.ceil(many / columns)
    aspect = inner.width / columns * rows / inner.height
    return abs(math.log(aspect)) + (rows * columns - many) / many
