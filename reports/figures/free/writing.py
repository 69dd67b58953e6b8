"""The figures of a free motion as files of a folder."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from matplotlib.figure import Figure

from analytic.free.free_motion import FreeMotion
from reports.figures.free.all_figures import FREE_FIGURES
from reports.figures.free.free_course import free_course
from reports.figures.saving import FORMATS, saved
from reports.figures.style import styled
from reports.output.numbers import count
from reports.output.write import write


def free_figure_files() -> list[str]:
    """The names of all files that are written."""
    return [f"{name}.{kind}" for name in FREE_FIGURES for kind in FORMATS]


def drawn_free_figures(free: FreeMotion) -> Iterator[tuple[str, Figure]]:
    """Each figure by its name."""
    course = free_course(free)
    for name, draw in FREE_FIGURES.items():
        with styled():
            figure = draw(course)
        yield name, figure


def written_free_figures(free: FreeMotion, folder: Path) -> str:
    """Write all figures; returns what was written, in a line. Raises CrankcheckError where the
    system refuses."""
    for name, figure in drawn_free_figures(free):
        for kind in FORMATS:
            write(folder / f"{name}.{kind}", saved(figure, kind, f"{free.scene.name}: {name}"))
    kinds = " and ".join(f".{kind}" for kind in FORMATS)
    figures = count(len(FREE_FIGURES), "figure")
    return f"{folder}: {figures} of a free motion, each as {kinds}: {', '.join(FREE_FIGURES)}"
