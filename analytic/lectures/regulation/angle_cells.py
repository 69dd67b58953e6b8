"""Cycle in cells of the driver's angle, within which all torques are smooth, and polynomials
through Gauss's nodes in them.

Source: E. Hairer, S. P. Norsett, G. Wanner, Solving Ordinary Differential Equations I, II.7, on
collocation: with s nodes the borders are right to the order 2 s.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from analytic.lectures.regulation.turning_machine import TurningMachine, follows_speed
from analytic.structure.mobility import analyse
from models.array import Array
from models.scene.characteristics import Constant, FourierSum, Sine
from models.scene.loads import Load

NODES = 5
CELLS = 120
"""Cells of a turn, before it is cut at kinks."""
APART = 1e-14
"""Distance of borders, over the cycle, below which they are one by rounding."""


def _lagrange() -> tuple[Array, Array]:
    """Return Gauss's nodes in (0, 1), and by row the coefficients, that of x^0 first, of the
    integrals from 0 of the polynomials that are 1 in one node and 0 in the others."""
    nodes = 0.5 * (np.polynomial.legendre.leggauss(NODES)[0] + 1.0)
    # Column j of the inverse of the Vandermonde matrix holds the coefficients of polynomial j.
    own = np.linalg.inv(np.vander(nodes, increasing=True)).T
    powers = np.arange(1, NODES + 1)
    return nodes, np.concatenate([np.zeros((NODES, 1)), own / powers], axis=1)


PLACES, INTEGRALS = _lagrange()


def integrals_to(share: Array) -> Array:
    """Return the integrals of the polynomials from 0 to shares of a cell, (..., NODES)."""
    return np.asarray(np.vander(np.ravel(share), NODES + 1, increasing=True) @ INTEGRALS.T).reshape(
        (*np.shape(share), NODES)
    )


INSIDE: Array = integrals_to(PLACES)
"""Butcher's matrix (NODES, NODES): the integrals to each node."""
WHOLE: Array = integrals_to(np.array(1.0))
"""Weights of Gauss's quadrature, (NODES,)."""
LEGENDRE: Array = (
    (2 * np.arange(NODES) + 1)
    * WHOLE[:, None]
    * np.polynomial.legendre.legvander(2.0 * PLACES - 1.0, NODES - 1)
)
"""Coefficients of Legendre's polynomials, by column, of a quantity at the nodes (by row)."""


@dataclass(frozen=True)
class AngleCells:
    """Cells between increasing ``borders`` (C + 1,) of the angle u [rad], the first of them 0."""

    borders: Array

    @staticmethod
    def of(cycle_rad: float, breaks: Array) -> AngleCells:
        """Make even cells of a cycle, cut at ``breaks`` as well."""
        count = CELLS * max(1, round(cycle_rad / math.tau))
        every = np.unique(np.concatenate([np.linspace(0.0, cycle_rad, count + 1), breaks]))
        every = every[(every >= 0.0) & (every <= cycle_rad)]
        inner = every[np.concatenate([[True], np.diff(every) > APART * cycle_rad])]
        inner = inner[inner < cycle_rad * (1.0 - APART)]
        return AngleCells(np.append(inner, cycle_rad))

    @property
    def widths(self) -> Array:
        """Widths of the cells (C,) [rad]."""
        return np.diff(self.borders)

    @property
    def nodes(self) -> Array:
        """Gauss's nodes (C, NODES) [rad]."""
        return self.borders[:-1, None] + self.widths[:, None] * PLACES

    def places(self, u: Array) -> tuple[NDArray[np.intp], Array]:
        """Return the cells of angles, and the positions in them as shares."""
        cell = np.clip(np.searchsorted(self.borders, u, side="right") - 1, 0, len(self.widths) - 1)
        return cell, (u - self.borders[cell]) / self.widths[cell]

    def integral(self, series: Array) -> float:
        """Return the integral of a quantity at the nodes (C, NODES) over the cycle."""
        return float(np.sum(self.widths[:, None] * WHOLE * series))

    def integrated(self, series: Array, u: Array) -> Array:
        """Return the integrals from 0 to angles u (T,) of a quantity at the nodes."""
        parts = self.widths * (series @ WHOLE)
        before = np.concatenate([[0.0], np.cumsum(parts)])
        cell, share = self.places(u)
        inner = np.sum(integrals_to(share) * series[cell], axis=1)
        return np.asarray(before[cell] + self.widths[cell] * inner)


LOOKS = 720
"""Samples of a turn for the search of a slider's passage of a table row."""
HALVINGS = 44


