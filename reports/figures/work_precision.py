"""Work-precision diagram: the error that a second of computing buys, and what nothing beats.

Both axes are logarithmic. A curve is a variant from its coarsest step (left) to its finest; the
broad grey stair is the Pareto front: whatever is below it takes longer. Source: Hairer, Norsett,
Wanner, Solving Ordinary Differential Equations I, section II.4.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

import pandas as pd
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from reports.figures.drawing import around, ends, timed
from reports.figures.grids import grid
from reports.figures.marks import Mark, marks
from reports.figures.sheet import Panels, sheet
from reports.figures.style import COLUMN_IN, FRONT, logarithmic
from reports.results.candidates import front, front_over_all
from reports.results.lines import Line, Named, named
from reports.results.overview import Report, notes
from reports.results.variants import label

COST = "time per simulated turn [s]"
ALL = "all scenes: worst error, mean time"
CostAndError = tuple[float, float]


def draw(report: Report, scene: str) -> Figure | None:
    """The diagram of one scene; None where none of its cells was timed."""
    own, mark_of = report.lines_of(scene), marks(report.lines)
    if not _points(own):
        return None
    entries = [*_entries(own, mark_of), _front_entry()]
    title, under = f"Work and precision: {scene}", notes(report, own, timed=True)
    figure, (axes,) = sheet(COLUMN_IN, Panels(top=0.05), title, entries, under)
    _limits([axes], _points(own))
    _panel(axes, report, own, mark_of)
    axes.set_xlabel(COST)
    axes.set_ylabel(own[0].kind.axis)
    return figure


def draw_all(report: Report) -> Figure | None:
    """The diagrams of all scenes side by side, and one over all of them; None as for `draw`."""
    lines, scenes = report.lines, list(report.scenes)
    if not _points(lines):
        return None
    mark_of = marks(lines)
    names = [ALL, *scenes]
    entries = [*_entries(lines, mark_of), _front_entry()]
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
    """The curves of one scene over its front."""
    cells = pd.concat([line.cells for line in lines])
    best = cells.set_index("key").loc[front(cells, report.noise)]
    _stair(axes, zip(best["s_per_turn"], best["place_pure"], strict=True))
    for line in lines:
        rows = timed(line)
        axes.plot(rows["s_per_turn"], rows["place_pure"], **mark_of[named(line)].style)


def _over(axes: Axes, report: Report, mark_of: Mapping[Named, Mark]) -> None:
    """The curves over all scenes: variants that fail on one of them have no point."""
    over = report.candidates
    best = front_over_all(over, report.noise)
    _stair(axes, ((one.s_per_turn, one.worst_error) for one in best))
    for name, mark in mark_of.items():
        own = [one for one in over if (one.engine, one.variant, one.drive) == name]
        points = [(c.s_per_turn, c.worst_error) for c in own if not c.faults]
        axes.plot(*zip(*points, strict=True) if points else ([], []), **mark.style)


def _stair(axes: Axes, points: Iterable[CostAndError]) -> None:
    """The front: from each point on its error is had, until a slower cell has less."""
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
    """The same limits for all panels."""
    for one in axes:
        logarithmic(one, "x", *around(time_s for time_s, _ in points))
        logarithmic(one, "y", *around(error for _, error in points))


def _entries(lines: Sequence[Line], mark_of: Mapping[Named, Mark]) -> list[tuple[Artist, str]]:
    """The legend: a variant each; how runs ended that have no point, where it is one scene."""
    single = len({line.scene for line in lines}) == 1
    entries: dict[Named, tuple[Artist, str]] = {}
    for line in lines:
        name = named(line)
        fate = ends(line) if single else ""
        words = label(name) + (f" ({fate})" if fate else "")
        entries.setdefault(name, (Line2D([], [], **mark_of[name].style), words))
    return list(entries.values())


def _front_entry() -> tuple[Artist, str]:
    return Line2D([], [], color=FRONT, linewidth=4.0), "Pareto front"
