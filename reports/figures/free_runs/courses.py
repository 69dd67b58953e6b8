"""Angle and angular velocity of the driver over time, the truth and the runs over it, and what they
are off by."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from reports.figures.free.free_course import mark_zero, shorten
from reports.figures.free_runs.free_run import free_runs
from reports.figures.sheet import Panels, sheet
from reports.figures.style import PAGE_IN, logarithmic
from reports.results.drawable import around
from reports.results.overview import Report

TRUTH: Mapping[str, Any] = {"color": "#cccccc", "linewidth": 3.0}
LEAST = 1e-12
"""Errors of phase below are rounding."""


def draw(report: Report, name: str) -> Figure | None:
    """Three panels, one over the other; None where nothing of the scene was let go."""
    shown = free_runs(report, name)
    if shown is None:
        return None
    entries = [(Line2D([], [], **TRUTH), "truth, integrated")]
    entries += [(Line2D([], [], **run.mark.line), run.name) for run in shown.runs]
    panels = Panels(3, 1, 1.3, 0.55, 0.1, 0.12, between=(0.15, 0.12))
    title = f"Let go: {name}, step {shown.steps}"
    figure, (angle, speed, phase) = sheet(PAGE_IN, panels, title, entries, shown.notes)
    unit, size = shown.unit
    driver = shown.scene.driver.link
    angle.plot(shown.time_s, shown.angle / size, **TRUTH)
    speed.plot(shown.time_s, shown.omega, **TRUTH)
    mark_zero(speed, shown.omega)
    sizes: list[float] = []
    for run in shown.runs:
        line = run.mark.line | {"linewidth": 0.9}
        angle.plot(run.time_s, run.angle / size, **line)
        if "omega" in run.trace:
            speed.plot(run.time_s, run.trace["omega"], **line)
        judged = np.abs(run.trace["phase"] / run.trace["growth"])
        largest = np.maximum.accumulate(np.nan_to_num(judged))
        phase.plot(run.time_s, np.where(judged > 0.0, judged, np.nan), **line | {"linewidth": 0.3})
        phase.plot(run.time_s, np.where(largest > 0.0, largest, np.nan), **line)
        sizes += [float(e) for e in largest[len(largest) // 50 :] if e > LEAST]
    logarithmic(phase, "y", *around(sizes), ticks=6)
    angle.set_ylabel(f"angle of {driver} [{unit}]")
    speed.set_ylabel("speed [rad/s]")
    phase.set_ylabel("error of angle / G [rad]")
    phase.set_xlabel("time [s]; thick in the last panel: the largest error so far")
    for panel in (angle, speed, phase):
        panel.set_xlim(0.0, float(shown.time_s[-1]))
    for panel in (angle, speed):
        shorten(panel)
        panel.tick_params(labelbottom=False)
    return figure
