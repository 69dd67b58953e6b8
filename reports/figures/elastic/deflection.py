"""How far the middle of each elastic link is from the line between its pins."""

from __future__ import annotations

from matplotlib.artist import Artist
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from models.cut_links import line_of
from reports.describe.elastic_course import ElasticCourse
from reports.figures.elastic.course_axis import COLOURS, DASHES, SIDES, CourseAxis, notes
from reports.figures.sheet import Panels, sheet
from reports.figures.style import COLUMN_IN
from reports.output.numbers import readable


def draw(course: ElasticCourse) -> Figure | None:
    """One panel; None where no link bends."""
    names = [name for name, own in course.scene.elastic.items() if own.bends]
    if not names:
        return None
    entries: list[tuple[Artist, str]] = []
    looks = {}
    for k, name in enumerate(names):
        line = line_of(course.scene, name)
        looks[name] = {"color": COLOURS[k % len(COLOURS)], "linestyle": DASHES[k % len(DASHES)]}
        label = f"middle of {name}, {readable(0.5 * line.length_m)} m from {line.pins[0]}"
        entries.append((Line2D([], [], **looks[name]), label))  # type: ignore[arg-type]  # looks of a line
    axis = CourseAxis.of(course)
    title = f"Deflection: {course.scene.name}"
    panels = Panels(1, 1, 2.1, *SIDES, 0.15)
    figure, (axes,) = sheet(COLUMN_IN, panels, title, entries, notes(course))
    for name, look in looks.items():
        axes.plot(axis.values, 1e3 * course.motion.elastic[name].middle, **look)  # type: ignore[arg-type]  # as above
    axes.set_ylabel("deflection [mm]")
    axis.mark(axes)
    return figure
