"""The figures of the forces of a turn, most of them over the driver's angle."""

import math
from collections.abc import Sequence

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from models.array import Array
from models.scene.driver import driver_course
from reports.describe.force_tables import cycle_of, cycle_words, flow_of
from reports.describe.free_motion import acted_on
from reports.drawing.shape import colours_of
from reports.figures.drawing import DASHES
from reports.figures.force_turn import ForceTurn, hodographs, loaded
from reports.figures.sheet import Curve, LinePanel, line_figure
from reports.figures.style import FRONT, INK, QUIET, FigureSet, Look
from reports.output.numbers import readable

TORQUE: Look = {"color": "#1f5f9e", "linewidth": 1.4}
MEAN: Look = {"color": INK, "linewidth": 0.8, "linestyle": (0, (5.0, 2.0))}
INERTIA: Look = {"color": "#c04a1d", "linewidth": 0.8, "linestyle": (0, (1.0, 1.2))}
FRICTION: Look = {"color": "#7a3e9d", "linewidth": 0.8, "linestyle": (0, (3.0, 1.2))}
LOADS: Look = {"color": "#2f7d4c", "linewidth": 0.8, "linestyle": (0, (6.0, 1.5, 1.0, 1.5))}
CURVE: Look = {"color": "#1f5f9e", "linewidth": 1.2}
LOCKED: Look = {"color": FRONT, "linewidth": 0.0}
JAMS: Look = {"facecolor": "none", "edgecolor": FRONT, "hatch": "////", "linewidth": 0.0}


def _torque(turn: ForceTurn) -> Figure | None:
    """Draw the driving torque, its mean, and its shares for inertia, loads and friction; None
    without forces.

    Shares are drawn where weights or loads act, or friction: the drive balances the reduced torque
    and friction, and the rest is inertia. A turn has no mean where friction locks.
    """
    if not turn.has_forces:
        return None
    drive = turn.scene.driver
    torque, held, rubbing = turn.acting.torque, -turn.reduced.torque, _of_friction(turn)
    mean = math.nan if turn.acting.has_equilibria(0).any() else mean_torque(turn)
    entries = [(Line2D([], [], **TORQUE), f"driving {drive.effort}")]
    if math.isfinite(mean):
        words = f"mean over time {readable(mean)} {drive.effort_unit}"
        entries.append((Line2D([], [], **MEAN), words))
    is_loaded = rubbing is not None or bool(np.nanmax(np.abs(held), initial=0.0) > 0.0)
    if is_loaded:
        entries.append((Line2D([], [], **INERTIA), "inertia"))
        entries.append((Line2D([], [], **LOADS), "weights and loads"))
    if rubbing is not None:
        entries.append((Line2D([], [], **FRICTION), "friction"))
    label = f"{drive.effort} on {drive.joint} [{drive.effort_unit}]"
    title, panel = f"Driving {drive.effort}", LinePanel(label, [])
    figure, (axes,) = line_figure(turn, title, [panel], turn.notes, entries)
    axes.axhline(0.0, color=QUIET, linewidth=0.5)
    if rubbing is not None:
        turn.plot(axes, rubbing, **FRICTION)
    if is_loaded:
        turn.plot(axes, torque - held - (0.0 if rubbing is None else rubbing), **INERTIA)
        turn.plot(axes, held, **LOADS)
    turn.plot(axes, torque, **TORQUE)
    if math.isfinite(mean):
        axes.axhline(mean, **MEAN)
    return figure


def _of_friction(turn: ForceTurn) -> Array | None:
    """Return the part of the torque that overcomes friction; None without friction."""
    flow = flow_of(turn.scene, turn.motion, turn.acting)
    if flow is None:
        return None
    omega = driver_course(turn.scene, turn.motion)[1]
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(flow.lost / omega)


def mean_torque(turn: ForceTurn) -> float:
    """Return the mean over the turn, by time; 0 where it is rounding alone."""
    torque = turn.acting.torque[:-1]  # the last instant is the first again
    mean = float(np.nanmean(torque))
    return mean if abs(mean) > 1e-9 * float(np.nanmax(np.abs(torque))) else 0.0


