"""Performance profile over all scenes: how often a variant is the fastest to an error, and by how
much it is slower where it is not.

Source: Dolan and More, Benchmarking optimization software with performance profiles, 2002.
"""

from __future__ import annotations

import math

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator

from reports.figures.grids import grid
from reports.figures.marks import Mark, marks
from reports.figures.style import power_of_ten
from reports.results.candidates import performance_profile
from reports.results.lines import named
from reports.results.overview import Report, notes
from reports.results.variants import label
from reports.way.result_kind import TARGETS

FACTOR = "time over that of the fastest [-]"
SHARE = "share of the scenes [%]"
ROUND = (1, 2, 5)


def draw_all(report: Report) -> Figure | None:
    """A panel per target error; None where nothing was timed."""
    if not report.timed:
        return None
    lines, mark_of = report.lines, marks(report.lines)
    stairs = [performance_profile(lines, target, report.noise) for target in TARGETS]
    titles = [f"error up to {power_of_ten(target)} rad or L" for target in TARGETS]
    entries = [(Line2D([], [], **mark.style), label(name)) for name, mark in mark_of.items()]
    under = notes(report, lines, timed=True)
    title = "Performance profile: reached within a factor of the fastest"
    figure, axes = grid(titles, title, (FACTOR, SHARE), entries, under, height=1.6)
    by_label = {label(named(line)): mark_of[named(line)] for line in lines}
    last = max(float(stair["factor"].max()) for stair in stairs)
    for stair, one in zip(stairs, axes, strict=True):
        _axes(one, last)
        for (engine, variant), corners in stair.groupby(["engine", "variant"], sort=False):
            _stair(one, corners, by_label[f"{engine} {variant}"], 1.3 * last)
    return figure


def _axes(axes: Axes, last: float) -> None:
    """Factors from 1 to ``last``, shares from 0 to 100 %."""
    axes.set_xscale("log")
    axes.set_xlim(0.9, 1.3 * last)
    every = [n * 10.0**k for k in range(math.ceil(math.log10(last)) + 1) for n in ROUND]
    axes.xaxis.set_major_locator(FixedLocator(every[:: 1 + (last > 30.0)]))
    axes.xaxis.set_major_formatter(FuncFormatter(lambda factor, _: f"{factor:g}"))
    axes.xaxis.set_minor_locator(NullLocator())
    axes.set_ylim(-3.0, 105.0)


def _stair(axes: Axes, corners: pd.DataFrame, mark: Mark, end: float) -> None:
    """The stair of a variant, with a marker where it rises; none where it never does."""
    rises = corners[corners["share"] > 0.0]
    if rises.empty:
        return
    factors, shares = list(rises["factor"]), [100.0 * share for share in rises["share"]]
    first = [0.0] if factors[0] > 1.0 else []
    axes.plot(
        [factors[0]] * len(first) + factors + [end],
        first + shares + shares[-1:],
        drawstyle="steps-post",
        **mark.line,
    )
    axes.plot(factors, shares, linestyle="none", **mark.scaled(0.8).points)
