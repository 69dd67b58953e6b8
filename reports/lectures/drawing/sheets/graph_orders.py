"""The fall of the errors of drawn graphs with the number of divisions."""

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from matplotlib.axes import Axes
from rich.console import Console

from analytic.lectures.drawings.graphical import Method
from models.array import Array
from models.errors import CrankcheckError
from reports.figures.style import QUIET, SIZE, logarithmic, styled
from reports.lectures.drawing.sheets.graph_drawing import (
    LOGGED,
    DrawnGraphs,
    GraphLog,
    drawn_graphs,
)
from reports.lectures.drawing.sheets.graph_page import DRAWN, RAY
from reports.lectures.drawing.sheets.graph_span import GraphSpan
from reports.lectures.drawing.sheets.graph_words import NOTHING, share
from reports.lectures.drawing.sheets.paper import Canvas, Paper, headed, inner_box
from reports.output.console import grid
from reports.results.floor_fit import straight

Whose = Literal["reference", "log", "its own part"]
"""Source of errors: the drawing of the reference, the drawing of a log, or the part of the log's
error that is not the method's."""
LEAST_FALL = 2
"""Least number of errors above rounding that an order needs."""
OWN_SHARE = 0.5
"""Share of the log's own part in the last error, above which the line has reached its floor."""
BENT = 0.5
"""Largest difference of the order between two numbers of divisions from the fitted one; beyond, a
power fits poorly."""


@dataclass(frozen=True)
class ErrorLine:
    """Errors over the size, one for each number of divisions, of the source ``of`` and the graph
    ``symbol``; ``own`` is the log's own part of each, which does not fall."""

    of: Whose
    symbol: str
    errors: tuple[float, ...]
    own: tuple[float, ...] = ()

    @property
    def is_own(self) -> bool:
        """True if all of the errors are the log's own."""
        return self.of == "its own part"

    def order(self, divisions: Sequence[int]) -> float | None:
        """The power of the length of a part by which the errors fall; None for errors of rounding,
        for errors that end in a floor, and where no power fits."""
        some = [(n, error) for n, error in zip(divisions, self.errors, strict=True)
                if error > NOTHING]  # fmt: skip
        if len(some) < LEAST_FALL or self.ends_in_floor:
            return None
        counts, errors = np.array(some).T
        order = straight(1.0 / counts, errors).order
        steps = -np.diff(np.log(errors)) / np.diff(np.log(counts))
        return order if np.all(np.abs(steps - order) <= BENT) else None

    @property
    def ends_in_floor(self) -> bool:
        """True if most of the last error is not the method's."""
        return bool(self.own) and self.own[-1] > OWN_SHARE * self.errors[-1]


@dataclass(frozen=True)
class GraphErrors:
    """Lines of errors over the numbers of divisions: of the reference, of a log where there is one,
    and of the log's own part."""

    span: GraphSpan
    by: Method
    divisions: tuple[int, ...]
    lines: tuple[ErrorLine, ...]
    log: GraphLog | None


def graph_errors(
    of: GraphSpan, by: Method, divisions: Sequence[int], log: GraphLog | None
) -> GraphErrors:
    """Draw with each number of divisions. Raises CrankcheckError as `drawn_graphs`."""
    drawings = [drawn_graphs(of, by, parts, log) for parts in divisions]
    return GraphErrors(of, by, tuple(divisions), tuple(_lines(drawings)), log)


def _lines(drawings: Sequence[DrawnGraphs]) -> list[ErrorLine]:
    first, found = drawings[0], list[ErrorLine]()
    symbols = first.span.symbols
    for order in first.derived:
        errors = tuple(each.off(each.reference, order) for each in drawings)
        found.append(ErrorLine("reference", symbols[order], errors))
    if first.log is None:
        return found
    own = {order: tuple(each.own_part(order) for each in drawings) for order in first.derived}
    for order in first.derived:
        errors = tuple(each.off(each.logged, order) for each in drawings if each.logged)
        found.append(ErrorLine("log", symbols[order], errors, own[order]))
    for order in first.derived:
        found.append(ErrorLine("its own part", symbols[order], own[order], own[order]))
    return found


def show_errors(console: Console, errors: GraphErrors) -> None:
    """Print the table, a row for each number of divisions, and the fitted orders under it."""
    heads = ["\nparts:", *(f"{each.of}\n{each.symbol}:" for each in errors.lines)]
    rows = [
        (str(count), *(share(each.errors[k]) for each in errors.lines))
        for k, count in enumerate(errors.divisions)
    ]
    if len(errors.divisions) > 1:
        rows.append(("order", *(order_words(each, errors.divisions) for each in errors.lines)))
    console.print(grid(heads, rows, wraps=True))


def order_words(line: ErrorLine, divisions: Sequence[int]) -> str:
    """The fitted order, or a dash where there is none."""
    order = line.order(divisions)
    return "-" if order is None else f"{order:.2f}"


def told_floor(errors: GraphErrors) -> str:
    """A note on the floor of the log's errors."""
    assert errors.log is not None
    own = ", ".join(
        f"{each.symbol} {share(each.errors[-1])}" for each in errors.lines if each.is_own
    )
    return (
        f"with finer parts the errors of {errors.log.name} approach its own, relative to the "
        f"drawing of the reference: {own} in {errors.divisions[-1]} parts"
    )


AROUND_MM = (18.0, 14.0)
"""Room left of the diagram and below it, for numbers and names [mm]."""
LOOKS: Mapping[Whose, tuple[str, str]] = {
    "reference": (DRAWN, "-"),
    "log": (LOGGED, "--"),
    "its own part": (RAY, ":"),
}
MARKERS = ("o", "s")
GUIDE = 0.5
"""Height of the slope of order 2 below the first line, as a factor."""


def draw_errors(errors: GraphErrors, paper: Paper, note: str) -> Canvas:
    """Draw a line for each drawn graph, of the reference and of a log. Raises CrankcheckError where
    all are right to rounding."""
    of = errors.span
    title = f"{of.scene.name}: {of.quantity.name} by {errors.by}, errors over divisions"
    canvas, _ = headed(paper, title, note)
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
            f"{errors.span.quantity.name} of {errors.span.scene.name} is drawn exactly with any "
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
    error above rounding."""
    parts, error = next(
        (parts, error)
        for line in lines
        for parts, error in zip(divisions, line.errors, strict=True)
        if error > NOTHING
    )
    counts = np.array([divisions[0], divisions[-1]], dtype=float)
    return counts, GUIDE * error * (parts / counts) ** 2
