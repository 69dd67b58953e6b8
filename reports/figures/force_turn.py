"""The first turn of a scene under forces, as its figures are drawn over it."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from analytic.forces.virtual_power import ReducedMachine, reduced_machine
from models.array import Array
from models.motion import Forces, Motion
from models.scene import Scene, characteristics, laws
from models.scene.driver import driver_axis, driver_shown
from reports.describe import with_forces
from reports.drawing.moving import goes_round
from reports.drawing.shape import clear_of_locking
from reports.figures import style
from reports.figures.sheet import spaced


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
            spaced(axes, 60.0)

    @property
    def has_forces(self) -> bool:
        """True if any forces are left to draw, beside where friction locks."""
        return bool(np.isfinite(self.acting.torque).any())

    @property
    def notes(self) -> list[str]:
        """Notes under each figure."""
        scene = self.scene
        notes = [style.note(scene, "closed form", "driver", style.loads_told(scene))]
        notes += with_forces.force_notes(scene, self.motion)
        if self.acting.has_equilibria(0).any():
            left = "" if self.has_forces else ", which is all of the turn"
            notes.append(f"Forces within 5 deg of it are not drawn{left}.")
        return notes


def force_turn(scene: Scene) -> ForceTurn:
    """Return the turn of a scene. Raises CrankcheckError as `with_forces`."""
    motion = with_forces.turn_with_forces(scene)
    assert motion.forces is not None
    reduced = reduced_machine(scene, motion.time_s)
    acting = clear_of_locking(with_forces.cleaned_forces(motion.forces))
    law, every = scene.driver.law, np.arange(motion.time_s.size)
    label, x = driver_axis(scene), driver_shown(scene, motion)
    ends = (float(x.min()), float(x.max()))
    if not goes_round(scene):  # every place may be passed twice
        x, label, ends = motion.time_s, "time [s]", (0.0, law.period_s)
    elif isinstance(law, laws.ConstantSpeed) and _is_cyclic(scene, np.radians(x)):
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
        if isinstance(own, characteristics.Constant) or load.over == "displacement":
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
