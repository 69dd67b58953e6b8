"""Letters beside the points of a sheet."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from matplotlib.axes import Axes

from models.array import Array
from reports.drawing.lettering import Label, place
from reports.figures.style import POINTS, SMALL, width_in
from reports.sheets.canvas import text
from reports.sheets.paper import MM_PER_IN, Box


def together(at: Mapping[str, Array], within_mm: float) -> dict[str, Array]:
    """Names at their places [mm], those that stand within a distance of one another as one."""
    spots: dict[str, Array] = {}
    for name, there in at.items():
        same = [one for one, spot in spots.items() if np.hypot(*(spot - there)) < within_mm]
        if same:
            spots = {
                f"{one}, {name}" if one == same[0] else one: spot for one, spot in spots.items()
            }
        else:
            spots[name] = there
    return spots


def write_letters(
    axes: Axes, places: Mapping[str, Array], drawn: Array, box: Box, clear: tuple[float, float]
) -> None:
    """Letters beside their points, clear of what is ``drawn`` (n, 2) and of one another [mm].

    ``clear`` are radii [inch]: of what has a letter, and of what is drawn.
    """
    corner = np.array([box.left, box.bottom])
    labels = [
        Label(
            name,
            (width_in(name, SMALL), SMALL / POINTS),
            ((at - corner) / MM_PER_IN)[None],
            clear[0],
        )
        for name, at in places.items()
    ]
    heavy = np.column_stack([(drawn - corner) / MM_PER_IN, np.full(len(drawn), clear[1])])
    frame = (box.width / MM_PER_IN, box.height / MM_PER_IN)
    for label, at in zip(labels, place(labels, heavy, np.zeros((0, 2)), frame), strict=True):
        x, y = corner + MM_PER_IN * np.array(at)
        text(axes, x, y, label.text, ha="center", va="center")
