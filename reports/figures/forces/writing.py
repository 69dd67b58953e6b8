"""The figures of a scene's forces as files of a folder."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from matplotlib.figure import Figure

from models.scene import Scene
from reports.figures.forces.all_figures import FORCE_FIGURES
from reports.figures.forces.force_turn import force_turn
from reports.figures.saving import FORMATS, saved
from reports.figures.style import styled
from reports.output.numbers import count
from reports.output.write import write


def figure_files() -> list[str]:
    """The names of all files that may be written."""
    return [f"{name}.{kind}" for name in FORCE_FIGURES for kind in FORMATS]


def drawn_figures(scene: Scene) -> Iterator[tuple[str, Figure]]:
    """Each figure by its name, without those that have nothing to draw. Raises CrankcheckError as
    `force_turn`."""
    turn = force_turn(scene)
    for name, draw in FORCE_FIGURES.items():
        with styled():
            figure = draw(turn)
        if figure is not None:
            yield name, figure


def written_figures(scene: Scene, folder: Path) -> str:
    """Write all figures; returns what was written, in a line. Raises CrankcheckError as
    `force_turn`, and where the system refuses."""
    names = []
    for name, figure in drawn_figures(scene):
        names.append(name)
        for kind in FORMATS:
            write(folder / f"{name}.{kind}", saved(figure, kind, f"{scene.name}: {name}"))
    kinds = " and ".join(f".{kind}" for kind in FORMATS)
    return f"{folder}: {count(len(names), 'figure')} of a turn, each as {kinds}: {', '.join(names)}"
