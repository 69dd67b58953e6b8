"""What friction costs: its power, and the efficiency at an instant and over a cycle."""

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from analytic.forces.kinetostatics import forces
from analytic.forces.virtual_power import reduced_machine
from analytic.kinematics import repeats_after, solve
from analytic.structure.mobility import analyse
from models.array import Array
from models.errors import CrankcheckError
from models.motion import Forces, Motion
from models.scene import GROUND, Scene
from models.scene.driver import driver_course
from models.scene.joints import block_name
from models.scene.laws import ConstantSpeed, Oscillating

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


def cycle_s(scene: Scene) -> float:
    """The time of a turn of the driver [s] (of two, where positions repeat after two only), or of a
    swing to and fro. Raises CrankcheckError for a law under which nothing repeats."""
    law = scene.driver.law
    if isinstance(law, ConstantSpeed):
        return repeats_after(scene) / abs(law.speed_rad_s)
    if isinstance(law, Oscillating):
        return law.period_s
    raise CrankcheckError(
        f"{scene.name}: its driver speeds up, so no cycle is like the next; give it the law "
        "constant or oscillating"
    )


def looks(scene: Scene, count: int) -> Array:
    """Instants over a cycle [s], none in the position at its start, which is often a dead point."""
    return np.asarray((np.arange(count) + 0.5) * (cycle_s(scene) / count))


SAMPLES = 720


@dataclass(frozen=True)
class Efficiency:
    """Over a cycle, (T,) each: the driver's angle ``theta`` [rad], the power that the drive puts in
    and that is lost in friction [W], and ``instantaneous``, the part of the power put in that goes
    on to loads and masses; NaN where none goes on.

    Work of the cycle [J]: ``put_in`` by the drive, ``useful`` done against the loads (those that
    help counted off), ``wasted`` in friction. NaN where friction locks in the cycle: ``locked``.
    """

    theta: Array
    power: Array
    lost: Array
    instantaneous: Array
    put_in: float
    useful: float
    wasted: float
    locked: tuple[LockedRange, ...]

    @property
    def cycle(self) -> float:
        """Useful work over the work put in; NaN where no useful work is done, as by a machine that
        its loads drive."""
        return self.useful / self.put_in if self.useful > 0.0 < self.put_in else float("nan")


@dataclass(frozen=True)
class PowerFlow:
    """At instants of a motion, (T,) each: the power that the drive puts in, what of it is lost in
    friction [W], and the part that goes on to loads and masses; NaN where none goes on."""

    put_in: Array
    lost: Array
    efficiency: Array


def power_flow(scene: Scene, motion: Motion, found: Forces) -> PowerFlow:
    """What the drive and friction do in a whole motion with these forces."""
    put_in = found.torque * driver_course(scene, motion)[1]
    watts = friction_power(scene, motion, found.friction).values()
    lost = sum((-each for each in watts), np.zeros_like(put_in))
    going_on = put_in - lost
    with np.errstate(divide="ignore", invalid="ignore"):
        part = np.where(going_on > 0.0, going_on / put_in, np.nan)
    return PowerFlow(put_in, lost, part)


def efficiency(scene: Scene, count: int = SAMPLES) -> Efficiency:
    """The efficiency of a machine at ``count`` instants of a cycle.

    Masses take power and give it back: over a cycle that is nothing, at an instant it counts as
    power that goes on. Loads over time are taken as they are in the first cycle.

    Raises CrankcheckError as `analytic.forces.kinetostatics.forces`, but for dead points and locked
    positions, and for a driver under whose law nothing repeats.
    """
    time_s, part_s = looks(scene, count), cycle_s(scene) / count
    motion = solve(scene, time_s, bound=False)
    found = forces(scene, time_s, bound=False, skip_dead_points=True)
    omega = driver_course(scene, motion)[1]
    flow = power_flow(scene, motion, found)
    against = -reduced_machine(scene, time_s).torque * omega  # weights do no work in a cycle
    works = [float(np.sum(each)) * part_s for each in (flow.put_in, against, flow.lost)]
    put_in, useful, wasted = works if np.isfinite(works).all() else [float("nan")] * 3
    theta, locked = driver_course(scene, motion)[0], self_locking(scene, count)
    parts = (flow.put_in, flow.lost, flow.efficiency)
    return Efficiency(theta, *parts, put_in, useful, wasted, locked)


def friction_power(scene: Scene, motion: Motion, friction: Mapping[str, Array]) -> dict[str, Array]:
    """The power of friction by joint [W], (T,), never positive.

    ``friction`` is that of the forces of the motion (`models.motion.Forces`).
    """
    turning = {name: link.omega for name, link in motion.links.items()}
    turning[GROUND] = np.zeros_like(motion.time_s)
    for slider in scene.sliders.values():
        if slider.link is None:
            turning[block_name(slider)] = turning[slider.on]
    pins, power = analyse(scene).pins, {}
    for joint, own in friction.items():
        if joint in scene.sliders:
            rate = motion.sliders[joint].speed
        else:
            first, second = pins[joint]
            rate = turning[second] - turning[first]
        power[joint] = own * rate
    return power
