"""By how much the pins of each elastic link are further apart than at rest: it stretches, and what
bends is shorter."""

from __future__ import annotations

from matplotlib.artist import Artist
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from reports.describe.elastic_course import ElasticCourse
from reports.figures.elastic.course_axis import COLOURS, DASHES, SIDES, CourseAxis, notes
from reports.figures.sheet import Panels, sheet
from reports.figures.style import COLUMN_IN

SEEN = 1e-12
"""An extension, over the longest link, below which there is none."""


def draw(course: ElasticCourse) -> Figure | None:
    """One panel; None where no link is longer or shorter than at rest."""
    shapes = course.motion.elastic
    largest = max(float(abs(shape.extension).max()) for shape in shapes.values())
    if largest <= SEEN * course.scene.longest_m:
        return None
    looks = {
        name: {"color": COLOURS[k % len(COLOURS)], "linestyle": DASHES[k % len(DASHES)]}
        for k, name in enumerate(shapes)
    }
    entries: list[tuple[Artist, str]] = [
        (Line2D([], [], **look), f"end of {name}, along it")  # type: ignore[arg-type]  # looks of a line
        for name, look in looks.items()
    ]
    axis = CourseAxis.of(course)
    title = f"Axial displacement of the end: {course.scene.name}"
    panels = Panels(1, 1, 2.1, *SIDES, 0.15)
    figure, (axes,) = sheet(COLUMN_IN, panels, title, entries, notes(course))
    for name, look in looks.items():
        axes.plot(axis.values, 1e6 * shapes[name].extension, **look)  # type: ignore[arg-type]  # as above
    axes.set_ylabel("extension [µm]")
    axis.mark(axes)
    return figure
