"""Cycle that a machine repeats: its search, its speed over the angle, its works by source.

Source: problem book "Bai tap co hoc may", chapter on real motion and its regulation;
I. I. Artobolevskii, Theory of Mechanisms, on the regulation of periodic fluctuations.

A scene whose driver is driven at constant speed runs with that mean speed: its drive is taken as a
constant torque, which closes the balance of work. A free machine has its loads alone: loads that
follow the speed settle it, else they have to balance, and the speed of its start is the mean one.
"""

import math
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache

import numpy as np

from analytic.lectures.regulation.angle_cells import AngleCells, breaks, rated_breaks
from analytic.lectures.regulation.periodic_solution import (
    PeriodicSolution,
    WantedSpeed,
    repeated,
    resolved,
)
from analytic.lectures.regulation.turning_machine import TurningMachine
from models.array import Array
from models.errors import CrankcheckError
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
        high, low = self.heights(0.0)
        return high - low

    def heights(self, slope: float) -> tuple[float, float]:
        """Return the largest and the smallest W - slope J [J]: work since the start, less ``slope``
        [J/(kg m^2)] times the moment of inertia without the added flywheel. They are where its
        derivative is 0, or jumps through it."""
        solution, machine = self.solution, self.machine

        def height(u: Array) -> Array:
            work = solution.energy_at(u) - solution.at_borders[0]
            return np.asarray(work - slope * machine.inertia(u)[0])

        def rise(u: Array) -> Array:
            torque = machine.torque(u, solution.speed_at(u)) + solution.drive
            return np.asarray(torque - slope * machine.inertia(u)[1])

        high, low = height(np.array(_extremes(solution, height, rise)))
        return float(high), float(low)

    @cached_property
    def own_inertia_range(self) -> tuple[float, float]:
        """Smallest and largest reduced moment of inertia without the added flywheel [kg m^2]."""
        inertia = self.machine.inertia
        places = _extremes(self.solution, lambda u: inertia(u)[0], lambda u: inertia(u)[1])
        most, least = inertia(np.array(places))[0]
        return float(least), float(most)

    @property
    def inertia_range(self) -> tuple[float, float]:
        """Smallest and largest reduced moment of inertia, with flywheels [kg m^2]."""
        least, most = self.own_inertia_range
        return least + self.solution.flywheel, most + self.solution.flywheel

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


SLOWEST, FASTEST, SPEEDS = 1e-3, 1e5, 81
"""Scanned speeds [rad/s]; a factor of 1.26 lies between two of them."""
HALVINGS = 60


@lru_cache(maxsize=16)
def settled_speed(machine: TurningMachine) -> float:
    """Return the speed at which the work of a cycle is 0, from the speed of a machine's start
    [rad/s]. Raises CrankcheckError as `MeanBalance.settled`."""
    start = abs(float(machine.scene.driver.law.at(np.zeros(1))[1][0]))
    return MeanBalance(machine, AngleCells.of(machine.cycle_rad, breaks(machine))).settled(start)


class MeanBalance:
    """Work of all torques over a cycle [J], with the driver at constant speed."""

    def __init__(self, machine: TurningMachine, cells: AngleCells) -> None:
        self.machine, self.cells = machine, cells
        self.steady = cells.integral(machine.steady_torque(cells.nodes))

    def work(self, speed: float) -> float:
        """Return the work at a speed [rad/s]; NaN where a table of a load does not reach as far."""
        nodes = self.cells.nodes
        try:
            rated = self.machine.rated_torque(nodes, np.full_like(nodes, speed))
        except CrankcheckError:
            return math.nan
        return self.steady + self.cells.integral(rated)

    def settled(self, start: float) -> float:
        """Return the speed at which the work is 0, from the machine's start [rad/s]: upwards where
        it gains there, downwards where it loses. Raises CrankcheckError where there is none, or for
        a table that does not reach its start."""
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
        """Return the speeds that all tables reach, as far as they do."""
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


CLOSED = 1e-6
"""Allowed imbalance of loads alone in a cycle, over the driving work: tables have six digits. A
constant torque makes it up."""
ROUNDS = 6
"""Most searches for the places of the extremes."""
ZOOMS, PARTS = 7, 64
"""Divisions of an interval of nodes for them, and parts of each: to rounding, as a speed has a
corner where a torque jumps."""
STILL = 1e-11
"""Fluctuation below which it is rounding."""