@lru_cache(maxsize=16)
def breaks(machine: TurningMachine) -> Array:
    """Return the angles u of a cycle at kinks of loads over angle or displacement [rad]."""
    found = [np.zeros(0)]
    u = looks(machine)
    for load in machine.scene.loads.values():
        if load.slider is not None and load.stroke != "both":
            found.append(crossings(_slider(machine, load, "speed"), u, [0.0]))
        if isinstance(load.characteristic, Constant):
            continue
        if load.over == "displacement":
            at, ends = _slider(machine, load, "s"), _slider(machine, load, "speed")
            fine = np.sort(np.append(u, crossings(ends, u, [0.0])))  # rows close to a dead centre
            found.append(crossings(at, fine, load.characteristic.kinks))
        elif load.over == "angle":
            found += [_rows(machine, load), _short_waves(machine, load)]
    found += [_turnings(machine, joint, u) for joint in machine.scene.friction]
    return np.concatenate(found)


def _short_waves(machine: TurningMachine, load: Load) -> Array:
    """Return quarters of the shortest wave of a load over the angle that even cells would miss."""
    own = load.characteristic
    if not isinstance(own, Sine | FourierSum):
        return np.zeros(0)
    waves = len(own.sines) if isinstance(own, FourierSum) else 1
    quarters = round(4.0 * max(waves, 1) * machine.cycle_rad / own.period)
    if quarters <= CELLS * machine.cycle_rad / math.tau:
        return np.zeros(0)
    return np.linspace(0.0, machine.cycle_rad, quarters + 1)


def rated_breaks(machine: TurningMachine, speed: Callable[[Array], Array]) -> Array:
    """Return those of loads over a speed, for driver speeds [rad/s] by the angle u."""
    found = [np.zeros(0)]
    for load in filter(follows_speed, machine.scene.loads.values()):

        def of(u: Array, load: Load = load) -> Array:
            chunk = machine.mechanism(u)
            own = chunk.bodies[load.body].omega if load.slider is None else None
            rate = own if load.slider is None else chunk.sliders[load.slider].speed
            return machine.way * np.asarray(rate) * speed(u)

        found.append(crossings(of, looks(machine), load.characteristic.kinks))
    return np.concatenate(found)


def looks(machine: TurningMachine) -> Array:
    """Return angles of a cycle, its ends among them [rad]."""
    return np.linspace(0.0, machine.cycle_rad, LOOKS * round(machine.cycle_rad / math.tau) + 1)


def crossings(of: Callable[[Array], Array], u: Array, levels: Iterable[float]) -> Array:
    """Return the angles within ``u`` at which a quantity passes levels [rad], by bisection."""
    values = np.broadcast_to(of(u), u.shape)
    above = [(level, values >= level) for level in levels]
    hits = [(level, k) for level, up in above for k in np.flatnonzero(up[1:] != up[:-1])]
    if not hits:
        return np.zeros(0)
    level, first = (np.array(each) for each in zip(*hits, strict=True))
    low, high, side = u[first], u[first + 1], values[first] >= level
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        same = (np.broadcast_to(of(middle), middle.shape) >= level) == side
        low, high = np.where(same, middle, low), np.where(same, high, middle)
    return np.asarray(0.5 * (low + high))


def _slider(machine: TurningMachine, load: Load, what: str) -> Callable[[Array], Array]:
    """Return the displacement or the speed of a load's slider, over the angle."""
    assert load.slider is not None
    slider = load.slider
    return lambda u: np.asarray(getattr(machine.mechanism(u).sliders[slider], what))


def _rows(machine: TurningMachine, load: Load) -> Array:
    """Return the angles at which the driver is at a row of a table that repeats."""
    rows, period = np.array(load.characteristic.kinks), load.characteristic.repeats_after
    if not rows.size or period is None:
        return np.zeros(0)
    first = np.mod(machine.way * (rows - machine.start_rad), period)
    count = round(machine.cycle_rad / period)
    return np.asarray((first + period * np.arange(count)[:, None]).ravel())


def _turnings(machine: TurningMachine, joint: str, u: Array) -> Array:
    """Return the angles at which the motion in a joint reverses, and its friction with it."""
    if joint in machine.scene.sliders:
        return crossings(lambda x: np.asarray(machine.mechanism(x).sliders[joint].speed), u, [0.0])
    first, second = analyse(machine.scene).pins[joint][:2]

    def rate(x: Array) -> Array:
        chunk = machine.mechanism(x)
        return np.asarray(chunk.bodies[second].omega - chunk.bodies[first].omega)

    return crossings(rate, u, [0.0])
