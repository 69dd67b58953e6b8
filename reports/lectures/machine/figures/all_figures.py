"""The figures of regulation by name. To add one, add a file and a line here."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from pathlib import Path

from matplotlib.figure import Figure

from reports.figures.saving import FORMATS, saved
from reports.figures.style import styled
from reports.lectures.machine.figures import energy_mass, speed_fluctuation, torques_and_work
from reports.lectures.machine.figures.regulated import Regulated
from reports.output.numbers import count
from reports.output.write import write

REGULATION_FIGURES: Mapping[str, Callable[[Regulated], Figure | None]] = {
    "speed": speed_fluctuation.draw,
    "torques": torques_and_work.draw,
    "energy-mass": energy_mass.draw,
}
"""Each gives None where there is nothing to draw: a machine of constant moment of inertia has no
energy-mass diagram."""


def figure_files() -> list[str]:
    """The names of all files that may be written."""
    return [f"{name}.{kind}" for name in REGULATION_FIGURES for kind in FORMATS]


def drawn_figures(of: Regulated) -> Iterator[tuple[str, Figure]]:
    """Each figure by its name, without those that have nothing to draw."""
    for name, draw in REGULATION_FIGURES.items():
        with styled():
            figure = draw(of)
        if figure is not None:
            yield name, figure


def written_figures(of: Regulated, folder: Path) -> str:
    """Write all figures; returns what was written, in a line. Raises CrankcheckError where the
    system refuses."""
    names, title = [], of.cycle.machine.scene.name
    for name, figure in drawn_figures(of):
        names.append(name)
        for kind in FORMATS:
            write(folder / f"{name}.{kind}", saved(figure, kind, f"{title}: {name}"))
    kinds = " and ".join(f".{kind}" for kind in FORMATS)
    return f"{folder}: {count(len(names), 'figure')}, each as {kinds}: {', '.join(names)}"
