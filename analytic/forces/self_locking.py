"""Self-locking: where in its cycle friction holds a mechanism against any torque of its drive."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from analytic.forces.cycle_time import cycle_s, looks
from analytic.forces.kinetostatics import forces
from models.array import Array
from models.scene import Scene

LOOKS = 720
"""Looks at a cycle; what is shorter than one of its parts is missed."""
HALVINGS = 46


@dataclass(frozen=True)
class LockedRange:
    """Driver angles [rad] between which friction locks (``locks``), in the order of the motion, or
    may jam: there the load helps, and beside the motion that is given another equilibrium, of more
    friction, is as good. ``end_rad`` may lie beyond the cycle that ``begin_rad`` is in."""

    begin_rad: float
    end_rad: float
    locks: bool

    @property
    def ends(self) -> str:
        """From where to where, for people."""
        return f"from {math.degrees(self.begin_rad):.6g} to {math.degrees(self.end_rad):.6g} deg"

    @property
    def words(self) -> str:
        """For people."""
        return f"locks itself {self.ends}" if self.locks else f"may jam {self.ends}"


def self_locking(scene: Scene, count: int = LOOKS) -> tuple[LockedRange, ...]:
    """Where in a cycle no finite torque keeps the mechanism moving, or it may jam.

    Parameters
    ----------
    scene : Scene
        The mechanism with loads or masses, friction, and a driver that repeats.
    count : int
        Looks at the cycle; between two that differ the angle is halved in upon.

    Returns
    -------
    tuple of LockedRange
        None of them without Coulomb's friction.

    Raises
    ------
    CrankcheckError
        As `analytic.forces.kinetostatics.forces`, but for dead points and locked positions; a
        driver under whose law nothing repeats.
    """
    if not scene.coulomb_joints:
        return ()
    cycle, instants = cycle_s(scene), looks(scene, count)
    cases = _solutions(scene, instants)
    after = np.append(instants[1:], instants[0] + cycle)
    changes = np.flatnonzero(cases != np.roll(cases, -1))
    if not len(changes):
        return () if cases[0] == 1 else (_range(scene, (0.0, cycle), cases[0]),)
    edges = _edges(scene, instants[changes], after[changes], cases[changes])
    ends = np.append(edges[1:], edges[0] + cycle)
    behind = np.roll(cases, -1)[changes]
    return tuple(
        _range(scene, between, case)
        for *between, case in zip(edges, ends, behind, strict=True)
        if case != 1
    )


def _solutions(scene: Scene, time_s: Array) -> Array:
    """How many equilibria there are, at each instant."""
    solution = forces(scene, time_s, bound=False, skip_dead_points=True).friction_solution
    assert solution is not None
    return solution.solutions


def _edges(scene: Scene, low: Array, high: Array, case: Array) -> Array:
    """The instants between ``low``, with that case, and ``high`` at which it ends."""
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        same = _solutions(scene, middle) == case
        low, high = np.where(same, middle, low), np.where(same, high, middle)
    return low


def _range(scene: Scene, between: tuple[float, float] | list[float], case: float) -> LockedRange:
    begin, end = scene.driver.law.at(np.array(between))[0]
    return LockedRange(float(begin), float(end), locks=bool(case == 0))
