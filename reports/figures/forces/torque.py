"""The driving torque over the driver's angle, its mean, and what of it inertia, loads and friction
take."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.artist import Artist
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from models.array import Array
from models.driver_course import driver_course
from reports.describe.force_tables import flow_of
from reports.figures.forces.force_turn import SIDES, ForceTurn
from reports.figures.sheet import Panels, sheet
from reports.figures.style import COLUMN_IN, INK, QUIET
from reports.output.numbers import readable

TORQUE = {"color": "#1f5f9e", "linewidth": 1.4}
MEAN = {"color": INK, "linewidth": 0.8, "linestyle": (0, (5.0, 2.0))}
INERTIA = {"color": "#c04a1d", "linewidth": 0.8, "linestyle": (0, (1.0, 1.2))}
FRICTION = {"color": "#7a3e9d", "linewidth": 0.8, "linestyle": (0, (3.0, 1.2))}
LOADS = {"color": "#2f7d4c", "linewidth": 0.8, "linestyle": (0, (6.0, 1.5, 1.0, 1.5))}


def draw(turn: ForceTurn) -> Figure | None:
    """One panel; None without forces.

    Shares are drawn where weights or loads act, or friction: the drive holds against the reduced
    torque and friction, and the rest is inertia. Where friction locks, a turn has no mean.
    """
    if not turn.has_forces:
        return None
    drive = turn.scene.driver
    torque, held, rubbing = turn.acting.torque, -turn.reduced.torque, _of_friction(turn)
    mean = math.nan if turn.acting.has_equilibria(0).any() else mean_torque(turn)
    entries: list[tuple[Artist, str]] = [
        (Line2D([], [], **TORQUE), f"driving {drive.effort}"),  # type: ignore[arg-type]  # looks of a line
    ]
    if math.isfinite(mean):
        words = f"mean over time {readable(mean)} {drive.effort_unit}"
        entries.append((Line2D([], [], **MEAN), words))  # type: ignore[arg-type]  # as above
    is_loaded = rubbing is not None or bool(np.nanmax(np.abs(held), initial=0.0) > 0.0)
    if is_loaded:
        entries += [
            (Line2D([], [], **INERTIA), "inertia"),  # type: ignore[arg-type]  # as above
            (Line2D([], [], **LOADS), "weights and loads"),  # type: ignore[arg-type]  # as above
        ]
    if rubbing is not None:
        entries.append((Line2D([], [], **FRICTION), "friction"))  # type: ignore[arg-type]  # as above
    panels = Panels(1, 1, 2.1, *SIDES, 0.15)
    title = f"Driving {drive.effort}: {turn.scene.name}"
    figure, (axes,) = sheet(COLUMN_IN, panels, title, entries, turn.notes)
    axes.axhline(0.0, color=QUIET, linewidth=0.5)
    if rubbing is not None:
        turn.plot(axes, rubbing, **FRICTION)
    if is_loaded:
        turn.plot(axes, torque - held - (0.0 if rubbing is None else rubbing), **INERTIA)
        turn.plot(axes, held, **LOADS)
    turn.plot(axes, torque, **TORQUE)
    if math.isfinite(mean):
        axes.axhline(mean, **MEAN)  # type: ignore[arg-type]  # as above
    turn.mark_axis(axes)
    axes.set_xlabel(turn.label)
    axes.set_ylabel(f"{drive.effort} on {drive.joint} [{drive.effort_unit}]")
    return figure


def _of_friction(turn: ForceTurn) -> Array | None:
    """What of the torque overcomes friction; None without friction."""
    flow = flow_of(turn.scene, turn.motion, turn.acting)
    if flow is None:
        return None
    omega = driver_course(turn.scene, turn.motion)[1]
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(flow.lost / omega)


def mean_torque(turn: ForceTurn) -> float:
    """Over the turn, by time; what is nothing but rounding is 0."""
    torque = turn.acting.torque[:-1]  # the last instant is the first again
    mean = float(np.nanmean(torque))
    return mean if abs(mean) > 1e-9 * float(np.nanmax(np.abs(torque))) else 0.0
