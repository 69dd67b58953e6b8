"""Kinetic and potential energy over time, their sum, and the work that is done on them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from reports.figures.free.free_course import SIDES, FreeCourse, mark_zero
from reports.figures.sheet import Panels, sheet
from reports.figures.style import COLUMN_IN, INK

KINETIC: Mapping[str, Any] = {"color": "#c04a1d", "linewidth": 1.0}
POTENTIAL: Mapping[str, Any] = {"color": "#1f5f9e", "linewidth": 1.0}
TOTAL: Mapping[str, Any] = {"color": INK, "linewidth": 0.9, "linestyle": (0, (5.0, 2.0))}
WORK: Mapping[str, Any] = {
    "color": "#2f7d4c",
    "linewidth": 0.9,
    "linestyle": (0, (6.0, 1.5, 1.0, 1.5)),
}
ROUNDING = 1e-9


def draw(course: FreeCourse) -> Figure:
    """One panel. The potential energy counts from its lowest on the way; what stays at 0 is left
    out."""
    potential = course.potential - np.min(course.potential)
    largest = float(max(np.max(course.kinetic), np.max(potential)))
    lines = [("kinetic", course.kinetic, KINETIC)]
    if np.max(potential) > ROUNDING * largest:
        lines.append(("potential (weights, springs)", potential, POTENTIAL))
        lines.append(("total", course.kinetic + potential, TOTAL))
    if np.max(np.abs(course.work)) > ROUNDING * largest:
        lines.append(("work of loads, dampers, friction", course.work, WORK))
    entries = [(Line2D([], [], **look), label) for label, _, look in lines]
    panels = Panels(1, 1, 2.1, *SIDES, 0.15)
    title = f"Energy: {course.scene.name}"
    figure, (axes,) = sheet(COLUMN_IN, panels, title, entries, course.notes_over_time)
    mark_zero(axes, *(series for _, series, _ in lines))
    for _, series, look in lines:
        axes.plot(course.time_s, series, **look)
    axes.set_xlabel("time [s]")
    axes.set_ylabel("energy [J]")
    course.mark_time(axes)
    return figure
