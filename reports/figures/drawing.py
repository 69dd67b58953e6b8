"""What a figure of a store is, and what of a line it draws or says in words."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Iterable
from dataclasses import dataclass

import pandas as pd
from matplotlib.figure import Figure

from reports.results.lines import Line
from reports.results.overview import Report


@dataclass(frozen=True)
class Drawing:
    """What a figure shows, of one scene and over all of them; None where it has no such form.

    Each gives None where a store has nothing to draw. Files are called ``name-scene`` and ``name``.
    ``drives`` are the kinds of cells that it shows (`reports.way.way.Way.kinds`).
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
    """The cells that ended well with an error above 0, from coarse to fine."""
    cells = line.cells
    return cells[(cells["status"] == "ok") & _positive(cells["place_pure"])]


def timed(line: Line) -> pd.DataFrame:
    """Those of them that were timed."""
    cells = measured(line)
    return cells[_positive(cells["s_per_turn"])]


def ends(line: Line) -> str:
    """How the other runs of a line ended, such as "2 of 7 diverged"; empty where all ended well."""
    statuses = Counter(str(status) for status in line.cells["status"])
    del statuses["ok"]
    return ", ".join(f"{n} of {len(line.cells)} {status}" for status, n in statuses.items())


def fitted(line: Line) -> str:
    """What the fit of a line says, in two or three words."""
    fit = line.fit
    order = f"order {fit.order:.2f} ± {fit.order_error:.2f}"
    if fit.kind == "order":
        return order
    if fit.kind == "floor":
        return f"floor {fit.floor:.1e}" + (f", {order}" if math.isfinite(fit.order) else "")
    return WORDS.get(fit.kind, fit.kind)


def around(values: Iterable[float], least: float = 1.6, spare: float = 0.2) -> tuple[float, float]:
    """Limits of a logarithmic axis around values, some room beside them [decades]."""
    powers = [math.log10(value) for value in values]
    low, high = (min(powers), max(powers)) if powers else (-0.5, 0.5)
    more = max(least - (high - low), 0.0) / 2 + spare
    return 10.0 ** (low - more), 10.0 ** (high + more)


def _positive(values: pd.Series[float]) -> pd.Series[bool]:
    return (values > 0.0) & (values < math.inf)
