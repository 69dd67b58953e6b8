"""Convergence plot: the error at every step, and the order or floor of the fit.

Points are measured. The curve of a fit goes over its own steps; the other points hang on a
hairline. A floor that is seen is drawn on to the left edge. A run that did not end well stands in a
strip along the top, at its step.
"""

from __future__ import annotations

import itertools
import math
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Rectangle
from matplotlib.ticker import FixedFormatter, FixedLocator, NullLocator

from reports.figures.coinciding import count_coinciding
from reports.figures.drawing import Mark, around, ends, fitted, marks, measured
from reports.figures.sheet import Panels, grid, sheet
from reports.figures.style import COLUMN_IN, SMALL, logarithmic, width_in
from reports.output.numbers import duration
from reports.protocol.length import FACETS, SECONDS, TURNS, common_clock
from reports.results.lines import Line, Named, named
from reports.results.overview import Report, notes

STEP, TIME = "time step [s]", "time step"
PER_TURN = "steps per turn"
SIDES_OF = "facets of the cam"
STRIP = "#f0f0f0"
ALONG = 60
"""Points along the curve of a fit."""


def draw(report: Report, scene: str) -> Figure:
    """Draw the plot of one scene, with steps per turn along the top."""
    own, mark_of = report.lines_of(scene), marks(report.lines)
    panels = Panels(top=0.27)
    title, under = f"Convergence: {scene}", notes(report, own)
    figure, (axes,) = sheet(
        COLUMN_IN, panels, title, _entries(report, own, mark_of), under, columns=1
    )
    _limits([axes], own, 1.0)
    _panel(axes, own, mark_of, 1.0)
    strip = _strip(own)
    _failed(axes, own, mark_of, 1.0, strip)
    if strip:
        right: dict[str, Any] = {"ha": "right", "va": "center", "transform": axes.transAxes}
        axes.text(-0.02, 1.0 - strip / 2, "failed", size=SMALL, **right)
    over = _over(report, own)
    axes.set_xlabel(over.label)
    axes.set_ylabel(_error_of(own))
    over.ticks(axes, own)
    return figure


def draw_all(report: Report) -> Figure:
    """Draw the plots of all scenes side by side, over steps per turn, or time of free motions."""
    lines, scenes, mark_of = report.lines, list(report.scenes), marks(report.lines)
    entries: list[tuple[Artist, str]] = [
        (Line2D([], [], **mark.style), report.looks[name].name) for name, mark in mark_of.items()
    ]
    strip = _strip(lines)
    if strip:
        entries.append((Rectangle((0, 0), 1, 1, fc=STRIP), "strip along the top: failed"))
    mark_of = {name: mark.scaled(0.75) for name, mark in mark_of.items()}
    over = _over(report, lines)
    labels = (over.label_of_all, _error_of(lines))
    figure, axes = grid(scenes, "Convergence", labels, entries, notes(report, lines))
    _limits(axes, lines, over.unit_s)
    for scene, one in zip(scenes, axes, strict=True):
        own = report.lines_of(scene)
        unit_s = over.unit_s or own[0].period_s
        _panel(one, own, mark_of, unit_s)
        _failed(one, own, mark_of, unit_s, strip)
        over.ticks_of_all(one, own)
    return figure


def draw_over_facets(report: Report) -> Figure | None:
    """Draw the errors of cams by contact over their facets; None where they have one number."""
    own = report.over_facets
    if own is None:
        return None
    return draw(own, *own.scenes) if len(own.scenes) == 1 else draw_all(own)


def _over(report: Report, lines: Sequence[Line]) -> Over:
    return OVER[report.clock or common_clock(line.drive for line in lines)]


def _error_of(lines: Sequence[Line]) -> str:
    """Return the label of the errors; rigid and elastic links are not drawn together."""
    return min((line.kind for line in lines), key=lambda kind: kind.leads).axis


def _panel(axes: Axes, lines: Sequence[Line], mark_of: Mapping[Named, Mark], unit_s: float) -> None:
    """Draw points, fits and floors of one scene; steps in ``unit_s``."""
    left, curves = axes.get_xlim()[0], []
    for line in lines:
        mark, rows, fit = mark_of[named(line)], measured(line), line.fit
        x = rows["dt_s"] / unit_s
        axes.plot(x, rows["place_pure"], color=mark.colour, linewidth=0.35)
        curves += axes.plot(x, rows["place_pure"], linestyle="none", **mark.points)
        if fit.curve is not None:
            dts = np.geomspace(*fit.used_range_s, ALONG)
            axes.plot(dts / unit_s, [fit.curve.at(dt) for dt in dts], **mark.line)
        if math.isfinite(fit.floor):
            ends_at = fit.used_range_s[0] / unit_s
            axes.plot([left, ends_at], [fit.floor, fit.floor], **mark.line | {"linewidth": 0.6})
    count_coinciding(axes, curves)


