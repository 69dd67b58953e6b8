"""The angles of links with elastic links beside those with rigid ones, as the thesis draws them,
and by how much they are apart; displacements of sliders likewise."""

from __future__ import annotations

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from reports.describe.elastic_course import Apart, ElasticCourse
from reports.figures.elastic.course_axis import ELASTIC, RIGID, SIDES, CourseAxis, notes
from reports.figures.sheet import Panels, sheet
from reports.figures.style import PAGE_IN

MOST = 8
"""Links and sliders that one figure has room for: those that are furthest apart."""


def draw(course: ElasticCourse) -> Figure | None:
    """A row of two panels for each link that its joints let move otherwise; None where there is
    none."""
    each = _chosen(course)
    if not each:
        return None
    entries: list[tuple[Artist, str]] = [
        (Line2D([], [], **ELASTIC), "elastic links"),  # type: ignore[arg-type]  # looks of a line
        (Line2D([], [], **RIGID), "rigid links"),  # type: ignore[arg-type]  # as above
    ]
    axis = CourseAxis.of(course)
    height = 1.5 if len(each) == 1 else 1.15
    panels = Panels(len(each), 2, height, *SIDES, 0.15, between=(0.65, 0.2))
    title = f"Elastic beside rigid links: {course.scene.name}"
    figure, panes = sheet(PAGE_IN, panels, title, entries, notes(course))
    for row, one in enumerate(each):
        _row(panes[2 * row : 2 * row + 2], axis, one, is_last=row == len(each) - 1)
    return figure


def _chosen(course: ElasticCourse) -> list[Apart]:
    """At most so many, in the order of the scene; links that only a told driver moves are none."""
    every = [one for one in course.apart() if np.any(one.difference)]
    sizes = sorted((float(np.max(np.abs(one.difference))) for one in every), reverse=True)
    least = sizes[min(MOST, len(sizes)) - 1] if sizes else 0.0
    return [one for one in every if float(np.max(np.abs(one.difference))) >= least][:MOST]


def _row(panes: list[Axes], axis: CourseAxis, one: Apart, *, is_last: bool) -> None:
    """The two series, and their difference."""
    turns = one.unit == "rad"
    scale, unit = (np.degrees(1.0), "deg") if turns else (1.0, "m")
    left, right = panes
    left.plot(axis.values, scale * one.elastic, **ELASTIC)  # type: ignore[arg-type]  # looks of a line
    left.plot(axis.values, scale * one.rigid, **RIGID)  # type: ignore[arg-type]  # as above
    left.set_ylabel(f"{one.name} [{unit}]")
    right.plot(axis.values, one.difference, **ELASTIC)  # type: ignore[arg-type]  # as above
    right.set_ylabel(f"elastic less rigid [{one.unit}]")
    for each in panes:
        axis.mark(each, labelled=is_last)
