"""The free motion of a mechanism of one freedom, in the driver's angle, or the coordinate in its
place: a high-precision integration, and no closed form."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from analytic.forces.kinetostatics import forces
from analytic.free.coordinate_history import MOST, CoordinateHistory, Doubt, growth
from analytic.free.free_motion import IntegratedLaw, LimitPassage
from analytic.free.machine import Machine
from analytic.free.motion_along import motion_along, places_beside
from analytic.free.window import gauss, sums
from analytic.kinematics import solve_driven
from analytic.multibody.bodies import EnergyBalance
from models.array import Array, from_end, samples
from models.motion import Motion
from models.scene import Scene
from models.scene.driver import check_within


@dataclass(frozen=True, eq=False)
class MachineMotion:
    """What a scene of one freedom does (`FreeMotion`): ``history`` is the integration, and
    ``doubt`` what it may be off by."""

    scene: Scene
    until_s: float
    history: CoordinateHistory
    doubt: Doubt
    passages: tuple[LimitPassage, ...] = ()
    edges_s: tuple[float, ...] = ()

    @property
    def freedoms(self) -> int:
        return 1

    @property
    def by_dyads(self) -> bool:
        return True

    @property
    def driver_tells(self) -> bool:
        return self.history.windows[0].chart.limit is None

    @property
    def peak_speed_rad_s(self) -> float:
        """The largest angular velocity of the driver."""
        return float(np.abs(self._looks[1]).max())

    @property
    def range_rad(self) -> float:
        """How far the driver goes, from its smallest angle to its largest."""
        return float(np.ptp(self._looks[0]))

    @cached_property
    def law(self) -> IntegratedLaw:
        """The driver's motion as a law."""
        return IntegratedLaw(self._driver, 0.0, self.until_s, self.peak_speed_rad_s)

    def at(self, time_s: Array, *, bound: bool = True) -> Motion:
        """The motion at times [s], (T,), from 0 to ``until_s``; bounds hold what the integration
        may be off by as well. Raises CrankcheckError for times beyond."""
        instants = samples(time_s, "time_s")
        check_within(self.scene, instants, self.until_s)
        return motion_along(self.scene, self.history, self.doubt if bound else None, instants)

    def outside(self, time_s: Array, *, bound: bool = True) -> Motion:
        """As `FreeMotion.outside`; the third rate of the driver is taken as constant."""
        end_s, t, h = from_end(time_s, self.until_s)
        theta, omega, alpha = self._driver(end_s + np.array([0.0, h, 2.0 * h]))
        jerk = (4.0 * alpha[1] - 3.0 * alpha[0] - alpha[2]) / (2.0 * h)
        return solve_driven(
            self.scene,
            theta[0] + t * (omega[0] + t * (alpha[0] / 2.0 + t * jerk / 6.0)),
            omega[0] + t * (alpha[0] + t * jerk / 2.0),
            alpha[0] + t * jerk,
            time_s,
            bound=bound,
        )

    def with_forces(self, motion: Motion, *, bound: bool = True) -> Motion:
        load = forces(self.scene, motion, bound=bound, skip_dead_points=True)
        return replace(motion, forces=load)

    def beside(self, logged: Motion) -> Motion:
        """The reference, without rates and bounds, in the position that a run of this scene has at
        each of its instants, in the assembly that it is in: at the driver's angle that it logged,
        and near a limit of that at the angle or the displacement of what goes on through it."""
        return places_beside(self.scene, self.history, logged)

    def energy(self, time_s: Array) -> EnergyBalance:
        """The energies at times [s], (T,). Raises CrankcheckError for times beyond."""
        instants = samples(time_s, "time_s")
        check_within(self.scene, instants, self.until_s)
        return history_energy(self.scene, self.history, instants)

    def sensitivity(self, time_s: Array) -> Array:
        """G (T,): by how much a small change of the start has grown by then at most, at least 1.

        In the driver's angle: for a start that is off by an angle, per rad; or in its speed, per
        peak speed over the range that the driver goes through (a turn at most): changes that are
        the same part of the motion.
        """
        return np.interp(time_s, *self._growth)

    def error_rad(self, time_s: Array) -> Array:
        """What the driver's angle may be off by [rad], (T,)."""
        instants = samples(time_s, "time_s")
        u, off = self.history.state(instants)[0], self.doubt.at(instants)[0]
        error, window = np.zeros_like(u), self.history.windows_at(instants)
        for chart, first, last in self.history.legs():
            at = (window >= first) & (window < last)
            _, slope, bend = chart.driver(u[at])
            error[at] = (np.abs(slope) + 0.5 * np.abs(bend) * off[at]) * off[at]
        return error

    def _driver(self, time_s: Array) -> tuple[Array, Array, Array]:
        """Angle, rate and acceleration of the driver."""
        u, v, a = self.history.state(time_s)
        theta, omega, alpha = np.empty_like(u), np.empty_like(u), np.empty_like(u)
        window = self.history.windows_at(time_s)
        for chart, first, last in self.history.legs():
            at = (window >= first) & (window < last)
            phi, slope, bend = chart.driver(u[at])
            theta[at], omega[at] = phi, slope * v[at]
            alpha[at] = bend * v[at] ** 2 + slope * a[at]
        return theta, omega, alpha

    @cached_property
    def _looks(self) -> tuple[Array, Array, Array]:
        """The driver at instants that are close."""
        ends = np.append(self.history.starts_s, self.history.end_s)
        share = np.linspace(0.0, 1.0, 17)
        return self._driver((ends[:-1, None] + np.diff(ends)[:, None] * share).ravel())

    @cached_property
    def _growth(self) -> tuple[Array, Array]:
        reach = min(2.0 * np.pi, self.range_rad)
        return growth(self.history, self.peak_speed_rad_s / reach if reach > 0.0 else 0.0)