def steady_cycle(machine: TurningMachine, flywheel_kg_m2: float = 0.0) -> SteadyCycle:
    """Find the cycle that a machine repeats with an added flywheel on its driver. Raises StallError
    where its masses hold too little energy to carry it round; CrankcheckError for loads that do not
    balance at any speed, or have tables that end before."""
    cells = AngleCells.of(machine.cycle_rad, breaks(machine))
    scene = machine.scene
    law_speed = abs(float(scene.driver.law.at(np.zeros(1))[1][0]))
    if scene.is_free and machine.is_rated:
        wanted = WantedSpeed(None)
        speed = settled_speed(machine)
    elif law_speed == 0.0:
        raise CrankcheckError(
            f"{scene.name}: no load follows the speed, and it starts from rest: any speed would "
            "do, and it has no cycle of its own; give the mean one as speed_rad_s in [driver], or "
            "a load over the speed, such as that of a motor"
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
    """Return the solution with the mean speed right to rounding, and the places of its largest and
    smallest speed."""
    mean = wanted.mean_rad_s
    for _ in range(ROUNDS):
        if mean is None:
            break
        now = SteadyCycle(solution, *_extreme_speeds(solution))
        if abs(now.mean_rad_s / mean - 1.0) <= 1e-14:
            return now
        wanted = WantedSpeed(mean, (now.fastest, now.slowest))
        solution = repeated(solution.machine, solution.cells, solution.flywheel, solution, wanted)
    return SteadyCycle(solution, *_extreme_speeds(solution))


def _extreme_speeds(solution: PeriodicSolution) -> tuple[float, float]:
    """Return the angles u at which the speed is largest and smallest."""
    return _extremes(solution, solution.speed_at, lambda u: _pull(solution, u))


def _extremes(
    solution: PeriodicSolution, of: Callable[[Array], Array], rise: Callable[[Array], Array]
) -> tuple[float, float]:
    """Return the angles u at which a quantity of the cycle is largest and smallest; ``rise`` has
    the sign of its derivative. All peaks between nodes are followed, as samples of two that are
    nearly alike do not tell the higher one."""
    u = np.sort(np.concatenate([solution.cells.borders, solution.cells.nodes.ravel()]))
    sizes = of(u)
    if np.ptp(sizes) <= STILL * np.abs(sizes).max():
        return 0.0, 0.0
    found = []
    for sign in (1.0, -1.0):
        own = sign * sizes
        beside = np.concatenate([[-np.inf], own, [-np.inf]])
        peaks = np.flatnonzero((own >= beside[:-2]) & (own >= beside[2:]))
        low, high = u[np.maximum(peaks - 1, 0)], u[np.minimum(peaks + 1, len(u) - 1)]
        for _ in range(ZOOMS):
            parts = np.linspace(low, high, PARTS + 1, axis=1)
            rising = rise(parts[:, 1:-1].ravel()).reshape(len(peaks), -1) * sign > 0.0
            k = np.cumprod(rising, axis=1).sum(axis=1)[:, None]  # the first part that ends falling
            low, high = (np.take_along_axis(parts, k + end, axis=1)[:, 0] for end in (0, 1))
        places = np.concatenate([0.5 * (low + high), u[peaks]])
        heights = sign * of(places)
        first, best = int(np.argmax(own[peaks])), int(np.argmax(heights))
        even = heights[first] >= heights[best] - STILL * np.ptp(sizes)  # twins keep their order
        found.append(float(places[first if even else best]))
    return found[0], found[1]


def _pull(solution: PeriodicSolution, u: Array) -> Array:
    """Return J w dw/du: the torque that changes the speed [N m]."""
    inertia, slope = solution.machine.inertia(u)
    speed = np.sqrt(2.0 * solution.energy_at(u) / (inertia + solution.flywheel))
    torque = solution.machine.torque(u, speed) + solution.drive
    return np.asarray(torque - 0.5 * slope * speed**2)


def _check_closed(solution: PeriodicSolution) -> None:
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
    """Return the steady cycle; a machine at rest starts to the side that its loads drive it to.
    Raises as `steady_cycle`."""
    try:
        return steady_cycle(machine)
    except CrankcheckError:
        if machine.scene.driver.law.at(np.zeros(1))[1][0] != 0.0:
            raise
        with suppress(CrankcheckError):
            return steady_cycle(replace(machine, way=-machine.way))
        raise
