"""The figures of a motion with elastic links as files of a folder."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from matplotlib.figure import Figure

from reports.describe.elastic_course import ElasticCourse
from reports.figures.elastic.course_figures import COURSE_FIGURES
from reports.figures.saving import FORMATS, saved
from reports.figures.style import styled
from reports.output.numbers import count
from reports.output.write import write


def drawn_elastic_figures(course: ElasticCourse) -> Iterator[tuple[str, Figure]]:
    """Each figure by its name, without those that have nothing to draw."""
    for name, draw in COURSE_FIGURES.items():
        with styled():
            figure = draw(course)
        if figure is not None:
            yield name, figure


def written_elastic_figures(course: ElasticCourse, folder: Path) -> str:
    """Write all figures; returns what was written, in a line. Raises CrankcheckError where the
    system refuses."""
    names = []
    for name, figure in drawn_elastic_figures(course):
        names.append(name)
        for kind in FORMATS:
            write(folder / f"{name}.{kind}", saved(figure, kind, f"{course.scene.name}: {name}"))
    kinds = " and ".join(f".{kind}" for kind in FORMATS)
    figures = count(len(names), "figure")
    return f"{folder}: {figures} of elastic links, each as {kinds}: {', '.join(names)}"
