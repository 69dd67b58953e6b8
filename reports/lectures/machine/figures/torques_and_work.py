"""Torques reduced to the driver over a cycle, by whether they drive, and the work since its
start."""

from __future__ import annotations

import numpy as np
from matplotlib.artist import Artist
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from reports.figures.sheet import Panels, sheet
from reports.figures.style import COLUMN_IN, INK, QUIET
from reports.lectures.machine.figures.regulated import CURVE, OTHER, RETURNING, SIDES, Regulated
from reports.output.numbers import readable

WORK = {"color": INK, "linewidth": 1.2}


def draw(of: Regulated) -> Figure:
    """Torques above, work below with its surplus."""
    series, cycle = of.series, of.cycle
    curves = [
        (series.driving, CURVE, "driving torque"),
        (-series.resisting, OTHER, "resisting torque"),
        (series.returning, RETURNING, "of weights and springs"),
    ]
    curves = [each for each in curves if np.any(np.abs(each[0]) > 0.0)]
    entries: list[tuple[Artist, str]] = [
        (Line2D([], [], **look), words)  # type: ignore[arg-type]  # looks of a line
        for _, look, words in curves
    ]
    words = f"work since the start, surplus {readable(cycle.surplus_j, 4)} J"
    entries.append((Line2D([], [], **WORK), words))  # type: ignore[arg-type]  # as above
    shape = Panels(2, 1, 1.5, *SIDES, 0.15, between=(0, 0.2))
    title = f"Torques and work: {cycle.machine.scene.name}"
    figure, (upper, lower) = sheet(COLUMN_IN, shape, title, entries, of.notes)
    for curve, look, _ in curves:
        of.plot(upper, curve, **look)
    of.plot(lower, series.work, **WORK)
    for one, label in ((upper, "torque [N m]"), (lower, "work [J]")):
        one.axhline(0.0, color=QUIET, linewidth=0.5)
        of.mark_axis(one)
        one.set_ylabel(label)
    upper.tick_params(labelbottom=False)
    lower.set_xlabel(of.label)
    return figure
