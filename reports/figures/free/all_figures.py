"""The figures of a free motion by name, which is that of their file. To add one, add a file and a
line here."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from matplotlib.figure import Figure

from reports.figures.free import energy, over_time, phase
from reports.figures.free.free_course import FreeCourse

FREE_FIGURES: Mapping[str, Callable[[FreeCourse], Figure]] = {
    "over-time": over_time.draw,
    "energy": energy.draw,
    "phase": phase.draw,
}
