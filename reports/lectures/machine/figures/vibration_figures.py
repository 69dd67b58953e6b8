"""What figures of vibration share: how they are written, and what stands under them."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from models.scene import Scene
from reports.figures.saving import FORMATS, saved
from reports.figures.style import styled
from reports.output.provenance import crankcheck_version
from reports.output.write import write

COLOURS = ("#1f5f9e", "#c04a1d", "#2f7d4c", "#7a4d9e")
"""Of the links, one after the other."""
SIDES = (0.58, 0.1)
"""Room on the left and on the right of a panel [inch]."""
ORDERS = 24
"""Orders that are drawn."""
SMALLEST = 1e-7
"""Amplitudes over the length that are still drawn."""


@dataclass(frozen=True)
class Drawing:
    """A figure by its name, and what draws it."""

    name: str
    draw: Callable[[], Figure]


def write_figures(folder: Path, drawings: Iterable[Drawing], title: str) -> list[str]:
    """Write figures in all formats; returns the names of the files. Raises CrankcheckError where
    the system refuses."""
    names = []
    for each in drawings:
        with styled():
            figure = each.draw()
        for kind in FORMATS:
            names.append(f"{each.name}.{kind}")
            write(folder / names[-1], saved(figure, kind, f"{title}: {each.name}"))
    return names


def notes(scene: Scene, said: str) -> list[str]:
    """What stands under a figure."""
    links = ", ".join(scene.elastic)
    return [f"crankcheck {crankcheck_version()}; elastic: {links}; {said}."]


def whole_orders(axes: Axes, which: str, highest: int) -> None:
    """Ticks at whole orders."""
    axis = axes.xaxis if which == "x" else axes.yaxis
    axis.set_major_locator(MaxNLocator(nbins=min(12, highest), integer=True))