def history_energy(scene: Scene, history: CoordinateHistory, time_s: Array) -> EnergyBalance:
    """The energies of an integrated motion at times [s], (T,)."""
    u, v, _ = history.state(time_s)
    window = history.windows_at(time_s)
    series, before = _work(scene, history)
    share = (time_s - history.starts_s[window]) / np.array([w.long_s for w in history.windows])[
        window
    ]
    work = before[window] + sums(series[window], np.clip(share, 0.0, MOST))
    kinetic, potential = np.empty_like(u), np.empty_like(u)
    for chart, first, last in history.legs():
        at = (window >= first) & (window < last)
        if at.any():
            machine = Machine(scene, chart)
            wound = history.wound_at(window[at])
            kinetic[at] = machine.kinetic(u[at], v[at])
            potential[at] = machine.potential(u[at], wound)
    return EnergyBalance(kinetic, potential, np.asarray(work))


def _work(scene: Scene, history: CoordinateHistory) -> tuple[Array, Array]:
    """The series of the work in each window, and the work before it [J]."""
    n = history.windows[0].swing.shape[1]
    rule = gauss(n)
    long_s = np.array([window.long_s for window in history.windows])
    power = np.empty((len(long_s), n))
    for chart, first, last in history.legs():
        times = history.starts_s[first:last, None] + long_s[first:last, None] * rule.places
        numbers = np.repeat(np.arange(first, last), n)
        share = np.tile(rule.places, last - first)
        u, v, _ = history.at(numbers, share)
        power[first:last] = Machine(scene, chart).power(times.ravel(), u, v).reshape(-1, n)
    series = power @ rule.series.T @ rule.lift_once.T * long_s[:, None]
    lasts_s = np.array([window.end_s for window in history.windows]) - history.starts_s
    gained = sums(series, lasts_s / long_s)
    return series, np.concatenate([[0.0], np.cumsum(gained)[:-1]])
