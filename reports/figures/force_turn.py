"""A turn of a scene under forces: the axis of its figures, and forces as vectors, in polar diagrams
of pins and on the mechanism."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator, MultipleLocator
from numpy.typing import NDArray

from analytic.forces.virtual_power import ReducedMachine, reduced_machine
from models.array import Array
from models.motion import Forces, Motion
from models.scene import Scene
from models.scene.characteristics import Constant
from models.scene.driver import driver_axis, driver_shown, driver_stands
from models.scene.laws import ConstantSpeed
from reports.describe.free_motion import acted_on
from reports.describe.with_forces import cleaned_forces, force_notes, turn_with_forces
from reports.drawing.force_arrows import force_arrows
from reports.drawing.moving import goes_round
from reports.drawing.shape import PATH_SAMPLES, Label, clear_of_locking, colours_of, place, turn_of
from reports.figures import style
from reports.figures.mechanism import mechanism_at
from reports.figures.sheet import Panels, sheet
from reports.figures.style import INK, TINY
from reports.output.numbers import readable


@dataclass(frozen=True)
class ForceTurn:
    """The first turn of a scene: its motion with forces, and the machine reduced to its driver.

    ``x`` is the axis of curves, called ``label``, between ``ends``; ``order`` are its samples.
    """

    scene: Scene
    motion: Motion
    acting: Forces
    reduced: ReducedMachine
    x: Array
    label: str
    ends: tuple[float, float]
    order: NDArray[np.intp]

    def plot(self, axes: Axes, series: Array, **look: Any) -> None:
        """Draw a series of the turn (T,)."""
        axes.plot(self.x, series[self.order], **look)

    def mark(self, axes: Axes, *, labelled: bool = True) -> None:
        """Set limits, ticks and label of the horizontal axis; short numbers on the other."""
        axes.set_xlim(*self.ends)
        axes.set_xlabel(self.label if labelled else "")
        axes.tick_params(labelbottom=labelled)
        style.shorten(axes)
        if self.label.endswith("[deg]"):
            axes.xaxis.set_major_locator(MultipleLocator(60.0))

    @property
    def has_forces(self) -> bool:
        """True if any forces are left to draw, beside where friction locks."""
        return bool(np.isfinite(self.acting.torque).any())

    @property
    def notes(self) -> list[str]:
        """Notes under each figure."""
        scene = self.scene
        notes = [style.note(scene, "closed form", "driver", style.loads_told(scene))]
        notes += force_notes(scene, self.motion)
        if self.acting.has_equilibria(0).any():
            left = "" if self.has_forces else ", which is all of the turn"
            notes.append(f"Forces within 5 deg of it are not drawn{left}.")
        return notes


def force_turn(scene: Scene) -> ForceTurn:
    """Return the turn of a scene. Raises CrankcheckError as `with_forces`."""
    motion = turn_with_forces(scene)
    assert motion.forces is not None
    reduced = reduced_machine(scene, motion.time_s)
    acting = clear_of_locking(cleaned_forces(motion.forces))
    law, every = scene.driver.law, np.arange(motion.time_s.size)
    label, x = driver_axis(scene), driver_shown(scene, motion)
    ends = (float(x.min()), float(x.max()))
    if not goes_round(scene):  # every place may be passed twice
        x, label, ends = motion.time_s, "time [s]", (0.0, law.period_s)
    elif isinstance(law, ConstantSpeed) and _is_cyclic(scene, np.radians(x)):
        # A turn is like every other: it is drawn from 0 on, wherever it began.
        around = np.mod(np.round(x[:-1], 9), 360.0)
        every = np.argsort(around)
        every = np.concatenate([every[-1:], every, every[:1]])
        x, ends = around[every], (0.0, 360.0)
        x[0], x[-1] = x[0] - 360.0, x[-1] + 360.0
    return ForceTurn(scene, motion, acting, reduced, x, label, ends, every)


def _is_cyclic(scene: Scene, theta: Array) -> bool:
    """True if every turn of a driver of one speed is like the others: no load follows time, and
    none follows the angle otherwise than turn by turn (a four-stroke's does)."""
    for load in scene.loads.values():
        own = load.characteristic
        if isinstance(own, Constant) or load.over == "displacement":
            continue
        if load.over == "time":
            return False
        try:
            again, size = own.at(theta - math.tau), np.max(np.abs(own.at(theta)))
        except ValueError:  # a table of this turn alone
            return False
        if np.max(np.abs(again - own.at(theta))) > 1e-9 * size:
            return False
    return True


COLUMNS = 3
EVERY_DEG, NAMED_DEG = 30, 90
"""Angles of the driver with a dot, and angles with their number beside it."""
ROOM = 0.12
"""Room around a curve, over its size."""


def hodographs(turn: ForceTurn) -> Figure | None:
    """Draw polar diagrams, the way of the tip of each pin's reaction over a turn, drawn from one
    point, a panel per pin, with equal axes each; None where there are no reactions."""
    pins = list(acted_on(turn.acting))
    if not (pins and turn.has_forces):
        return None
    columns = 2 if len(pins) == 4 else min(COLUMNS, len(pins))
    rows = math.ceil(len(pins) / columns)
    left, right, across = 0.5, 0.1, 0.55
    side = (style.PAGE_IN - left - right - across * (COLUMNS - 1)) / COLUMNS
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
    for (point, body, source, force), one in zip(pins, axes, strict=False):
        words = f"{point}, of {source} on {body}" if source != "pin" else f"{point} on {body}"
        one.set_title(style.cut(words, side))
        _panel(one, turn, force, colours.get(body, INK), side)
    for one in axes[len(pins) :]:
        one.remove()
    return figure


def _panel(axes: Axes, turn: ForceTurn, force: Array, colour: str, side: float) -> None:
    """Draw the diagram of one reaction, (T, 2), in a square of ``side`` [inch]."""
    there = force[np.isfinite(force).all(axis=1)]
    every = np.vstack([there, [[0.0, 0.0]]])
    low, high = every.min(axis=0), every.max(axis=0)
    size = float(np.max(high - low)) or 1.0
    middle, half = (low + high) / 2, size * (0.5 + ROOM)
    axes.set(xlim=(middle[0] - half, middle[0] + half), ylim=(middle[1] - half, middle[1] + half))
    axes.set_aspect("equal", adjustable="box")
    axes.plot(*force.T, color=colour)
    axes.plot(0.0, 0.0, marker="+", color=INK, markersize=6.0, zorder=4)
    axes.xaxis.set_major_locator(MaxNLocator(5))
    axes.yaxis.set_major_locator(MaxNLocator(5))
    axes.set_xlabel("x [N]")
    axes.set_ylabel("y [N]")
    dots = _dots(turn)
    if dots:
        axes.plot(*force[list(dots)].T, "o", color=colour, markersize=2.4, zorder=3)
    per_n = side / (2 * half)
    _numbers(axes, dots, force, middle - half, per_n, side)


def _numbers(
    axes: Axes, dots: dict[int, int], force: Array, low: Array, per_n: float, side: float
) -> None:
    """Draw the driver's angle beside some dots, clear of the curve and of one another."""
    named = [
        (k, deg) for k, deg in dots.items() if deg % NAMED_DEG == 0 and np.isfinite(force[k]).all()
    ]
    curve = (force[np.isfinite(force).all(axis=1)] - low) * per_n
    height = 0.8 * TINY / style.POINTS
    labels = [
        Label(
            str(deg), (style.width_in(str(deg), TINY), height), (force[k] - low)[None] * per_n, 0.02
        )
        for k, deg in named
    ]
    if not labels:
        return
    heavy = np.column_stack([curve, np.full(len(curve), 0.008)])
    cross = np.append(-low * per_n, 0.05)
    centres = place(labels, np.vstack([heavy, cross]), curve[:0], (side, side))
    for label, (x, y) in zip(labels, centres, strict=True):
        right, up = (float(each) for each in low + np.array([x, y]) / per_n)
        look: dict[str, Any] = {"size": TINY, "color": style.QUIET, "ha": "center", "va": "center"}
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
        f"Where the reactions are largest; driving {drive.effort} {torque} {drive.effort_unit}. An "
        "arrow is the force on the body of its colour, a black one that on a block."
    )
    return mechanism_at(scene, path, at, arrows.box(path), title, [words, *turn.notes], arrows)
