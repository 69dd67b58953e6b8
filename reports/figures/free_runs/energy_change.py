"""What the energy of each run changed by: as it is, and as means over windows, whose last less the
first is the drift."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from reports.figures.free_runs.free_run import FreeRun, free_runs
from reports.figures.grids import grid
from reports.figures.style import INK, TINY, power_of_ten
from reports.output.numbers import short
from reports.results.overview import Report

RAW: Mapping[str, Any] = {"linewidth": 0.5}
MEANS: Mapping[str, Any] = {"linewidth": 1.6}

WORDS: Mapping[str, Any] = {
    "va": "top",
    "size": TINY,
    "bbox": {"facecolor": "white", "edgecolor": "none", "pad": 0.5},  # over a tick behind
}


def draw(report: Report, name: str) -> Figure | None:
    """A panel for each run, with a scale of its own; None where no run has an energy."""
    shown = free_runs(report, name)
    runs = [run for run in shown.runs if run.energy is not None] if shown else []
    if shown is None or not runs:
        return None
    entries = [
        (Line2D([], [], color=INK, **RAW), "energy less the work of loads and dampers, as it is"),
        (Line2D([], [], color=INK, **MEANS), "means over windows"),
    ]
    title = f"Change of energy over the largest kinetic energy: {name}, step {shown.steps}"
    labels = ("time [s]", "change of energy / largest kinetic energy")
    titles = [run.name for run in runs]
    figure, axes = grid(titles, title, labels, entries, shown.notes, apart=True)
    for run, panel in zip(runs, axes, strict=True):
        means = run.energy_means(shown.scene)
        scale = _scale(run)
        assert run.energy is not None
        panel.plot(run.time_s, run.energy / scale, color=run.mark.colour, **RAW)
        panel.plot(run.time_s, means / scale, color=run.mark.colour, **MEANS)
        panel.set_xlim(0.0, float(shown.time_s[-1]))
        panel.yaxis.set_major_locator(MaxNLocator(4))
        low, high = panel.get_ylim()
        panel.set_ylim(low, high + 0.18 * (high - low))  # room for the words
        known = means[np.isfinite(means)]
        drift = f"drift {short(float(known[-1] - known[0]))}" if known.size else ""
        paper: Mapping[str, Any] = {"facecolor": "white", "edgecolor": "none", "pad": 0.5}
        words: Mapping[str, Any] = {
            "va": "top",
            "size": TINY,
            "transform": panel.transAxes,
            "bbox": paper,
        }
        panel.text(0.03, 0.96, f"[{power_of_ten(scale)}]", ha="left", **words)
        panel.text(0.97, 0.96, drift, ha="right", **words)
    return figure


def _scale(run: FreeRun) -> float:
    """The power of ten that a run's energy is drawn in."""
    assert run.energy is not None
    largest = float(np.nanmax(np.abs(run.energy)))
    return 10.0 ** math.floor(math.log10(largest)) if largest > 0.0 else 1.0
