"""Cells of driver angles, so narrow that no link can lose count of its turns within one.

::

    angle |              ____        An arctan2 gives the angle of a link but for whole turns. Over
          |  +-----+   _/  +-----+   a cell it stays within a bound of that in the middle of the
          |  |    _|__/    |     |   cell, which says of every angle there which turn is meant, and
          |  | __/ |       |     |   so from each cell to the next.
          |  +-----+       +-----+
          +------------------------- driver

That bound is no guess from samples: it is the bound of the link's angle (`analytic.dyads.closure`)
for a driver whose own angle is uncertain by half of the cell. A cell in which it says too little is
divided.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from analytic.dyads.chunk import Chunk, Passage
from analytic.dyads.plane import EPS, STEADY, AngleError
from analytic.dyads.steps import Step
from models.array import Array, Mask
from models.scene import Scene

SURE = 0.78
"""A bound [rad] that says enough: two angles in one cell, or in neighbours, are at most four times
as far apart, which is less than half a turn."""
CELLS = 64
"""Cells of a turn of the driver, before any is divided."""
PARTS = 4
"""A cell is divided into so many."""
MOST = 1 << 18
"""No more cells than this over the number of links: a chain of six dyads takes up to 20,000 cells.
Beyond, some may not be sure, and their angles are joined to the nearest, unproven.
Bounds of angles do not say so: a whole turn for all that comes after would say nothing of them."""
NARROWEST = 1e-11
"""Half of a cell [rad] that is not divided, though a mechanism that runs through infinity there
leaves it unsure."""
OPEN = 4e-3
"""The same where the mechanism can be assembled nowhere in the cell, so that nobody asks: open in
the middle is not enough, as all of a narrow reachable range may lie beside it."""


@dataclass(frozen=True)
class Cells:
    """Cells in the order of their driver angles.

    By cell: its middle and half its width [rad], the angle of each link in the middle (stretched
    where the mechanism is open) but for whole turns, how far from there any link may be wherever in
    the cell the mechanism closes, and whether it is open all over the cell.
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
        """Some of the cells, or all in another order."""
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
    """Looks at a scene at driver angles that are uncertain."""

    scene: Scene
    steps: Sequence[Step]
    passages: Mapping[str, Passage]

    def at(self, middle: Array, half: Array | float = 0.0) -> Cells:
        """The cells about driver angles [rad], (n,), of half-widths [rad]."""
        half = np.broadcast_to(half, middle.shape)
        error = AngleError(half * (1.0 + 1e-6) + 8 * EPS * np.abs(middle), 0.0, 0.0)
        chunk = Chunk.begin(
            self.scene, middle, 1.0, STEADY, error, stretch=True, passages=self.passages
        )
        with np.errstate(all="ignore"):
            for step in self.steps:
                step.advance(chunk)
        angles: dict[str, Array] = {}
        spread, is_open = np.zeros(middle.shape), np.zeros(middle.shape, dtype=bool)
        for name in self.scene.links:
            body = chunk.bodies[name]
            if body.theta is None and body.error is not None:
                angle = np.arctan2(body.turn.y, body.turn.x)
                angles[name] = np.nan_to_num(np.broadcast_to(angle, middle.shape))
                spread = np.maximum(spread, np.nan_to_num(body.error.theta, nan=np.inf))
        for key, short in chunk.shortage.items():
            closure = chunk.closures.get(key)  # none of a redundant link, whose misfit is net
            is_open |= np.asarray(short > (closure.slack_m if closure else 0.0))
        return Cells(middle, half, angles, spread, is_open)

    def divided(self, start: float, period: float) -> Cells:
        """Cells over a ``period`` from ``start`` on [rad], all sure as far as that goes."""
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
