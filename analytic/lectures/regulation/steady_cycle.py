"""Cycle that a machine repeats: its speed over the angle, its evenness, its works by source.

Source: problem book "Bai tap co hoc may", chapter on real motion and its regulation;
I. I. Artobolevskii, Theory of Mechanisms, on the regulation of periodic fluctuations.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from analytic.lectures.regulation.periodic_solution import PeriodicSolution
from analytic.lectures.regulation.turning_machine import TurningMachine
from models.array import Array
from models.scene import Driver, Scene
from models.scene.characteristics import Constant
from models.scene.driver import Released
from models.scene.loads import Load

NO_WORK = 1e-12
"""Work of the cycle over the turnover, below which it is rounding."""
SAMPLES = 720
"""Samples of a turn."""


@dataclass(frozen=True)
class SteadyCycle:
    """Machine over the cycle that it repeats. ``fastest`` and ``slowest`` are the angles u turned
    since the start at which the speed is largest and smallest [rad]. Torques count along the
    motion: positive ones drive."""

    solution: PeriodicSolution
    fastest: float
    slowest: float

    @property
    def machine(self) -> TurningMachine:
        return self.solution.machine

    @cached_property
    def turnover_j(self) -> float:
        """Work of all torques over the cycle, whatever its sign: the scale of rounding."""
        return self.solution.cells.integral(np.abs(self.solution.torque))

    @cached_property
    def drive_n_m(self) -> float:
        """Constant torque of the drive, along the motion; 0 for a free machine."""
        return self._clean(self.solution.drive * self.machine.cycle_rad) / self.machine.cycle_rad

    def _clean(self, work: float) -> float:
        """Return a work of the cycle [J], 0 where it is rounding."""
        return work if abs(work) > NO_WORK * self.turnover_j else 0.0

    @cached_property
    def extreme_speeds_rad_s(self) -> tuple[float, float]:
        """Largest and smallest speed of the driver."""
        high, low = self.solution.speed_at(np.array([self.fastest, self.slowest]))
        return float(high), float(low)

    @property
    def mean_rad_s(self) -> float:
        """Half the sum of the largest and the smallest speed."""
        return 0.5 * sum(self.extreme_speeds_rad_s)

    @property
    def delta(self) -> float:
        """Coefficient of fluctuation, (w_max - w_min) / mean."""
        high, low = self.extreme_speeds_rad_s
        return (high - low) / self.mean_rad_s

    @cached_property
    def period_s(self) -> float:
        """Time of a cycle."""
        return self.solution.cells.integral(1.0 / self.solution.speed)

    @property
    def time_mean_rad_s(self) -> float:
        """Angle of a cycle over its time."""
        return self.machine.cycle_rad / self.period_s

    @property
    def settling(self) -> float:
        """Growth of a change of the energy at the start in a cycle: below 1 it dies away; 1 where
        no torque follows the speed."""
        return self.solution.gain

    @cached_property
    def works_j(self) -> Mapping[str, float]:
        """Work of a cycle by source: each load, spring and friction by its key in the file,
        weights, and the drive."""
        cells, speed = self.solution.cells, self.solution.speed
        torques = self.machine.torques_by_source(cells.nodes, speed)
        works = {n: self._clean(cells.integral(torque)) for n, torque in torques.items()}
        if self.drive_n_m:
            works["drive"] = self.drive_n_m * self.machine.cycle_rad
        return works

    @property
    def work_j(self) -> float:
        """Driving work in a cycle: the sum of the positive works."""
        return sum(work for work in self.works_j.values() if work > 0.0)

    @property
    def power_w(self) -> float:
        """Mean power of the driving work."""
        return self.work_j / self.period_s

    @cached_property
    def surplus_j(self) -> float:
        """Surplus of work: the largest work since the start less the smallest."""
        work = self.energy(
            self.solution.cells.borders, self.solution.cells.nodes.ravel(), self.fine
        )
        return float(np.ptp(work))

    @cached_property
    def inertia_range(self) -> tuple[float, float]:
        """Smallest and largest reduced moment of inertia, with flywheels [kg m^2]."""
        own = self.solution.inertia_at(self.fine)
        return float(own.min()), float(own.max())

    @cached_property
    def fine(self) -> Array:
        """Angles u over the cycle [rad], both ends included."""
        count = SAMPLES * max(1, round(self.machine.cycle_rad / (2.0 * np.pi)))
        return np.linspace(0.0, self.machine.cycle_rad, count + 1)

    def energy(self, *angles: Array) -> Array:
        """Return the kinetic energy at angles u [J]."""
        return self.solution.energy_at(np.concatenate(angles))

    def time_s(self, u: Array) -> Array:
        """Return the times at which the driver has turned by angles u."""
        return self.solution.cells.integrated(1.0 / self.solution.speed, u)

    def driver_rad(self, u: float) -> float:
        """Return the driver's own angle, in [0, 2 pi) of the first turn, on into the next ones."""
        theta = float(self.machine.theta(np.array(u)))
        return float(np.mod(theta, self.machine.cycle_rad))


DRIVE = "drive"


def with_flywheel(scene: Scene, inertia_kg_m2: float) -> Scene:
    """Return the scene with an added flywheel on its driver."""
    link = scene.links[scene.driver.link]
    heavier = replace(link, inertia_kg_m2=link.inertia_kg_m2 + inertia_kg_m2)
    return replace(scene, links={**scene.links, link.name: heavier})


def cycle_scene(cycle: SteadyCycle, cycles: float = 5.0, *, flywheel: bool = True) -> Scene:
    """Return the scene of a cycle, with its flywheel by default, released at its start with the
    cycle's speed, for so many cycles; the drive's torque is a load."""
    machine = cycle.machine
    scene = with_flywheel(machine.scene, cycle.solution.flywheel) if flywheel else machine.scene
    start = machine.way * float(cycle.solution.speed_at(np.zeros(1))[0])
    law = Released(machine.start_rad, start, cycles * cycle.period_s)
    loads = dict(scene.loads)
    if cycle.drive_n_m:
        name = DRIVE if DRIVE not in loads else f"{DRIVE}-of-the-cycle"
        torque = Constant(machine.way * cycle.drive_n_m)
        loads[name] = Load(name, scene.driver.link, None, torque)
    return replace(scene, driver=Driver(scene.driver.link, law), loads=loads)
