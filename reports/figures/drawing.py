"""A figure of a store, and the marks and words of its lines."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import pandas as pd
from matplotlib.figure import Figure

from reports.output.numbers import floor_words
from reports.output.palette import COLOURS
from reports.results.lines import Line, Named
from reports.results.looks import SYMBOLS, looks
from reports.results.overview import Report


@dataclass(frozen=True)
class Drawing:
    """Functions of a figure, for one scene and over all of them; None where it has no such form.

    Each gives None where a store has nothing to draw. Files are called ``name-scene`` and ``name``.
    ``drives`` are the kinds of cells that it shows (`reports.protocol.way.Way.kinds`).
    """

    of: Callable[[Report, str], Figure | None] | None = None
    over_all: Callable[[Report], Figure | None] | None = None
    drives: tuple[str, ...] = ("driven",)


WORDS = {
    "grows": "grows as the step shrinks",
    "irregular": "no order",
    "diverges": "",  # `ends` says it
}


def measured(line: Line) -> pd.DataFrame:
    """Return the cells that ended well with an error above 0, from coarse to fine."""
    cells = line.cells
    return cells[(cells["status"] == "ok") & _positive(cells["place_pure"])]


def timed(line: Line) -> pd.DataFrame:
    """Return the timed cells among them."""
    cells = measured(line)
    return cells[_positive(cells["s_per_turn"])]


def ends(line: Line) -> str:
    """Return the endings of the other runs of a line, such as "2 of 7 diverged"; or ""."""
    statuses = Counter(str(status) for status in line.cells["status"])
    del statuses["ok"]
    return ", ".join(f"{n} of {len(line.cells)} {status}" for status, n in statuses.items())


def fitted(line: Line) -> str:
    """Return the fit of a line, in two or three words."""
    fit = line.fit
    order = f"order {fit.order:.2f} ± {fit.order_error:.2f}"
    if fit.kind == "order":
        return "; ".join(filter(None, (order, floor_words(math.nan, fit.floor_below))))
    if fit.kind == "floor":
        return floor_words(fit.floor) + (f", {order}" if math.isfinite(fit.order) else "")
    return WORDS.get(fit.kind, fit.kind)


def around(values: Iterable[float], least: float = 1.6, spare: float = 0.2) -> tuple[float, float]:
    """Return limits of a logarithmic axis around values, with some room beside them [decades]."""
    powers = [math.log10(value) for value in values]
    low, high = (min(powers), max(powers)) if powers else (-0.5, 0.5)
    more = max(least - (high - low), 0.0) / 2 + spare
    return 10.0 ** (low - more), 10.0 ** (high + more)


def _positive(values: pd.Series[float]) -> pd.Series[bool]:
    return (values > 0.0) & (values < math.inf)


HOURGLASS = ((-1, 1), (1, 1), (-1, -1), (1, -1))
MARKERS = dict(zip(SYMBOLS, ("o", "s", "D", "^", "P", "*", "v", HOURGLASS, "X"), strict=True))
DASHES: tuple[tuple[float, ...], ...] = (
    (),
    (4.0, 1.5),
    (1.0, 1.2),
    (6.0, 1.5, 1.0, 1.5),
    (2.5, 1.0),
    (6.0, 1.2, 1.0, 1.2, 1.0, 1.2),
    (9.0, 2.0),
)
"""Lengths of dashes and gaps in line widths; the empty one is a whole line."""


@dataclass(frozen=True)
class Mark:
    """Look of the curve of a variant."""

    marker: object
    dashes: tuple[float, ...]
    colour: str
    size: float

    def scaled(self, factor: float) -> Mark:
        """Return the same with smaller markers, for smaller panels."""
        return replace(self, size=factor * self.size)

    @property
    def style(self) -> dict[str, Any]:
        """Arguments of `Axes.plot`."""
        return {**self.line, **self.points}

    @property
    def line(self) -> dict[str, Any]:
        """Arguments of the line alone."""
        dashes: object = (0, self.dashes) if self.dashes else "-"
        return {"color": self.colour, "linestyle": dashes, "linewidth": 1.0}

    @property
    def points(self) -> dict[str, Any]:
        """Arguments of the marker alone."""
        return {
            "marker": self.marker,
            "markersize": self.size,
            "markerfacecolor": self.colour,
            "markeredgecolor": self.colour,
            "markeredgewidth": 0.8,
        }


def marks(lines: Iterable[Line]) -> Mapping[Named, Mark]:
    """Return a mark for each variant: its look on the page, on white paper.

    No two have the same marker and dashes.
    """
    before: Counter[str] = Counter()
    every: dict[Named, Mark] = {}
    for name, look in looks(lines).items():
        every[name] = Mark(
            marker=MARKERS[look.symbol],
            dashes=_dashes(before[look.engine]),
            colour=COLOURS[look.colour],
            size=0.36 * look.size,  # [point]
        )
        before[look.engine] += 1
    return every


def _dashes(turn: int) -> tuple[float, ...]:
    """Return the dashes of a number: from the list, then the same ones longer and longer."""
    round_, at = divmod(turn, len(DASHES))
    if not round_:
        return DASHES[at]
    return tuple(length + 1.5 * round_ for length in DASHES[at] or (12.0, 1.0))
