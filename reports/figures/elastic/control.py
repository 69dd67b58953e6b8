"""What a controller makes of elastic links: deflection and speed with it, and with the torque of
the rigid mechanism alone, drawn over each other."""

from __future__ import annotations

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from models.driver import Controlled
from models.motion import Motion
from reports.describe.elastic_course import ElasticCourse
from reports.figures.elastic.course_axis import DASHES, ELASTIC, RIGID, SIDES, CourseAxis, notes
from reports.figures.sheet import Panels, sheet
from reports.figures.style import COLUMN_IN, QUIET

WITHOUT = RIGID | {"linestyle": "-"}


def draw(course: ElasticCourse) -> Figure | None:
    """Three panels: deflections, the driver's speed, and how far it is ahead of what it was told;
    None without a controller."""
    law = course.scene.driver.law
    if course.uncontrolled is None or not isinstance(law, Controlled):
        return None
    gains = f"kP = {law.kp_n_m_rad:g} N m/rad, kD = {law.kd_n_m_s:g} N m s/rad"
    entries: list[tuple[Artist, str]] = [
        (Line2D([], [], **ELASTIC), f"controlled, {gains}"),  # type: ignore[arg-type]  # looks of a line
        (Line2D([], [], **WITHOUT), "not controlled: the torque of rigid links alone"),  # type: ignore[arg-type]  # as above
    ]
    title = f"With and without control: {course.scene.name}"
    panels = Panels(3, 1, 1.15, *SIDES, 0.15, between=(0.15, 0.2))
    figure, panes = sheet(COLUMN_IN, panels, title, entries, notes(course))
    for motion, look in ((course.uncontrolled, WITHOUT), (course.motion, ELASTIC)):
        _curves(panes, course, motion, look)
    driver = course.scene.driver.link
    panes[1].axhline(law.speed_rad_s, color=QUIET, linewidth=0.5)
    panes[0].set_ylabel("deflection [mm]")
    panes[1].set_ylabel(f"speed of {driver} [rad/s]")
    panes[2].set_ylabel(f"{driver} ahead by [deg]")
    axis = CourseAxis(course.time_s, "time [s]")
    for pane in panes:
        axis.mark(pane, labelled=pane is panes[-1])
    return figure


def _curves(
    panes: list[Axes], course: ElasticCourse, motion: Motion, look: dict[str, object]
) -> None:
    """One of the two motions in all panels; several elastic links differ in their dashes."""
    driver, time_s = course.scene.driver, course.time_s
    bending = [name for name, own in course.scene.elastic.items() if own.bends]
    for name, dash in zip(bending, DASHES * len(bending), strict=False):
        panes[0].plot(time_s, 1e3 * motion.elastic[name].middle, **look | {"linestyle": dash})  # type: ignore[arg-type]  # looks of a line
    own = motion.links[driver.link]
    panes[1].plot(time_s, own.omega, **look)  # type: ignore[arg-type]  # as above
    panes[2].plot(time_s, np.degrees(own.theta - driver.law.at(time_s)[0]), **look)  # type: ignore[arg-type]  # as above
