"""The sheet of errors over the number of divisions, both logarithmic."""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes

from models.array import Array
from models.errors import CrankcheckError
from reports.figures.style import QUIET, SIZE, logarithmic, styled
from reports.lectures.drawing.sheets.canvas import Canvas
from reports.lectures.drawing.sheets.graphs.graph_lines import DRAWN, RAY
from reports.lectures.drawing.sheets.graphs.graph_orders import (
    ErrorLine,
    GraphErrors,
    Whose,
    order_words,
)
from reports.lectures.drawing.sheets.graphs.graph_words import NOTHING
from reports.lectures.drawing.sheets.paper import Paper
from reports.lectures.drawing.sheets.sheet_frame import inner_box, write_head
from reports.lectures.drawing.sheets.sheet_log import LOGGED

AROUND_MM = (18.0, 14.0)
"""Left of the diagram and below it, for numbers and names [mm]."""
LOOKS: Mapping[Whose, tuple[str, str]] = {
    "reference": (DRAWN, "-"),
    "log": (LOGGED, "--"),
    "its own part": (RAY, ":"),
}
MARKERS = ("o", "s")
GUIDE = 0.5
"""How far below the first line the slope of order 2 stands, as a share."""


def draw_errors(errors: GraphErrors, paper: Paper, note: str) -> Canvas:
    """A line for each graph that was drawn, of the reference and of a log. Raises CrankcheckError
    where all are right to rounding."""
    canvas = Canvas(paper)
    frame = canvas.layer("frame")
    of = errors.span
    title = f"{of.scene.name}: {of.quantity.name} by {errors.by}, errors over divisions"
    write_head(frame, paper, title, note)
    box = inner_box(paper)
    left, below = AROUND_MM
    place = (
        (box.left + left) / paper.width,
        (box.bottom + below) / paper.height,
        (box.width - left) / paper.width,
        (box.height - below) / paper.height,
    )
    with styled():
        axes = canvas.figure.add_axes(place)
    _draw(axes, errors)
    return canvas


def _draw(axes: Axes, errors: GraphErrors) -> None:
    seen = [error for each in errors.lines for error in each.errors if error > NOTHING]
    if not seen:
        raise CrankcheckError(
            f"{errors.span.quantity.name} of {errors.span.scene.name} is drawn right with any "
            "number of divisions: there are no errors to draw"
        )
    with styled():
        logarithmic(axes, "x", 0.8 * min(errors.divisions), 1.25 * max(errors.divisions))
        logarithmic(axes, "y", 0.5 * min(seen), 2.0 * max(seen))
        axes.set_xticks(errors.divisions, [str(each) for each in errors.divisions], minor=False)
        markers = itertools.cycle(MARKERS)
        for each in errors.lines:
            color, style = LOOKS[each.of]
            order = order_words(each, errors.divisions)
            told = f"{each.of}, {each.symbol}" + (f": order {order}" if order != "-" else "")
            shown = [error if error > NOTHING else np.nan for error in each.errors]
            axes.plot(
                errors.divisions, shown, color=color, ls=style, marker=next(markers),
                ms=3.0, label=told,
            )  # fmt: skip
        axes.plot(*_guide(errors.lines, errors.divisions), color=QUIET, lw=0.6,
                  label="slope of order 2")  # fmt: skip
        axes.set_xlabel("parts of the period", size=SIZE, color=QUIET)
        axes.set_ylabel("largest error over the size", size=SIZE, color=QUIET)
        axes.legend(loc="best", frameon=True)


def _guide(lines: Sequence[ErrorLine], divisions: Sequence[int]) -> tuple[Array, Array]:
    """The slope of order 2 from the first to the last number of divisions, a little below the first
    error that is above rounding."""
    parts, error = next(
        (parts, error)
        for line in lines
        for parts, error in zip(divisions, line.errors, strict=True)
        if error > NOTHING
    )
    counts = np.array([divisions[0], divisions[-1]], dtype=float)
    return counts, GUIDE * error * (parts / counts) ** 2
