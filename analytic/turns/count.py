"""The count of whole turns: the angle of a link as a function of the driver's angle.

At time 0 it is the one in (-pi, pi]; from there on it goes with the driver, whoever asks, for one
sample or for a million, in any order. Over what the mechanism takes to repeat, a turn of the driver
or some of them, a link gains a whole number of turns.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from analytic.turns.cells import Cells, CellSolver
from models.array import Array


@dataclass(frozen=True)
class Turns:
    """The whole turns of the links of a scene.

    ``borders`` are the driver angles [rad] between cells, increasing over a period; ``angles`` are
    those of each link in the middle of the cells, (cells,), and ``gains`` the whole turns that it
    makes in a period. What an angle may be off by within a cell is its ``spread`` [rad], (cells,).
    Driver angles that are no more than ``step_rad`` apart leave less than half a turn between the
    angles of any link.
    """

    borders: Array
    angles: Mapping[str, Array]
    gains: Mapping[str, float]
    spread: Array
    step_rad: float

    @staticmethod
    def of(look: CellSolver, start: float, period: float) -> Turns:
        """The turns of a mechanism that repeats after a ``period`` of its driver, which stands at
        ``start`` at time 0 [rad]."""
        turns = _joined(look.divided(start, period), period)
        at_start = np.array([start])
        place, angles = turns.places(at_start), {}
        for name, angle in look.at(at_start).angles.items():
            angles[name] = turns.angles[name] - math.tau * turns.short(name, angle, *place)
        return replace(turns, angles=angles)

    @cached_property
    def counted(self) -> frozenset[str]:
        """The links that ever leave (-pi, pi): there is nothing to count of others."""
        swings = {
            n: bool(np.all(np.abs(a) + self.spread < math.pi - 1e-3))
            for n, a in self.angles.items()
        }
        return frozenset(n for n, gain in self.gains.items() if gain or not swings[n])

    def places(self, theta: Array) -> tuple[NDArray[np.intp], Array]:
        """The cells in which driver angles [rad], (T,), are, and after how many periods."""
        low, period = self.borders[0], self.borders[-1] - self.borders[0]
        periods = np.floor((theta - low) / period)
        cells = np.searchsorted(self.borders[1:-1], theta - periods * period, side="right")
        return cells, np.asarray(periods)

    def short(self, name: str, angle: Array, cells: NDArray[np.intp], periods: Array) -> Array:
        """The whole turns that angles [rad], (T,), of a link at such places are short of."""
        turns = np.round((self.angles[name][cells] - angle) / math.tau)
        return np.asarray(turns + self.gains[name] * periods)


@dataclass(frozen=True)
class Counter:
    """Counts the turns of links at driver angles ``theta`` [rad], (T,)."""

    turns: Turns
    theta: Array

    def count(self, name: str, angle: Array) -> None:
        """Add to the angles of a link [rad], (T,), the whole turns that they are short of."""
        if name in self.turns.counted and not self._follow(name, angle):
            places = self.turns.places(self.theta)
            angle += math.tau * self.turns.short(name, angle, *places)

    def _follow(self, name: str, angle: Array) -> bool:
        """Count from the first angle on, where each follows from the one before it; False, and the
        angles as they were, where they do not, or one that is not sure leads astray."""
        if self._ends is None:
            return False
        first, last = self.turns.short(name, angle[[0, -1]], *self._ends).tolist()
        if angle.max() - angle.min() <= math.pi:  # no jump to look for
            if first:
                angle += math.tau * first
            return True
        jumps = np.cumsum(np.round((angle[1:] - angle[:-1]) / math.tau))
        if first - jumps[-1] != last:
            return False
        angle[0] += math.tau * first
        angle[1:] += math.tau * (first - jumps)
        return True

    @cached_property
    def _ends(self) -> tuple[NDArray[np.intp], Array] | None:
        """The places of the first and the last angle of the driver, if it goes in small steps."""
        step, most = self.theta[1:] - self.theta[:-1], self.turns.step_rad
        small = not step.size or (step.max() <= most and step.min() >= -most)
        return self.turns.places(self.theta[[0, -1]]) if small else None


def _joined(cells: Cells, period: float) -> Turns:
    """The cells of a period, the angles of each joined to the nearest of the one before it."""
    angles, gains = {}, {}
    for name, angle in cells.angles.items():
        jumps = np.round((np.roll(angle, -1) - angle) / math.tau)  # the last into the next period
        turns = -np.cumsum(jumps)
        angles[name] = angle + math.tau * np.concatenate([[0.0], turns[:-1]])
        gains[name] = float(turns[-1])
    low = float(cells.middle[0] - cells.half[0])
    borders = np.concatenate([[low], (cells.middle + cells.half)[:-1], [low + period]])
    step = 0.0
    if not (cells.unsure & ~cells.is_open).any() and not cells.is_open.all():
        step = 2.0 * float(cells.half[~cells.is_open].min())
    return Turns(borders, angles, gains, cells.spread, step)
