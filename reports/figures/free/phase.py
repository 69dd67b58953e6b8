"""The phase diagram: the driver's angular velocity over its angle."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MultipleLocator

from models.array import Array
from reports.figures.free.free_course import SIDES, FreeCourse, mark_zero, shorten
from reports.figures.sheet import Panels, sheet
from reports.figures.style import COLUMN_IN

LOOK: Mapping[str, Any] = {"color": "#1f5f9e", "linewidth": 0.8}
START: Mapping[str, Any] = {
    "color": "#c04a1d",
    "marker": "o",
    "markersize": 3.5,
    "linestyle": "none",
}


def draw(course: FreeCourse) -> Figure:
    """One panel; where the driver turns round, all turns lie over one another."""
    degrees, omega, label = np.degrees(course.driver.theta), course.driver.omega, "angle of"
    turning = float(np.ptp(degrees)) > 360.0
    if turning:
        degrees, omega = _over_one_turn(degrees, omega)
        label = "angle within a turn of"
    panels = Panels(1, 1, 2.1, *SIDES, 0.15)
    title = f"Phase diagram: {course.scene.name}"
    notes = [*course.notes, "The dot is the start."]
    figure, (axes,) = sheet(COLUMN_IN, panels, title, [], notes)
    mark_zero(axes, course.driver.omega)
    axes.plot(degrees, omega, **LOOK)
    axes.plot(degrees[:1], omega[:1], **START)
    axes.set_xlabel(f"{label} {course.scene.driver.link} [deg]")
    axes.set_ylabel("angular velocity [rad/s]")
    shorten(axes)
    if turning:
        axes.set_xlim(0.0, 360.0)
        axes.xaxis.set_major_locator(MultipleLocator(60.0))
    return figure


def _over_one_turn(degrees: Array, omega: Array) -> tuple[Array, Array]:
    """Angles within a turn, the curve cut where one turn goes over into the next: there it ends at
    one side and goes on at the other."""
    turn = np.floor(np.round(degrees, 9) / 360.0)
    cuts = np.flatnonzero(np.diff(turn)) + 1
    before, after = turn[cuts - 1], turn[cuts]
    edge = 360.0 * np.maximum(before, after)
    share = (edge - degrees[cuts - 1]) / (degrees[cuts] - degrees[cuts - 1])
    there = omega[cuts - 1] + share * (omega[cuts] - omega[cuts - 1])
    none = np.full(cuts.size, math.nan)
    sides = np.column_stack([edge - 360.0 * before, none, edge - 360.0 * after])
    place = np.repeat(cuts, 3)
    return (
        np.insert(degrees - 360.0 * turn, place, sides.ravel()),
        np.insert(omega, place, np.column_stack([there, none, there]).ravel()),
    )
