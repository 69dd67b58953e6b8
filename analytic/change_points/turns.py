"""The count of whole turns: the angle of a link as a function of the driver's angle.

At time 0 it is in (-pi, pi]; from there on it follows the driver, for one sample or for a million,
in any order. In a period of the mechanism, one or more turns of the driver, a link gains a whole
number of turns.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from analytic.dyads.chunk import Passage
from analytic.dyads.plane import EPS
from analytic.dyads.steps import Step, uncertain_chunk
from models.array import Array, Mask
from models.scene import Scene


@dataclass(frozen=True)
class Turns:
    """Whole turns of the links of a scene.

    ``borders`` are the driver angles [rad] between cells, increasing over a period; ``angles`` are
    those of each link in the middle of the cells, (cells,), and ``gains`` the whole turns that it
    makes in a period. The largest deviation of an angle within a cell is its ``spread`` [rad],
    (cells,). Driver angles that are no more than ``step_rad`` apart leave less than half a turn
    between the angles of any link.
    """

    borders: Array
    angles: Mapping[str, Array]
    gains: Mapping[str, float]
    spread: Array
    step_rad: float

    @staticmethod
    def of(look: CellSolver, start: float, period: float) -> Turns:
        """Count the turns of a mechanism that repeats after a ``period`` of its driver, which is at
        ``start`` at time 0 [rad]."""
        turns = _joined(look.divided(start, period), period)
        at_start = np.array([start])
        place, angles = turns.places(at_start), {}
        for name, angle in look.at(at_start).angles.items():
            angles[name] = turns.angles[name] - math.tau * turns.short(name, angle, *place)
        return replace(turns, angles=angles)

    @cached_property
    def counted(self) -> frozenset[str]:
        """Links that ever leave (-pi, pi): others need no count."""
        swings = {
            n: bool(np.all(np.abs(a) + self.spread < math.pi - 1e-3))
            for n, a in self.angles.items()
        }
        return frozenset(n for n, gain in self.gains.items() if gain or not swings[n])

    def places(self, theta: Array) -> tuple[NDArray[np.intp], Array]:
        """Return the cells of driver angles [rad], (T,), and the number of periods before them."""
        low, period = self.borders[0], self.borders[-1] - self.borders[0]
        periods = np.floor((theta - low) / period)
        cells = np.searchsorted(self.borders[1:-1], theta - periods * period, side="right")
        return cells, np.asarray(periods)

    def short(self, name: str, angle: Array, cells: NDArray[np.intp], periods: Array) -> Array:
        """Return the whole turns that angles [rad], (T,), of a link at such places are short of."""
        turns = np.round((self.angles[name][cells] - angle) / math.tau)
        return np.asarray(turns + self.gains[name] * periods)


@dataclass(frozen=True)
class Counter:
    """Counter of the turns of links at driver angles ``theta`` [rad], (T,)."""

    turns: Turns
    theta: Array

    def count(self, name: str, angle: Array) -> None:
        """Add the missing whole turns to the angles of a link [rad], (T,)."""
        if name in self.turns.counted and not self._follow(name, angle):
            places = self.turns.places(self.theta)
            angle += math.tau * self.turns.short(name, angle, *places)

    def _follow(self, name: str, angle: Array) -> bool:
        """Count from the first angle on, where each follows from the one before it; False, with
        unchanged angles, where they do not, or an uncertain one leads astray."""
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
        """Places of the first and the last angle of the driver, if it goes in small steps."""
        step, most = self.theta[1:] - self.theta[:-1], self.turns.step_rad
        small = not step.size or (step.max() <= most and step.min() >= -most)
        return self.turns.places(self.theta[[0, -1]]) if small else None


def _joined(cells: Cells, period: float) -> Turns:
    """Join the angles of each cell of a period to the nearest of the one before it."""
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


SURE = 0.78
"""Sufficient bound [rad]: two angles in one cell, or in neighbours, are at most four times as far
apart, which is less than half a turn."""
CELLS = 64
"""Cells of a turn of the driver, before any is divided."""
PARTS = 4
"""Number of parts of a divided cell."""
MOST = 1 << 18
"""No more cells than this over the number of links: a chain of six dyads takes up to 20,000 cells.
Beyond, some may not be sure, and their angles are joined to the nearest, unproven. Bounds of angles
leave this out: a whole turn for all later ones would make them useless."""
NARROWEST = 1e-11
"""Half-width [rad] of a cell that is not divided, even if a mechanism that runs through infinity
there leaves it unsure."""
OPEN = 4e-3
"""The same for a cell in which the mechanism is open everywhere, so that its angle is not needed:
open in the middle is not enough, as all of a narrow reachable range may lie beside it."""


@dataclass(frozen=True)
class Cells:
    """Cells in the order of their driver angles.

    By cell: its middle and half its width [rad], the angle of each link in the middle (stretched
    where the mechanism is open) up to whole turns, the largest deviation of any link from there
    wherever in the cell the mechanism closes, and True if it is open all over the cell.

    ::

        angle |            ____        An arctan2 gives the angle of a link up to whole turns.
        Over
              |  +----+  _/  +----+   a cell it stays within a bound of that in the middle of the
              |  |   _|_/    |    |   cell, which says of every angle there which turn is meant, and
              |  | _/ |      |    |   so from each cell to the next.
              |  +----+      +----+
              +------------------------- driver

    That bound is no guess from samples: it is the bound of the link's angle
    (`analytic.dyads.parts`) for a driver whose own angle is uncertain by half of the cell. A cell
    with too wide a bound is divided.
    """

    middle: Array
    half: Array
    angles: Mapping[str, Array]
    spread: Array
    is_open: Mask

    @property
    def unsure(self) -> Mask:
        return np.asarray(self.spread > SURE)

    def these(self, index: NDArray[np.intp] | Mask) -> Cells:
        """Return some of the cells, or all in another order."""
        angles = {name: angle[index] for name, angle in self.angles.items()}
        middle, half = self.middle[index], self.half[index]
        return Cells(middle, half, angles, self.spread[index], self.is_open[index])

    def with_more(self, more: Cells) -> Cells:
        both = Cells(
            np.concatenate([self.middle, more.middle]),
            np.concatenate([self.half, more.half]),
            {name: np.concatenate([self.angles[name], more.angles[name]]) for name in self.angles},
            np.concatenate([self.spread, more.spread]),
            np.concatenate([self.is_open, more.is_open]),
        )
        return both.these(np.argsort(both.middle))


@dataclass(frozen=True)
class CellSolver:
    """Solver of a scene at driver angles that are uncertain."""

    scene: Scene
    steps: Sequence[Step]
    passages: Mapping[str, Passage]

    def at(self, middle: Array, half: Array | float = 0.0) -> Cells:
        """Return the cells about driver angles [rad], (n,), of half-widths [rad]."""
        half = np.broadcast_to(half, middle.shape)
        wide = half * (1.0 + 1e-6) + 8 * EPS * np.abs(middle)
        chunk = uncertain_chunk(self.scene, self.steps, middle, wide, self.passages)
        angles: dict[str, Array] = {}
        spread, is_open = np.zeros(middle.shape), np.zeros(middle.shape, dtype=bool)
        for name in self.scene.links:
            body = chunk.bodies.get(name)
            if body is None:  # placed by later steps
                continue
            if body.theta is None and body.error is not None:
                angle = np.arctan2(body.turn.y, body.turn.x)
                angles[name] = np.nan_to_num(np.broadcast_to(angle, middle.shape))
                spread = np.maximum(spread, np.nan_to_num(body.error.theta, nan=np.inf))
        for key, short in chunk.shortage.items():
            closure = chunk.closures.get(key)  # none of a redundant link, whose misfit is net
            is_open |= np.asarray(short > (closure.slack_m if closure else 0.0))
        return Cells(middle, half, angles, spread, is_open)

    def divided(self, start: float, period: float) -> Cells:
        """Return cells over a ``period`` from ``start`` on [rad], all sure as far as possible."""
        count = CELLS * round(period / math.tau)
        half = 0.5 * period / count
        cells = self.at(np.asarray(start + half * (2.0 * np.arange(count) + 1.0)), half)
        parts = (2.0 * np.arange(PARTS) + 1.0) / PARTS - 1.0
        while True:
            wide = cells.unsure & (cells.half > np.where(cells.is_open, OPEN, NARROWEST))
            many = wide.size + PARTS * int(np.count_nonzero(wide))
            if not wide.any() or many * len(self.scene.links) > MOST:
                return cells
            middle, halves = cells.middle[wide, None], cells.half[wide, None]
            inside: Array = (middle + halves * parts).ravel()
            narrower = self.at(inside, np.repeat(halves / PARTS, PARTS))
            cells = cells.these(~wide).with_more(narrower)
