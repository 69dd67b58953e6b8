"""Losses by friction: its power, and the efficiency at an instant and over a cycle."""

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
"""Samples of a cycle; anything shorter than one of its parts is missed."""
HALVINGS = 46


@dataclass(frozen=True)
class LockedRange:
    """Range of driver angles [rad] in which friction locks (``locks``), in the order of the motion,
    or may jam: there the load helps, and a second equilibrium of more friction is possible beside
    that of the given motion. ``end_rad`` may lie beyond the cycle that ``begin_rad`` is in."""

    begin_rad: float
    end_rad: float
    locks: bool

    @property
    def ends(self) -> str:
        """Text of its ends, for people."""
        return f"from {math.degrees(self.begin_rad):.6g} to {math.degrees(self.end_rad):.6g} deg"

    @property
    def words(self) -> str:
        """Text of the range, for people."""
        return f"locks itself {self.ends}" if self.locks else f"may jam {self.ends}"


def self_locking(scene: Scene, count: int = LOOKS) -> tuple[LockedRange, ...]:
    """Find the ranges of a cycle in which friction locks any drive, or the mechanism may jam.

    Parameters
    ----------
    scene : Scene
        The mechanism with loads or masses, friction, and a driver that repeats.
    count : int
        Samples of the cycle; the change between two that differ is found by bisection.

    Returns
    -------
    tuple of LockedRange
        None of them without Coulomb's friction.

    Raises
    ------
    CrankcheckError
        As `analytic.forces.kinetostatics.forces`, except dead points and locked positions; a
        driver law without a period.
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
    """Return the number of equilibria at each instant."""
    solution = forces(scene, time_s, bound=False, skip_dead_points=True).friction_solution
    assert solution is not None
    return solution.solutions


def _edges(scene: Scene, low: Array, high: Array, case: Array) -> Array:
    """Return the instants between ``low``, with that case, and ``high`` at which it ends."""
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        same = _solutions(scene, middle) == case
        low, high = np.where(same, middle, low), np.where(same, high, middle)
    return low


def _range(scene: Scene, between: tuple[float, float] | list[float], case: float) -> LockedRange:
    begin, end = scene.driver.law.at(np.array(between))[0]
    return LockedRange(float(begin), float(end), locks=bool(case == 0))


def cycle_s(scene: Scene) -> float:
    """Return the time of a turn of the driver [s] (of two, where positions repeat after two only),
    or of a swing to and fro. Raises CrankcheckError for a law without a period."""
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
    """Return instants over a cycle [s], none at its start, which is often a dead point."""
    return np.asarray((np.arange(count) + 0.5) * (cycle_s(scene) / count))


@dataclass(frozen=True)
class Efficiency:
    """Powers over a cycle, (T,) each: the driver's angle ``theta`` [rad], the ``power`` of the
    drive and the part ``lost`` in friction [W], and ``instantaneous``, the share of the drive's
    power that goes on to loads and masses; NaN where none goes on.

    Work of the cycle [J]: ``put_in`` by the drive, ``useful`` done against the loads (helping ones
    subtracted), ``wasted`` in friction. NaN where friction locks in the cycle: ``locked``.
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
        """Useful work over the drive's work; NaN without useful work, as if loads drive the
        machine."""
        return self.useful / self.put_in if self.useful > 0.0 < self.put_in else float("nan")


@dataclass(frozen=True)
class PowerFlow:
    """Powers at instants of a motion, (T,) each: of the drive, the part lost in friction [W], and
    the share that goes on to loads and masses; NaN where none goes on."""

    put_in: Array
    lost: Array
    efficiency: Array


def power_flow(scene: Scene, motion: Motion, found: Forces) -> PowerFlow:
    """Return the powers of the drive and of friction in a whole motion with these forces."""
    put_in = found.torque * driver_course(scene, motion)[1]
    watts = friction_power(scene, motion, found.friction).values()
    lost = sum((-each for each in watts), np.zeros_like(put_in))
    going_on = put_in - lost
    with np.errstate(divide="ignore", invalid="ignore"):
        part = np.where(going_on > 0.0, going_on / put_in, np.nan)
    return PowerFlow(put_in, lost, part)


def efficiency(scene: Scene, count: int = LOOKS) -> Efficiency:
    """Return the efficiency of a machine at ``count`` instants of a cycle.

    Masses take power and give it back: it is zero over a cycle, and counts at an instant as power
    that goes on. Loads over time count as in the first cycle.

    Raises CrankcheckError as `analytic.forces.kinetostatics.forces`, except dead points and locked
    positions, and for a driver law without a period.
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
    """Return the power of friction by joint [W], (T,), never positive.

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
