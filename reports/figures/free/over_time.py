"""The driver's angle and angular velocity over time."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from reports.figures.free.free_course import SIDES, FreeCourse, mark_zero
from reports.figures.sheet import Panels, sheet
from reports.figures.style import COLUMN_IN

LOOK: Mapping[str, Any] = {"color": "#1f5f9e", "linewidth": 1.0}


def draw(course: FreeCourse) -> Figure:
    """Two panels, one over the other."""
    driver, name = course.driver, course.scene.driver.link
    panels = Panels(2, 1, 1.25, *SIDES, 0.15, between=(0.15, 0.12))
    title = f"Free motion: {course.scene.name}"
    figure, (upper, lower) = sheet(COLUMN_IN, panels, title, [], course.notes_over_time)
    turns = float(np.ptp(driver.theta)) > 4 * math.tau
    unit, per = ("turns", math.tau) if turns else ("deg", math.radians(1.0))
    upper.plot(course.time_s, driver.theta / per, **LOOK)
    upper.set_ylabel(f"angle of {name} [{unit}]")
    upper.tick_params(labelbottom=False)
    mark_zero(lower, driver.omega)
    lower.plot(course.time_s, driver.omega, **LOOK)
    lower.set_ylabel("angular velocity [rad/s]")
    lower.set_xlabel("time [s]")
    for axes in (upper, lower):
        course.mark_time(axes)
    return figure
