"""Work-precision diagram, the error that a second of computing buys with its Pareto front, and
performance profile, how often a variant is the fastest to an error.

Both axes are logarithmic. A curve is a variant from its coarsest step (left) to its finest; the
broad grey stair is the Pareto front: anything below it takes longer. Source: Hairer, Norsett,
Wanner, Solving Ordinary Differential Equations I, section II.4.
"""

import math
from collections.abc import Iterable, Mapping, Sequence

import pandas as pd
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator

from reports.figures.coinciding import count_coinciding
from reports.figures.drawing import Mark, around, ends, marks, timed
from reports.figures.sheet import Panels, grid, sheet
from reports.figures.style import COLUMN_IN, FRONT, logarithmic, power_of_ten
from reports.protocol.way import TARGETS
from reports.results.candidates import front, front_over_all, performance_profile
from reports.results.lines import Line, Named, label, named
from reports.results.overview import Report, notes

COST = "time per simulated turn [s]"
ALL = "all scenes: worst error, mean time"
CostAndError = tuple[float, float]


def draw(report: Report, scene: str) -> Figure | None:
    """Draw the diagram of one scene; None where none of its cells was timed."""
    own, mark_of = report.lines_of(scene), marks(report.lines)
    if not _points(own):
        return None
    entries = _entries(own, mark_of)
    title, under = f"Work and precision: {scene}", notes(report, own, timed=True)
    figure, (axes,) = sheet(COLUMN_IN, Panels(top=0.05), title, entries, under)
    _limits([axes], _points(own))
    _panel(axes, report, own, mark_of)
    axes.set_xlabel(COST)
    axes.set_ylabel(own[0].kind.axis)
    return figure


def draw_all(report: Report) -> Figure | None:
    """Draw the diagrams of all scenes side by side, and one over all; None as for `draw`."""
    lines, scenes = report.lines, list(report.scenes)
    if not _points(lines):
        return None
    mark_of = marks(lines)
    names = [ALL, *scenes]
    entries = _entries(lines, mark_of)
    title, under = "Work and precision", notes(report, lines, timed=True)
    figure, axes = grid(names, title, (COST, lines[0].kind.axis), entries, under)
    mark_of = {name: mark.scaled(0.75) for name, mark in mark_of.items()}
    _limits(axes, _points(lines))
    _over(axes[0], report, mark_of)
    for scene, one in zip(scenes, axes[1:], strict=True):
        _panel(one, report, report.lines_of(scene), mark_of)
    return figure


def _panel(
    axes: Axes, report: Report, lines: Sequence[Line], mark_of: Mapping[Named, Mark]
) -> None:
    cells = pd.concat([line.cells for line in lines])
    best = cells.set_index("key").loc[front(cells, report.noise)]
    _stair(axes, zip(best["s_per_turn"], best["place_pure"], strict=True))
    for line in lines:
        rows = timed(line)
        axes.plot(rows["s_per_turn"], rows["place_pure"], **mark_of[named(line)].style)
    count_coinciding(axes, axes.lines[1:])  # behind the front


def _over(axes: Axes, report: Report, mark_of: Mapping[Named, Mark]) -> None:
    """Draw the curves over all scenes: variants that fail on one of them have no point."""
    over = report.candidates
    best = front_over_all(over, report.noise)
    _stair(axes, ((one.s_per_turn, one.worst_error) for one in best))
    for name, mark in mark_of.items():
        own = [one for one in over if (one.engine, one.variant, one.drive) == name]
        points = [(c.s_per_turn, c.worst_error) for c in own if not c.faults]
        axes.plot(*zip(*points, strict=True) if points else ([], []), **mark.style)
    count_coinciding(axes, axes.lines[1:])


def _stair(axes: Axes, points: Iterable[CostAndError]) -> None:
    """Draw the front: from each point on its error holds, until a slower cell has less."""
    corners = sorted((float(time_s), float(error)) for time_s, error in points)
    if not corners:
        return
    times, errors = map(list, zip(*corners, strict=True))
    low, high = axes.get_ylim()[1], axes.get_xlim()[1]
    axes.plot(
        [times[0], *times, high],
        [low, *errors, errors[-1]],
        color=FRONT,
        linewidth=4.0,
        drawstyle="steps-post",
        solid_joinstyle="miter",
        zorder=1,
    )


def _points(lines: Sequence[Line]) -> list[CostAndError]:
    rows = [timed(line) for line in lines]
    return [
        (float(t), float(e))
        for r in rows
        for t, e in zip(r["s_per_turn"], r["place_pure"], strict=True)
    ]


def _limits(axes: Sequence[Axes], points: Sequence[CostAndError]) -> None:
    for one in axes:
        logarithmic(one, "x", *around(time_s for time_s, _ in points))
        logarithmic(one, "y", *around(error for _, error in points))


def _entries(lines: Sequence[Line], mark_of: Mapping[Named, Mark]) -> list[tuple[Artist, str]]:
    """Return the legend of variants, for one scene with the endings of runs without a point, and of
    the front."""
    single = len({line.scene for line in lines}) == 1
    entries: dict[Named, tuple[Artist, str]] = {}
    for line in lines:
        name = named(line)
        fate = ends(line) if single else ""
        words = label(name) + (f" ({fate})" if fate else "")
        entries.setdefault(name, (Line2D([], [], **mark_of[name].style), words))
    return [*entries.values(), (Line2D([], [], color=FRONT, linewidth=4.0), "Pareto front")]


FACTOR = "time over that of the fastest [-]"
SHARE = "share of the scenes [%]"
ROUND = (1, 2, 5)


def draw_profile(report: Report) -> Figure | None:
    """Draw how often each variant is the fastest to an error, and by how much it is slower
    elsewhere, over all scenes: a panel per target error; None where nothing was timed. Source:
    Dolan and More, Benchmarking optimization software with performance profiles, 2002."""
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
            _profile(one, corners, by_label[f"{engine} {variant}"], 1.3 * last)
    return figure


def _axes(axes: Axes, last: float) -> None:
    """Set factors from 1 to ``last``, shares from 0 to 100 %."""
    axes.set_xscale("log")
    axes.set_xlim(0.9, 1.3 * last)
    every = [n * 10.0**k for k in range(math.ceil(math.log10(last)) + 1) for n in ROUND]
    axes.xaxis.set_major_locator(FixedLocator(every[:: 1 + (last > 30.0)]))
    axes.xaxis.set_major_formatter(FuncFormatter(lambda factor, _: f"{factor:g}"))
    axes.xaxis.set_minor_locator(NullLocator())
    axes.set_ylim(-3.0, 105.0)


def _profile(axes: Axes, corners: pd.DataFrame, mark: Mark, end: float) -> None:
    """Draw the stair of a variant, with a marker where it rises; none where it never does."""
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
