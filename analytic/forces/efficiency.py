"""What friction costs: its power, and the efficiency at an instant and over a cycle."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from analytic.forces.cycle_time import cycle_s, looks
from analytic.forces.kinetostatics import forces
from analytic.forces.reduced_machine import reduced_machine
from analytic.forces.self_locking import LockedRange, self_locking
from analytic.kinematics import solve
from analytic.structure.mobility import analyse
from models.array import Array
from models.driver_course import driver_course
from models.forces import Forces
from models.joints import block_name
from models.motion import Motion
from models.scene import GROUND, Scene

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

    ``friction`` is that of the forces of the motion (`models.forces.Forces`).
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
