"""The machine reduced to its driver, over the driver's angle: moment of inertia, and the torque of
weights and loads."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from models.array import Array
from reports.figures.forces.force_turn import SIDES, ForceTurn
from reports.figures.sheet import Panels, sheet
from reports.figures.style import COLUMN_IN, QUIET


def draw(turn: ForceTurn) -> Figure:
    """The reduced moment of inertia, and below it the reduced torque where weights or loads act."""
    reduced, notes, drive = turn.reduced, turn.notes, turn.scene.driver
    mass = "moment of inertia [kg m²]" if drive.slider is None else "mass [kg]"
    panels: list[tuple[str, Array]] = [(mass, reduced.inertia)]
    if np.nanmax(np.abs(reduced.torque), initial=0.0) > 0.0:
        panels.append((f"{drive.effort} [{drive.effort_unit}]", reduced.torque))
    else:
        notes = [f"No weight or load acts, so the reduced {drive.effort} is 0.", *notes]
    shape = Panels(len(panels), 1, 1.6 if len(panels) > 1 else 2.1, *SIDES, 0.15, between=(0, 0.22))
    title = f"Reduced to {drive.joint}: {turn.scene.name}"
    figure, axes = sheet(COLUMN_IN, shape, title, [], notes)
    for one, (label, series) in zip(axes, panels, strict=True):
        turn.plot(one, series, color="#1f5f9e", linewidth=1.2)
        turn.mark_axis(one)
        one.set_ylabel(label)
        one.tick_params(labelbottom=one is axes[-1])
    axes[0].set_ylim(bottom=0.0)
    if len(axes) > 1:
        axes[1].axhline(0.0, color=QUIET, linewidth=0.5)
    axes[-1].set_xlabel(turn.label)
    return figure