def _failed(
    axes: Axes, lines: Sequence[Line], mark_of: Mapping[Named, Mark], unit_s: float, strip: float
) -> None:
    """Draw the runs that did not end well, in rows of a strip along the top."""
    rows = [line for line in lines if ends(line)]
    if not rows:
        return
    across = axes.get_xaxis_transform()
    box = Rectangle((0.0, 1.0 - strip), 1.0, strip, transform=axes.transAxes, fc=STRIP, zorder=0.5)
    axes.add_patch(box)
    for at, line in enumerate(rows):
        steps = line.cells.loc[line.cells["status"] != "ok", "dt_s"] / unit_s
        high = 1.0 - strip * (at + 0.5) / len(rows)
        axes.plot(
            steps, [high] * len(steps), ls="none", transform=across, **mark_of[named(line)].points
        )


def _strip(lines: Sequence[Line]) -> float:
    failed = Counter(line.scene for line in lines if ends(line))
    return min(0.075 * max(failed.values(), default=0), 0.3)


def _limits(axes: Sequence[Axes], lines: Sequence[Line], unit_s: float) -> None:
    """Set the same limits for all panels; steps in ``unit_s``, a share of a turn for 0."""
    steps = [
        float(s) / unit_s if unit_s else 1.0 / float(s)
        for line in lines
        for s in line.cells["dt_s" if unit_s else "steps_per_turn"]
    ]
    low, high = around(float(e) for line in lines for e in measured(line)["place_pure"])
    strip = _strip(lines)
    for one in axes:
        logarithmic(one, "x", *around(steps))
        logarithmic(one, "y", low, high)
        one.set_ylim(low, high * (high / low) ** (strip / (1.0 - strip)))


def _upper(axes: Axes, lines: Sequence[Line]) -> None:
    upper = axes.twiny()
    upper.set_xscale("log")
    upper.set_xlim(axes.get_xlim())
    _count(upper, lines, lines[0].period_s)
    upper.grid(visible=False)
    upper.set_xlabel(PER_TURN)


def _count(axes: Axes, lines: Sequence[Line], period_s: float = 1.0) -> None:
    """Set ticks of an axis over steps at the steps per turn that were run, as many as have room."""
    numbers = {float(n) for line in lines for n in line.cells["steps_per_turn"]}
    _ticks(axes, {period_s / n: f"{n:g}" for n in numbers})


def _time(axes: Axes, lines: Sequence[Line]) -> None:
    """Set ticks of an axis over steps of time at the ones that were run, as many as have room."""
    steps = {float(s) for line in lines for s in line.cells["dt_s"]}
    parts = {step: duration(step).split() for step in steps}
    _ticks(axes, {step: f"{float(size):g} {unit}" for step, (size, unit) in parts.items()})


def _ticks(axes: Axes, texts: Mapping[float, str]) -> None:
    """Set ticks of an axis over steps at some of these places: from the coarsest on every one,
    every second, or as many as have room."""
    places = sorted(texts, reverse=True)
    low, high = axes.get_xlim()
    figure = axes.get_figure(root=True)
    assert figure is not None
    width = axes.get_position().width * figure.get_figwidth() / math.log(high / low)

    def fits(kept: Sequence[float]) -> bool:
        return all(
            math.log(a / b) * width > 0.5 * (width_in(texts[a]) + width_in(texts[b])) + 0.06
            for a, b in itertools.pairwise(kept)
        )

    every = next((k for k in range(1, len(places)) if fits(places[::k])), len(places))
    kept = places[::every]
    axes.xaxis.set_major_locator(FixedLocator(kept))
    axes.xaxis.set_major_formatter(FixedFormatter([texts[place] for place in kept]))
    axes.xaxis.set_minor_locator(NullLocator())


def _entries(
    report: Report, lines: Sequence[Line], mark_of: Mapping[Named, Mark]
) -> list[tuple[Artist, str]]:
    """Return the legend: each variant with its fit, and the ending of its other runs."""
    return [
        (
            Line2D([], [], **mark_of[named(line)].style),
            ": ".join(
                [report.look(line).name, ", ".join(filter(None, (fitted(line), ends(line))))]
            ),
        )
        for line in lines
    ]


@dataclass(frozen=True)
class Over:
    """Axis of steps: in one panel, and in panels of all scenes in a unit of time, 0 for a turn."""

    label: str
    ticks: Callable[[Axes, Sequence[Line]], None]
    label_of_all: str
    ticks_of_all: Callable[[Axes, Sequence[Line]], None]
    unit_s: float


OVER = {
    TURNS: Over(STEP, _upper, PER_TURN, _count, 0.0),
    SECONDS: Over(TIME, _time, TIME, _time, 1.0),
    FACETS: Over(
        SIDES_OF, lambda axes, own: _count(axes, own, own[0].period_s), SIDES_OF, _count, 0.0
    ),
}
