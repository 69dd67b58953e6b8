"""The sheet of errors over the number of divisions, both logarithmic."""

from __future__ import annotations

import itertools

import numpy as np
from matplotlib.axes import Axes

from models.errors import CrankcheckError
from reports.figures.style import QUIET, SIZE, logarithmic, styled
from reports.sheets.canvas import Canvas
from reports.sheets.graphs.graph_lines import DRAWN, LOGGED, RAY
from reports.sheets.graphs.graph_orders import GraphErrors, order_words
from reports.sheets.graphs.graph_words import NOTHING
from reports.sheets.paper import Paper
from reports.sheets.sheet_frame import inner_box, write_head

AROUND_MM = (18.0, 14.0)
"""Left of the diagram and below it, for numbers and names [mm]."""
LOOKS = {"reference": (DRAWN, "-"), "log": (LOGGED, "--"), "its own part": (RAY, ":")}
MARKERS = ("o", "s")
GUIDE = 0.5
"""How far below the first line the slope of order 2 stands, as a share."""


def draw_errors(errors: GraphErrors, paper: Paper, note: str) -> Canvas:
    """A line for each graph that was drawn, of the reference and of a log. Raises CrankcheckError
    where all are right to rounding."""
    canvas = Canvas(paper)
    frame = canvas.layer("frame")
    of = errors.range
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
            f"{errors.range.quantity.name} of {errors.range.scene.name} is drawn right with any "
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
            axes.plot(
                errors.divisions, each.errors, color=color, ls=style, marker=next(markers),
                ms=3.0, label=told,
            )  # fmt: skip
        counts = np.array(errors.divisions[:1] + errors.divisions[-1:], dtype=float)
        slope = errors.lines[0].errors[0] * GUIDE * (counts[0] / counts) ** 2
        axes.plot(counts, slope, color=QUIET, lw=0.6, label="slope of order 2")
        axes.set_xlabel("parts of the period", size=SIZE, color=QUIET)
        axes.set_ylabel("largest error over the size", size=SIZE, color=QUIET)
        axes.legend(loc="best", frameon=True)
