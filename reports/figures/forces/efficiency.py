"""The instantaneous efficiency over the driver's angle, that of the cycle, and where it locks."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.artist import Artist
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from reports.describe.force_tables import cycle_of, cycle_words, flow_of
from reports.figures.forces.force_turn import SIDES, ForceTurn
from reports.figures.sheet import Panels, sheet
from reports.figures.style import COLUMN_IN, FRONT, INK
from reports.output.numbers import readable

CURVE = {"color": "#1f5f9e", "linewidth": 1.2}
CYCLE = {"color": INK, "linewidth": 0.8, "linestyle": (0, (5.0, 2.0))}
LOCKED = {"color": FRONT, "linewidth": 0.0}
JAMS = {"facecolor": "none", "edgecolor": FRONT, "hatch": "////", "linewidth": 0.0}


def draw(turn: ForceTurn) -> Figure | None:
    """One panel, from 0 to 1; None without friction, or where the loads drive all the time."""
    assert turn.motion.forces is not None
    flow = flow_of(turn.scene, turn.motion, turn.motion.forces)
    if flow is None or not np.isfinite(flow.efficiency).any():
        return None
    cycle = cycle_of(turn.scene)
    entries: list[tuple[Artist, str]] = [(Line2D([], [], **CURVE), "at an instant")]  # type: ignore[arg-type]  # looks of a line
    over = math.nan if cycle is None else cycle.cycle
    if math.isfinite(over):
        entries.append((Line2D([], [], **CYCLE), f"over a cycle {readable(over)}"))  # type: ignore[arg-type]  # as above
    bands = []
    for number, words, look in ((0, "locks itself", LOCKED), (2, "may jam", JAMS)):
        if (samples := turn.acting.has_equilibria(number)).any():
            bands.append((samples, look))
            entries.append((Patch(**look), words))  # type: ignore[arg-type]  # as above
    notes = [*cycle_words(turn.scene, cycle), "No curve where no power goes on.", *turn.notes]
    title = f"Efficiency: {turn.scene.name}"
    figure, (axes,) = sheet(COLUMN_IN, Panels(1, 1, 2.1, *SIDES, 0.15), title, entries, notes)
    for samples, look in bands:
        axes.fill_between(turn.x, 0.0, 1.05, where=samples[turn.order], **look)  # type: ignore[arg-type]  # as above
    if math.isfinite(over):
        axes.axhline(over, **CYCLE)  # type: ignore[arg-type]  # as above
    turn.plot(axes, flow.efficiency, **CURVE)
    turn.mark_axis(axes)
    axes.set_ylim(0.0, 1.05)
    axes.set_xlabel(turn.label)
    axes.set_ylabel("efficiency")
    return figure
