"""The cycle that a machine repeats: how fast it is where, how evenly it runs, what does the work.

A scene whose driver is driven at constant speed runs with that mean speed: its drive is taken as a
constant torque, which closes the balance of work. One that is let go has its loads alone: where one
of them follows the speed they settle it, else they have to balance, and the speed of its start is
the mean one.

Source: problem book "Bai tap co hoc may", chapter on real motion and its regulation;
I. I. Artobolevskii, Theory of Mechanisms, on the regulation of periodic fluctuations.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from analytic.regulation.angle_cells import AngleCells
from analytic.regulation.mean_balance import other_way, settled_speed
from analytic.regulation.narrow_cells import resolved
from analytic.regulation.periodic_solution import PeriodicSolution, WantedSpeed, repeated
from analytic.regulation.turning_machine import TurningMachine
from analytic.regulation.unsmooth import breaks, rated_breaks
from models.array import Array
from models.errors import CrankcheckError

CLOSED = 1e-6
"""The work that loads alone may be short of in a cycle, over what drives: tables have six digits.
It is made up by a constant torque."""
ROUNDS = 6
"""Searches for the places of the extremes."""
ROUGHLY, CLOSELY = 18, 40
"""Halvings of an interval of nodes for them: speeds do not change there to first order."""
NO_WORK = 1e-12
"""A work of the cycle below this, over all that is turned over in it, is rounding."""
STILL = 1e-11
"""A fluctuation below this is rounding."""
SAMPLES = 720
"""Of a turn."""


@dataclass(frozen=True)
class SteadyCycle:
    """A machine over the cycle that it repeats.

    ``fastest`` and ``slowest`` are the angles u turned since the start at which the speed is
    largest and smallest [rad]. Torques count along the motion: what is positive drives.
    """

    solution: PeriodicSolution
    fastest: float
    slowest: float

    @property
    def machine(self) -> TurningMachine:
        return self.solution.machine

    @cached_property
    def turnover_j(self) -> float:
        """The work of all torques over the cycle, whatever its sign: what rounding is measured
        by."""
        return self.solution.cells.integral(np.abs(self.solution.torque))

    @cached_property
    def drive_n_m(self) -> float:
        """The constant torque of the drive, along the motion; 0 of a machine that is let go."""
        return self._clean(self.solution.drive * self.machine.cycle_rad) / self.machine.cycle_rad

    def _clean(self, work: float) -> float:
        """A work of the cycle [J], 0 where it is rounding."""
        return work if abs(work) > NO_WORK * self.turnover_j else 0.0

    @cached_property
    def extreme_speeds_rad_s(self) -> tuple[float, float]:
        """The largest and the smallest speed of the driver."""
        high, low = self.solution.speed_at(np.array([self.fastest, self.slowest]))
        return float(high), float(low)

    @property
    def mean_rad_s(self) -> float:
        """Half the sum of the largest and the smallest speed."""
        return 0.5 * sum(self.extreme_speeds_rad_s)

    @property
    def delta(self) -> float:
        """The coefficient of fluctuation, (w_max - w_min) / mean."""
        high, low = self.extreme_speeds_rad_s
        return (high - low) / self.mean_rad_s

    @cached_property
    def period_s(self) -> float:
        """How long a cycle takes."""
        return self.solution.cells.integral(1.0 / self.solution.speed)

    @property
    def time_mean_rad_s(self) -> float:
        """The angle of a cycle over its time."""
        return self.machine.cycle_rad / self.period_s

    @property
    def settling(self) -> float:
        """What a change of the energy at the start becomes in a cycle: below 1 it dies away; 1
        where no torque follows the speed."""
        return self.solution.gain

    @cached_property
    def works_j(self) -> Mapping[str, float]:
        """The work of a cycle by what does it: each load, spring and friction by its key in the
        file, weights, and the drive."""
        cells, speed = self.solution.cells, self.solution.speed
        torques = self.machine.torques_by_source(cells.nodes, speed)
        works = {n: self._clean(cells.integral(torque)) for n, torque in torques.items()}
        if self.drive_n_m:
            works["drive"] = self.drive_n_m * self.machine.cycle_rad
        return works

    @property
    def work_j(self) -> float:
        """What drives in a cycle: the sum of the works that are positive."""
        return sum(work for work in self.works_j.values() if work > 0.0)

    @property
    def power_w(self) -> float:
        """The mean power of what drives."""
        return self.work_j / self.period_s

    @cached_property
    def surplus_j(self) -> float:
        """The surplus of work: by how much the work since the start is larger where it is largest
        than where it is smallest."""
        work = self.energy(
            self.solution.cells.borders, self.solution.cells.nodes.ravel(), self.fine
        )
        return float(np.ptp(work))

    @cached_property
    def inertia_range(self) -> tuple[float, float]:
        """The smallest and the largest reduced moment of inertia, with flywheels [kg m^2]."""
        own = self.solution.inertia_at(self.fine)
        return float(own.min()), float(own.max())

    @cached_property
    def fine(self) -> Array:
        """Angles u over the cycle [rad], both ends included."""
        count = SAMPLES * max(1, round(self.machine.cycle_rad / (2.0 * np.pi)))
        return np.linspace(0.0, self.machine.cycle_rad, count + 1)

    def energy(self, *angles: Array) -> Array:
        """The kinetic energy at angles u [J]."""
        return self.solution.energy_at(np.concatenate(angles))

    def time_s(self, u: Array) -> Array:
        """When the driver has turned by angles u."""
        return self.solution.cells.integrated(1.0 / self.solution.speed, u)

    def driver_rad(self, u: float) -> float:
        """The driver's own angle, in [0, 2 pi) of the first turn, on into the next ones."""
        theta = float(self.machine.theta(np.array(u)))
        return float(np.mod(theta, self.machine.cycle_rad))


