"""Sets of figures of what is solved: as files of a folder, and what stands under each figure."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Generic, Protocol, TypeVar

import numpy as np
from matplotlib.figure import Figure

from models.scene import Scene
from reports.describe.facts import describe_law
from reports.figures.saving import FORMATS, saved
from reports.figures.style import styled
from reports.output.numbers import count
from reports.output.provenance import crankcheck_version
from reports.output.write import write


class Solved(Protocol):
    """What such figures are drawn of."""

    @property
    def scene(self) -> Scene: ...


Of = TypeVar("Of", bound=Solved)


@dataclass(frozen=True)
class FigureSet(Generic[Of]):
    """Figures by name, which is that of their file, and ``of`` what they are in words. Each gives
    None where there is nothing to draw. To add one, add a function and its line."""

    of: str
    draws: Mapping[str, Callable[[Of], Figure | None]]

    @property
    def files(self) -> list[str]:
        """The names of all files that may be written."""
        return [f"{name}.{kind}" for name in self.draws for kind in FORMATS]

    def pictures(self, solved: Of) -> dict[str, bytes]:
        """The figures as SVG files by name."""
        return {name: self._saved(solved, name, each) for name, each in self._drawn(solved)}

    def written(self, solved: Of, folder: Path) -> str:
        """Write all figures; returns what was written, in a line. Raises CrankcheckError where the
        system refuses."""
        names = []
        for name, figure in self._drawn(solved):
            names.append(name)
            for kind in FORMATS:
                write(folder / f"{name}.{kind}", self._saved(solved, name, figure, kind))
        kinds = " and ".join(f".{kind}" for kind in FORMATS)
        figures = count(len(names), "figure")
        return f"{folder}: {figures} of {self.of}, each as {kinds}: {', '.join(names)}"

    def _drawn(self, solved: Of) -> Iterator[tuple[str, Figure]]:
        for name, draw in self.draws.items():
            with styled():
                figure = draw(solved)
            if figure is not None:
                yield name, figure

    @staticmethod
    def _saved(solved: Of, name: str, figure: Figure, kind: str = "svg") -> bytes:
        return saved(figure, kind, f"{solved.scene.name}: {name}")


def note(scene: Scene, how: str, driver: str, *more: str) -> str:
    """What stands under a figure: how it was solved, the law of the driver, and the loads."""
    gravity = float(np.hypot(*scene.gravity_m_s2))
    parts = [
        f"crankcheck {crankcheck_version()}, {how}",
        f"{driver} {describe_law(scene)}",
        f"gravity {gravity:g} m/s²" if gravity else "no gravity",
        *more,
    ]
    return f"{'; '.join(parts)}."


def loads_told(scene: Scene) -> str:
    """The loads of a scene by name."""
    return f"loads: {', '.join(scene.loads)}" if scene.loads else "no loads"
