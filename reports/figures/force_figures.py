"""Figures of a turn under forces: over the driver's angle, and as vectors of pins and joints."""

import math
from collections.abc import Sequence

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import MaxNLocator

from models.array import Array
from models.motion import Forces
from models.scene.driver import driver_course, driver_shown, driver_stands
from reports.describe import free_motion
from reports.describe.force_tables import cycle_of, cycle_words, flow_of
from reports.drawing.force_arrows import force_arrows
from reports.drawing.moving import goes_round
from reports.drawing.shape import PATH_SAMPLES, Label, colours_of, place, turn_of
from reports.figures import style
from reports.figures.drawing import DASHES
from reports.figures.force_turn import ForceTurn
from reports.figures.layout import LAYOUT
from reports.figures.mechanism import mechanism_at
from reports.figures.sheet import (
    NUMBER_IN,
    Abscissa,
    Curve,
    LinePanel,
    Panels,
    columns_of,
    line_figure,
    sheet,
)
from reports.figures.style import FRONT, INK, TINY, FigureSet, Look
from reports.output.numbers import readable

COLUMNS = 3
EVERY_DEG, NAMED_DEG = 30, 90
"""Angles of the driver with a dot, and angles with their number beside it."""
ROOM = 0.12
"""Room around a curve, over its size."""


def hodographs(turn: ForceTurn) -> Figure | None:
    """Draw polar diagrams, the way of the tip of each pin's reaction over a turn, drawn from one
    point, a panel per pin, all on one scale; None where there are no reactions."""
    pins = list(free_motion.acted_on(turn.acting))
    if not (pins and turn.has_forces):
        return None
    columns = 2 if len(pins) == 4 else columns_of(len(pins), COLUMNS)
    rows = math.ceil(len(pins) / columns)
    left, right, across = 0.5, 0.1, 0.55
    page, most = LAYOUT.get().across(style.PAGE_IN), columns if LAYOUT.get().width_mm else COLUMNS
    side = (page - left - right - across * (most - 1)) / most
    width = left + right + side * columns + across * (columns - 1)
    panels = Panels(rows, columns, side, left, right, 0.2, 0.36, (across, 0.52))
    title = f"Reactions of the pins: {turn.scene.name}"
    entries = [(Line2D([], [], color=INK, marker="+", linestyle="none"), "no force")]
    if _dots(turn):
        dot = Line2D([], [], color=INK, marker="o", markersize=3.0, linestyle="none")
        words = f"every {EVERY_DEG} deg of {turn.scene.driver.joint}, numbers in deg"
        entries.append((dot, words))
    figure, axes = sheet(width, panels, title, entries, turn.notes)
    colours = colours_of(turn.scene)
    boxes = [_box(force) for *_, force in pins]
    size = max(float(np.max(high - low)) for low, high in boxes) or 1.0
    for (point, body, source, force), box, one in zip(pins, boxes, axes, strict=False):
        words = f"{point}, of {source} on {body}" if source != "pin" else f"{point} on {body}"
        one.set_title(style.cut(words, side))
        low = (box[0] + box[1]) / 2 - size * (0.5 + ROOM)
        _panel(one, turn, force, colours.get(body, INK), low, size * (1.0 + 2 * ROOM), side)
    for one in axes[len(pins) :]:
        one.remove()
    return figure


def _box(force: Array) -> tuple[Array, Array]:
    """The corners of a reaction (T, 2) and of no force."""
    every = np.vstack([force[np.isfinite(force).all(axis=1)], [[0.0, 0.0]]])
    return every.min(axis=0), every.max(axis=0)


def _panel(
    axes: Axes, turn: ForceTurn, force: Array, colour: str, low: Array, size: float, side: float
) -> None:
    """Draw the diagram of one reaction, (T, 2), from a corner ``low`` (2,) on, ``size`` wide and
    high [N], in a square of ``side`` [inch]."""
    axes.set(xlim=(low[0], low[0] + size), ylim=(low[1], low[1] + size))
    axes.set_aspect("equal", adjustable="box")
    axes.plot(*force.T, color=colour)
    axes.plot(0.0, 0.0, marker="+", color=INK, markersize=6.0, zorder=4)
    axes.xaxis.set_major_locator(MaxNLocator(min(5, int(side / NUMBER_IN))))
    axes.yaxis.set_major_locator(MaxNLocator(5))
    axes.set_xlabel("x [N]")
    axes.set_ylabel("y [N]")
    dots = _dots(turn)
    if dots:
        axes.plot(*force[list(dots)].T, "o", color=colour, markersize=2.4, zorder=3)
    _numbers(axes, dots, force, low, side / size, side)


def _numbers(
    axes: Axes, dots: dict[int, int], force: Array, low: Array, per_n: float, side: float
) -> None:
    """Draw the driver's angle beside some dots, clear of the curve and of one another."""
    there = np.asarray(np.isfinite(force).all(axis=1))
    curve, height = (force[there] - low) * per_n, 0.8 * TINY / style.POINTS
    named = {str(deg): k for k, deg in dots.items() if deg % NAMED_DEG == 0 and there[k]}
    labels = [
        Label(text, (style.width_in(text, TINY), height), (force[[k]] - low) * per_n, 0.02)
        for text, k in named.items()
    ]
    if not labels:
        return
    heavy = np.column_stack([curve, np.full(len(curve), 0.008)])
    cross = np.append(-low * per_n, 0.05)
    centres = place(labels, np.vstack([heavy, cross]), curve[:0], (side, side))
    for label, (x, y) in zip(labels, centres, strict=True):
        right, up = (float(each) for each in low + np.array([x, y]) / per_n)
        look: Look = {"size": TINY, "color": style.QUIET, "ha": "center", "va": "center"}
        axes.text(right, up, label.text, zorder=5, **look)