def steady_cycle(machine: TurningMachine, flywheel_kg_m2: float = 0.0) -> SteadyCycle:
    """The cycle that a machine repeats with a flywheel more on its driver.

    Raises
    ------
    StallError
        Its masses hold too little energy to carry it round.
    CrankcheckError
        Loads that do not balance at any speed, or have tables that end before.
    """
    cells = AngleCells.of(machine.cycle_rad, breaks(machine))
    scene = machine.scene
    law_speed = abs(float(scene.driver.law.at(np.zeros(1))[1][0]))
    if scene.is_free and machine.is_rated:
        wanted = WantedSpeed(None)
        speed = settled_speed(machine)
    elif law_speed == 0.0:
        raise CrankcheckError(
            f"{scene.name}: no load follows the speed, and it starts from rest: any speed would "
            "do; give speed_rad_s, the mean one"
        )
    else:
        wanted, speed = WantedSpeed(law_speed), law_speed
    solution = repeated(machine, cells, flywheel_kg_m2, speed, wanted)
    if scene.is_free:
        _check_closed(solution)
    if machine.is_rated:
        # Rows of tables over the speed are passed somewhere on the way: cut there.
        more = rated_breaks(machine, solution.speed_at)
        cells = AngleCells.of(machine.cycle_rad, np.concatenate([cells.borders, more]))
        solution = repeated(machine, cells, flywheel_kg_m2, solution, wanted)
    return _with_extremes(resolved(solution, wanted), wanted)


def _with_extremes(solution: PeriodicSolution, wanted: WantedSpeed) -> SteadyCycle:
    """The solution whose mean speed is right to rounding, and where its speed is largest and
    smallest."""
    mean = wanted.mean_rad_s
    for _ in range(ROUNDS):
        if mean is None:
            break
        rough = SteadyCycle(solution, *_extremes(solution, ROUGHLY))
        if abs(rough.mean_rad_s / mean - 1.0) <= 1e-14:
            break
        wanted = WantedSpeed(mean, (rough.fastest, rough.slowest))
        solution = repeated(solution.machine, solution.cells, solution.flywheel, solution, wanted)
    return SteadyCycle(solution, *_extremes(solution, CLOSELY))


def _extremes(solution: PeriodicSolution, halvings: int) -> tuple[float, float]:
    """The angles u at which the speed is largest and smallest, where its slope is 0."""
    u = np.sort(np.concatenate([solution.cells.borders, solution.cells.nodes.ravel()]))
    speed = solution.speed_at(u)
    if np.ptp(speed) <= STILL * speed.max():
        return 0.0, 0.0
    at = np.array([np.argmax(speed), np.argmin(speed)])
    low, high = u[np.maximum(at - 1, 0)], u[np.minimum(at + 1, len(u) - 1)]
    signs = np.array([1.0, -1.0])
    for _ in range(halvings):
        middle = 0.5 * (low + high)
        rising = _pull(solution, middle) * signs > 0.0
        low, high = np.where(rising, middle, low), np.where(rising, high, middle)
    best = 0.5 * (low + high)
    return float(best[0]), float(best[1])


def _pull(solution: PeriodicSolution, u: Array) -> Array:
    """J w dw/du: what the torques leave for a change of the speed [N m]."""
    inertia, slope = solution.machine.inertia(u)
    speed = np.sqrt(2.0 * solution.energy_at(u) / (inertia + solution.flywheel))
    torque = solution.machine.torque(u, speed) + solution.drive
    return np.asarray(torque - 0.5 * slope * speed**2)


def _check_closed(solution: PeriodicSolution) -> None:
    """Refuse loads that follow no speed and do not balance over the cycle."""
    machine = solution.machine
    whole = machine.cycle_rad
    put_in = solution.cells.integral(np.maximum(solution.torque, 0.0))
    short = solution.drive * whole
    if abs(short) > CLOSED * put_in:
        scene = machine.scene
        way = "lose" if short > 0.0 else "gain"
        raise CrankcheckError(
            f"{scene.name}: no steady cycle: over {np.degrees(whole):.6g} deg its loads {way} "
            f"{abs(short):.6g} J at any speed; add a torque on {scene.driver.link} of "
            f"{machine.way * solution.drive:.12g} N m, or a load that follows the speed"
        )


def cycle_of(machine: TurningMachine) -> SteadyCycle:
    """The steady cycle, of a machine that starts from rest to the side that its loads drive it to.
    Raises as `steady_cycle`."""
    try:
        return steady_cycle(machine)
    except CrankcheckError:
        if machine.scene.driver.law.at(np.zeros(1))[1][0] != 0.0:
            raise
        try:
            return steady_cycle(other_way(machine))
        except CrankcheckError:
            pass
        raise
