"""The driving torque with elastic links and with rigid ones."""

from __future__ import annotations

from matplotlib.artist import Artist
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from reports.describe.elastic_course import ElasticCourse
from reports.figures.elastic.course_axis import ELASTIC, RIGID, SIDES, CourseAxis, notes
from reports.figures.sheet import Panels, sheet
from reports.figures.style import COLUMN_IN


def draw(course: ElasticCourse) -> Figure | None:
    """Two panels, the torques and their difference; None without a drive."""
    if course.torques is None:
        return None
    elastic, rigid = course.torques
    entries: list[tuple[Artist, str]] = [
        (Line2D([], [], **ELASTIC), "elastic links"),  # type: ignore[arg-type]  # looks of a line
        (Line2D([], [], **RIGID), "rigid links"),  # type: ignore[arg-type]  # as above
    ]
    axis = CourseAxis.of(course)
    title = f"Driving torque: {course.scene.name}"
    panels = Panels(2, 1, 1.25, *SIDES, 0.15, between=(0.15, 0.2))
    figure, (upper, lower) = sheet(COLUMN_IN, panels, title, entries, notes(course))
    upper.plot(axis.values, elastic, **ELASTIC)  # type: ignore[arg-type]  # as above
    upper.plot(axis.values, rigid, **RIGID)  # type: ignore[arg-type]  # as above
    upper.set_ylabel("torque [N m]")
    lower.plot(axis.values, elastic - rigid, **ELASTIC)  # type: ignore[arg-type]  # as above
    lower.set_ylabel("elastic less rigid [N m]")
    axis.mark(upper, labelled=False)
    axis.mark(lower)
    return figure