def _reactions(turn: ForceTurn) -> Figure | None:
    """Draw the sizes of the reactions: lengths of pin forces and signed normal forces of guides in
    one panel, moments of guides in one below where there are any; None without reactions."""
    if not turn.has_forces:
        return None
    colours, guides = colours_of(turn.scene), turn.acting.sliders
    forces = [
        (f"{point} on {body}", np.hypot(*force.T), colours.get(body, INK))
        for point, body, _, force in acted_on(turn.acting)
    ]
    forces += [(f"slider {name}, normal (signed)", one.normal, INK) for name, one in guides.items()]
    moments = [
        (f"slider {name}, moment", one.moment, INK)
        for name, one in guides.items()
        if np.nanmax(np.abs(one.moment), initial=0.0) > 0.0
    ]
    if not forces:
        return None
    panels = [LinePanel("force [N]", _dashed(forces))]
    panels += [LinePanel("moment [N m]", _dashed(moments))] * bool(moments)
    return _stacked(turn, "Reactions", panels, turn.notes, top=0.2)[0]


def _dashed(rows: Sequence[tuple[str, Array, str]]) -> list[Curve]:
    """Return curves in their colours, with dashes of their own: bodies share colours."""
    dashes = [DASHES[k % len(DASHES)] for k in range(len(rows))]
    return [
        (name, series, {"color": colour, "linestyle": (0, dash) if dash else "-"})
        for (name, series, colour), dash in zip(rows, dashes, strict=True)
    ]


def _stacked(
    turn: ForceTurn, title: str, panels: Sequence[LinePanel], notes: Sequence[str], top: float
) -> tuple[Figure, list[Axes]]:
    height = 2.1 if len(panels) == 1 else 1.6
    return line_figure(turn, title, panels, notes, height=height, top=top, down=0.22)


def _efficiency(turn: ForceTurn) -> Figure | None:
    """Draw the instantaneous efficiency, from 0 to 1, the efficiency of the cycle, and where it
    locks; None without friction, or where the loads drive all the time."""
    assert turn.motion.forces is not None
    flow = flow_of(turn.scene, turn.motion, turn.motion.forces)
    if flow is None or not np.isfinite(flow.efficiency).any():
        return None
    cycle = cycle_of(turn.scene)
    entries: list[tuple[Artist, str]] = [(Line2D([], [], **CURVE), "at an instant")]
    over = math.nan if cycle is None else cycle.cycle
    if math.isfinite(over):
        entries.append((Line2D([], [], **MEAN), f"over a cycle {readable(over)}"))
    bands = []
    for number, words, look in ((0, "locks itself", LOCKED), (2, "may jam", JAMS)):
        if (samples := turn.acting.has_equilibria(number)).any():
            bands.append((samples, look))
            entries.append((Patch(**look), words))
    notes = [*cycle_words(turn.scene, cycle), "No curve where no power goes on.", *turn.notes]
    panel = LinePanel("efficiency", [])
    figure, (axes,) = line_figure(turn, "Efficiency", [panel], notes, entries)
    for samples, look in bands:
        axes.fill_between(turn.x, 0.0, 1.05, where=samples[turn.order], **look)
    if math.isfinite(over):
        axes.axhline(over, **MEAN)
    turn.plot(axes, flow.efficiency, **CURVE)
    axes.set_ylim(0.0, 1.05)
    return figure


def _reduced(turn: ForceTurn) -> Figure:
    """Draw the machine reduced to its driver: inertia, and torque if weights or loads act."""
    reduced, notes, drive = turn.reduced, turn.notes, turn.scene.driver
    mass = "moment of inertia [kg m²]" if drive.slider is None else "mass [kg]"
    panels = [LinePanel(mass, [("", reduced.inertia, CURVE)])]
    if np.nanmax(np.abs(reduced.torque), initial=0.0) > 0.0:
        effort = f"{drive.effort} [{drive.effort_unit}]"
        panels.append(LinePanel(effort, [("", reduced.torque, CURVE)]))
    else:
        notes = [f"No weight or load acts, so the reduced {drive.effort} is 0.", *notes]
    figure, axes = _stacked(turn, f"Reduced to {drive.joint}", panels, notes, top=0.15)
    axes[0].set_ylim(bottom=0.0)
    if len(axes) > 1:
        axes[1].axhline(0.0, color=QUIET, linewidth=0.5)
    return figure


FORCE_FIGURES: FigureSet[ForceTurn] = FigureSet(
    "a turn",
    {
        "torque": _torque,
        "reactions": _reactions,
        "efficiency": _efficiency,
        "reduced": _reduced,
        "forces": loaded,
        "reactions-polar": hodographs,
    },
)
"""Figures of forces: there are no reactions with redundant links, no efficiency without friction,
and no forces where friction locks nearly all of a turn."""
