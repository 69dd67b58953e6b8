"""The speed of the driver over a cycle, with the flywheel and without, and its extremes."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.artist import Artist
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from reports.figures.sheet import Panels, sheet
from reports.figures.style import COLUMN_IN, INK
from reports.lectures.machine.figures.regulated import CURVE, OTHER, SIDES, Regulated
from reports.output.numbers import readable

MEAN = {"color": INK, "linewidth": 0.7, "linestyle": (0, (5.0, 2.0))}
EXTREME = {"color": "#1f5f9e", "marker": "o", "markersize": 3.2, "linestyle": "none"}
APART = 6.0
"""Fluctuations that differ by more than this have no room in one panel."""


def draw(of: Regulated) -> Figure:
    """One panel; a second one, closer, where the flywheel takes nearly all of the fluctuation."""
    cycle, bare = of.cycle, of.bare
    with_it = "with the flywheel" if of.wanted is not None else "speed"
    entries: list[tuple[Artist, str]] = [
        (Line2D([], [], **CURVE), f"{with_it}, delta = {readable(cycle.delta)}"),  # type: ignore[arg-type]  # looks of a line
        (Line2D([], [], **MEAN), f"mean {readable(cycle.mean_rad_s, 5)} rad/s"),  # type: ignore[arg-type]  # as above
        (Line2D([], [], **EXTREME), _extremes(of)),  # type: ignore[arg-type]  # as above
    ]
    if bare is not None:
        entries.append((Line2D([], [], **OTHER), f"without, delta = {readable(bare.delta)}"))  # type: ignore[arg-type]  # as above
    notes = list(of.notes)
    if of.wanted is not None and bare is None:
        notes.append("Without the flywheel there is no steady cycle at this speed.")
    rows = 2 if bare is not None and bare.delta > APART * cycle.delta else 1
    shape = Panels(rows, 1, 2.1 if rows == 1 else 1.5, *SIDES, 0.15, between=(0, 0.2))
    title = f"Speed over a cycle: {cycle.machine.scene.name}"
    figure, axes = sheet(COLUMN_IN, shape, title, entries, notes)
    for k, one in enumerate(axes):
        if bare is not None and (rows == 1 or k == 0):
            of.plot(one, bare.solution.speed_at(of.series.turned), **OTHER)
        of.plot(one, of.series.speed, **CURVE)
        one.axhline(cycle.mean_rad_s, **MEAN)  # type: ignore[arg-type]  # as above
        at = np.array([cycle.fastest, cycle.slowest])
        if k == len(axes) - 1:
            one.plot(np.degrees(cycle.machine.theta(at)), cycle.extreme_speeds_rad_s, **EXTREME)  # type: ignore[arg-type]  # as above
        of.mark_axis(one)
        one.tick_params(labelbottom=k == len(axes) - 1)
        one.set_ylabel(f"{cycle.machine.scene.driver.link} [rad/s]")
    axes[-1].set_xlabel(of.label)
    return figure


def _extremes(of: Regulated) -> str:
    """Where the speed is extreme."""
    high, low = (math.degrees(of.cycle.driver_rad(u)) for u in (of.cycle.fastest, of.cycle.slowest))
    return f"extreme at {readable(high, 4)} and {readable(low, 4)} deg"