def _dots(turn: ForceTurn) -> dict[int, int]:
    """Return the samples with the driver at a multiple of `EVERY_DEG`, with that angle [deg]; none
    of a driver that swings or slides."""
    if not goes_round(turn.scene):
        return {}
    degrees = driver_shown(turn.scene, turn.motion)
    found = {}
    for deg in range(0, 360, EVERY_DEG):
        off = np.abs((degrees - deg + 180.0) % 360.0 - 180.0)
        found[int(np.argmin(off))] = deg
    return found


def loaded(turn: ForceTurn) -> Figure | None:
    """Draw the mechanism with its largest reactions as arrows to one scale; None without these."""
    if not turn.has_forces or not (turn.acting.pins or turn.acting.sliders):
        return None
    scene = turn.scene
    path = turn_of(scene, PATH_SAMPLES, with_forces=True)
    arrows = force_arrows(scene, path)
    at = arrows.largest_at(path)
    assert path.forces is not None
    drive, torque = scene.driver, readable(float(path.forces.torque[at]))
    title = f"{scene.name}, {driver_stands(scene, path, at)}"
    words = (
        f"At the largest reactions; driving {drive.effort} {torque} {drive.effort_unit}. An arrow "
        "is the force on the body of its colour, a black one that on a block."
    )
    return mechanism_at(scene, path, at, arrows.box(path), title, [words, *turn.notes], arrows)


TORQUE: Look = {"color": "#1f5f9e", "linewidth": 1.4}
MEAN: Look = {"color": INK, "linewidth": 0.8, "linestyle": (0, (5.0, 2.0))}
INERTIA: Look = {"color": "#c04a1d", "linewidth": 0.8, "linestyle": (0, (1.0, 1.2))}
FRICTION: Look = {"color": "#7a3e9d", "linewidth": 0.8, "linestyle": (0, (3.0, 1.2))}
LOADS: Look = {"color": "#2f7d4c", "linewidth": 0.8, "linestyle": (0, (6.0, 1.5, 1.0, 1.5))}
CURVE: Look = {"color": "#1f5f9e", "linewidth": 1.2}
LOCKED: Look = {"color": FRONT, "linewidth": 0.0}
JAMS: Look = {"facecolor": "none", "edgecolor": FRONT, "hatch": "////", "linewidth": 0.0}
HEIGHTS = {1: 2.1, 2: 1.6}
"""Height of a panel [inch], by their number."""


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
    shares: list[Curve] = [] if rubbing is None else [("friction", rubbing, FRICTION)]
    if shares or bool(np.nanmax(np.abs(held), initial=0.0) > 0.0):
        inertia = torque - held - (0.0 if rubbing is None else rubbing)
        shares = [("inertia", inertia, INERTIA), ("weights and loads", held, LOADS), *shares]
    looks = {f"driving {drive.effort}": TORQUE}
    if math.isfinite(mean):
        looks[f"mean over time {readable(mean)} {drive.effort_unit}"] = MEAN
    looks |= {name: look for name, _, look in shares}
    entries = [(Line2D([], [], **look), words) for words, look in looks.items()]
    panel = LinePanel(f"{drive.effort} on {drive.joint} [{drive.effort_unit}]", [], level=0.0)
    figure, (axes,) = line_figure(turn, f"Driving {drive.effort}", [panel], turn.notes, entries)
    for _, series, look in (*shares, ("", torque, TORQUE)):
        turn.plot(axes, series, **look)
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
    return reactions(turn, turn.acting, turn.notes) if turn.has_forces else None


def reactions(axis: Abscissa, acting: Forces, notes: Sequence[str]) -> Figure | None:
    """Draw the sizes of the reactions: lengths of pin forces and signed normal forces of guides in
    one panel, moments of guides in one below where there are any; None without reactions."""
    colours, guides = colours_of(axis.scene), acting.sliders
    forces = [
        (f"{point} on {body}", np.hypot(*force.T), colours.get(body, INK))
        for point, body, _, force in free_motion.acted_on(acting)
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
    height = HEIGHTS[len(panels)]
    return line_figure(axis, "Reactions", panels, notes, height=height, top=0.2, down=0.22)[0]


def _dashed(rows: Sequence[tuple[str, Array, str]]) -> list[Curve]:
    """Return curves in their colours, with dashes of their own: bodies share colours."""
    dashes = [DASHES[k % len(DASHES)] for k in range(len(rows))]
    return [
        (name, series, {"color": colour, "linestyle": (0, dash) if dash else "-"})
        for (name, series, colour), dash in zip(rows, dashes, strict=True)
    ]


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
    kinds = ((0, "locks itself", LOCKED), (2, "may jam", JAMS))
    bands = [(turn.acting.has_equilibria(n), words, look) for n, words, look in kinds]
    bands = [band for band in bands if band[0].any()]
    entries += [(Patch(**look), words) for _, words, look in bands]
    notes = [*cycle_words(turn.scene, cycle), "No curve where no power flows.", *turn.notes]
    panel = LinePanel("efficiency", [])
    figure, (axes,) = line_figure(turn, "Efficiency", [panel], notes, entries)
    for samples, _, look in bands:
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
        panels.append(LinePanel(effort, [("", reduced.torque, CURVE)], level=0.0))
    else:
        notes = [f"No weight or load acts, so the reduced {drive.effort} is 0.", *notes]
    title, height = f"Reduced to {drive.joint}", HEIGHTS[len(panels)]
    figure, axes = line_figure(turn, title, panels, notes, height=height, down=0.22)
    axes[0].set_ylim(bottom=0.0)
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
