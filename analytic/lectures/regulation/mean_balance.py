"""The work of a cycle at constant speed: at which speed a machine that is left to its torques would
neither gain nor lose, and where there is none, why there is no steady cycle."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import lru_cache

import numpy as np

from analytic.lectures.regulation.angle_cells import AngleCells
from analytic.lectures.regulation.turning_machine import TurningMachine
from analytic.lectures.regulation.unsmooth import breaks
from models.array import Array
from models.errors import CrankcheckError

SLOWEST, FASTEST, SPEEDS = 1e-3, 1e5, 81
"""Speeds that are looked at [rad/s]; a factor of 1.26 lies between two of them."""
HALVINGS = 60


@lru_cache(maxsize=16)
def settled_speed(machine: TurningMachine) -> float:
    """The speed at which the work of a cycle is 0, that a machine comes to from the speed of its
    start [rad/s]. Raises CrankcheckError as `MeanBalance.settled`."""
    start = abs(float(machine.scene.driver.law.at(np.zeros(1))[1][0]))
    return MeanBalance(machine, AngleCells.of(machine.cycle_rad, breaks(machine))).settled(start)


class MeanBalance:
    """The work of all torques over a cycle [J], with the driver at constant speed."""

    def __init__(self, machine: TurningMachine, cells: AngleCells) -> None:
        self.machine, self.cells = machine, cells
        self.steady = cells.integral(machine.steady_torque(cells.nodes))

    def work(self, speed: float) -> float:
        """That at a speed [rad/s]; NaN where a table of a load does not reach as far."""
        nodes = self.cells.nodes
        try:
            rated = self.machine.rated_torque(nodes, np.full_like(nodes, speed))
        except CrankcheckError:
            return math.nan
        return self.steady + self.cells.integral(rated)

    def settled(self, start: float) -> float:
        """The speed at which the work is 0, that the machine comes to from its start [rad/s]:
        upwards where it gains there, downwards where it loses.

        Raises CrankcheckError where there is none, or for a table that does not reach its start.
        """
        start = max(start, SLOWEST)
        self.machine.rated_torque(self.cells.nodes, np.full_like(self.cells.nodes, start))
        speeds = np.unique(np.append(np.geomspace(SLOWEST, FASTEST, SPEEDS), start))
        works = np.array([self.work(each) for each in speeds.tolist()])
        speeds, works = self._to_the_ends(speeds, works)
        first = int(np.argmin(np.abs(speeds - start)))
        if works[first] > 0.0:
            ahead = np.flatnonzero(works[first:] <= 0.0)
            pair = (first + int(ahead[0]) - 1, first + int(ahead[0])) if ahead.size else None
        else:
            behind = np.flatnonzero(works[: first + 1] > 0.0)
            pair = (int(behind[-1]), int(behind[-1]) + 1) if behind.size else None
        if pair is None:
            raise CrankcheckError(self._never(speeds, works, first))
        low, high = (float(speeds[k]) for k in pair)
        for _ in range(HALVINGS):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if self.work(middle) > 0.0 else (low, middle)
        return 0.5 * (low + high)

    def _to_the_ends(self, speeds: Array, works: Array) -> tuple[Array, Array]:
        """The speeds that all tables reach, as far as they do."""
        known = np.flatnonzero(np.isfinite(works))
        kept, own = speeds[known].tolist(), works[known].tolist()
        for inside, outside, at in (
            (known[0], known[0] - 1, 0), (known[-1], known[-1] + 1, len(kept)),
        ):  # fmt: skip
            if not 0 <= outside < len(speeds):
                continue
            good, bad = float(speeds[inside]), float(speeds[outside])
            for _ in range(HALVINGS):
                middle = 0.5 * (good + bad)
                good, bad = (good, middle) if math.isnan(self.work(middle)) else (middle, bad)
            kept.insert(at, good)
            own.insert(at, self.work(good))
        return np.array(kept), np.array(own)

    def _never(self, speeds: Array, works: Array, first: int) -> str:
        """Why the machine comes to no steady cycle."""
        scene, gains = self.machine.scene, works[first] > 0.0
        end = -1 if gains else 0
        comes = "goes faster and faster" if gains else "comes to rest"
        way = "gain" if gains else "lose"
        cure = (
            "a load that grows with the speed, or rows of its table up to there"
            if gains
            else "a torque that drives more than they take"
        )
        return (
            f"{scene.name}: no steady cycle: the loads {way} at every speed from "
            f"{speeds[first]:.4g} to {speeds[end]:.4g} rad/s of {scene.driver.link}, "
            f"{abs(works[first]):.4g} to {abs(works[end]):.4g} J a cycle, so that it {comes}; "
            f"give {cure}"
        )


def other_way(machine: TurningMachine) -> TurningMachine:
    """The machine turning to the other side."""
    return replace(machine, way=-machine.way)
