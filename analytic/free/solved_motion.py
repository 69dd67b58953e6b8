"""Solved free motions: of one freedom in its driver's angle, or the coordinate in its place; of
several, or without a closed form, by the equations of motion of all bodies."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from analytic.dyads.plane import EPS
from analytic.forces.kinetostatics import forces
from analytic.free.coordinate_history import MOST, CoordinateHistory, Doubt, growth
from analytic.free.free_motion import IntegratedLaw, LimitPassage
from analytic.free.machine import Machine
from analytic.free.motion_along import motion_along, places_beside
from analytic.free.window import gauss, sums
from analytic.kinematics import solve_driven
from analytic.multibody.as_motion import as_motion, logged_places
from analytic.multibody.bodies import EnergyBalance
from analytic.multibody.multibody_motion import MultibodyMotion, Projection
from models.array import Array, from_end, samples
from models.motion import Bound, LinkMotion, Motion, PointMotion, SliderMotion
from models.scene import Scene
from models.scene.driver import check_within

COARSER = Projection(1e-12)
"""Method of the compared integration: it has larger errors, so that the difference is its own."""
SAFETY = 4.0
"""Ratio of the error bound to the largest difference so far."""
LOOKS = 801
"""Number of instants at which both are compared."""

OPEN = (
    "how redundant joints share the load depends on the stiffness and fit of links: the equations "
    "of motion leave the reactions open"
)

BodyMotion = TypeVar("BodyMotion", LinkMotion, PointMotion, SliderMotion)


@dataclass(frozen=True, eq=False)
class BodiesMotion(MultibodyMotion):
    """Motion of all bodies of a scene (`FreeMotion`), integrated at once.

    No coordinate is special: `sensitivity` is that of all coordinates, `error_rad` that of the
    worst link. Bounds are estimates from a second integration.
    """

    @property
    def passages(self) -> tuple[LimitPassage, ...]:
        """None: where a link turns back, no other coordinate has to replace it."""
        return ()

    @property
    def freedoms(self) -> int:
        return self.dynamics.assembly.size - self.dynamics.rank

    @property
    def by_dyads(self) -> bool:
        return False

    @property
    def driver_tells(self) -> bool:
        return False

    @property
    def peak_speed_rad_s(self) -> float:
        return max(float(np.abs(one.omega).max()) for one in self._looks[1].links.values())

    @property
    def range_rad(self) -> float:
        return float(np.ptp(self._looks[1].links[self.scene.driver.link].theta))

    @cached_property
    def law(self) -> IntegratedLaw:
        return IntegratedLaw(self._driver, 0.0, self.until_s, self.peak_speed_rad_s)

    def at(self, time_s: Array, *, bound: bool = True) -> Motion:
        motion = replace(super().at(time_s), forces=None)
        return replace(motion, bound=self._bound(time_s)) if bound else motion

    def outside(self, time_s: Array, *, bound: bool = True) -> Motion:
        motion = super().outside(time_s)
        return replace(motion, bound=self._bound(time_s)) if bound else motion

    def with_forces(self, motion: Motion, *, bound: bool = True) -> Motion:
        """Return the motion with reactions without bounds; without reactions for redundant
        joints."""
        del bound
        acting = super().at(motion.time_s).forces
        assert acting is not None
        if self.dynamics.redundant:
            acting = replace(acting, pins={}, sliders={}, undetermined=OPEN)
        return replace(motion, forces=acting)

    def beside(self, logged: Motion) -> Motion:
        assembly = self.dynamics.assembly
        q = logged_places(assembly, logged, self.freedoms)
        return as_motion(assembly, logged.time_s, assembly.at_rest(q), np.zeros_like(q))

    def error_rad(self, time_s: Array) -> Array:
        links = self._bound(samples(time_s, "time_s")).links.values()
        return np.asarray(np.max([one.theta for one in links], axis=0))

    def _driver(self, time_s: Array) -> tuple[Array, Array, Array]:
        one = super().at(time_s).links[self.scene.driver.link]
        return one.theta, one.omega, one.alpha

    @cached_property
    def _looks(self) -> tuple[Array, Motion]:
        """Instants, and the motion then."""
        time_s = np.linspace(0.0, self.until_s, LOOKS)
        return time_s, super().at(time_s)

    @cached_property
    def _doubt(self) -> Bound:
        """Errors of all bodies until each of these instants."""
        time_s, motion = self._looks
        other = replace(self, method=COARSER).at(time_s, bound=False)
        return Bound(
            _apart(motion.links, other.links),
            _apart(motion.points, other.points),
            _apart(motion.sliders, other.sliders),
        )

    def _bound(self, time_s: Array) -> Bound:
        # The next sample holds the differences up to it.
        k = np.clip(np.searchsorted(self._looks[0], time_s), 0, LOOKS - 1)
        doubt = self._doubt
        return Bound(_some(doubt.links, k), _some(doubt.points, k), _some(doubt.sliders, k))


def _apart(
    own: Mapping[str, BodyMotion], others: Mapping[str, BodyMotion]
) -> dict[str, BodyMotion]:
    """Return the largest distances of bodies of two motions until each instant, with room."""
    return {
        name: type(body)(*map(_room, vars(body).values(), vars(others[name]).values()))
        for name, body in own.items()
    }


def _room(own: Array, other: Array) -> Array:
    apart, size = np.abs(own - other), np.abs(own)
    if own.ndim == 2:
        apart, size = np.linalg.norm(apart, axis=1), np.linalg.norm(size, axis=1)
    return np.asarray(SAFETY * np.maximum.accumulate(apart) + 4.0 * EPS * (size + size.max()))


def _some(bodies: Mapping[str, BodyMotion], index: NDArray[np.intp]) -> dict[str, BodyMotion]:
    return {
        name: type(body)(*(series[index] for series in vars(body).values()))
        for name, body in bodies.items()
    }


@dataclass(frozen=True, eq=False)
class MachineMotion:
    """Motion of a scene of one freedom (`FreeMotion`): ``history`` is the integration, and
    ``other`` gives that with other nodes, which takes as long: it is made where a bound or an error
    is requested."""

    scene: Scene
    until_s: float
    history: CoordinateHistory
    other: Callable[[], CoordinateHistory]
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
        return float(np.abs(self._looks[1]).max())

    @property
    def range_rad(self) -> float:
        return float(np.ptp(self._looks[0]))

    @cached_property
    def law(self) -> IntegratedLaw:
        return IntegratedLaw(self._driver, 0.0, self.until_s, self.peak_speed_rad_s)

    def at(self, time_s: Array, *, bound: bool = True) -> Motion:
        instants = samples(time_s, "time_s")
        check_within(self.scene, instants, self.until_s)
        return motion_along(self.scene, self.history, self._doubt if bound else None, instants)

    def outside(self, time_s: Array, *, bound: bool = True) -> Motion:
        """Return as `FreeMotion.outside`, with a constant third rate of the driver."""
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
        """Return the reference, without rates and bounds, next to a run of this scene at each of
        its instants, in the run's assembly: at its logged driver angle, and near a limit of that at
        the angle or the displacement of a body that goes on through it."""
        return places_beside(self.scene, self.history, logged)

    def energy(self, time_s: Array) -> EnergyBalance:
        instants = samples(time_s, "time_s")
        check_within(self.scene, instants, self.until_s)
        return history_energy(self.scene, self.history, instants)

    def sensitivity(self, time_s: Array) -> Array:
        """Return G (T,): the largest growth of a small change of the start by then, at least 1.

        It is the change of the driver's angle: for an error of the start's angle, per rad; or of
        its speed, per peak speed over the driver's range (a turn at most): changes that are the
        same part of the motion.
        """
        return np.interp(time_s, *self._growth)

    def error_rad(self, time_s: Array) -> Array:
        instants = samples(time_s, "time_s")
        u, off = self.history.state(instants)[0], self._doubt.at(instants)[0]
        error = np.zeros_like(u)
        for chart, at in self.history.charts_at(instants):
            _, slope, bend = chart.driver(u[at])
            error[at] = (np.abs(slope) + 0.5 * np.abs(bend) * off[at]) * off[at]
        return error

    def _driver(self, time_s: Array) -> tuple[Array, Array, Array]:
        """Return angle, rate and acceleration of the driver."""
        u, v, a = self.history.state(time_s)
        theta, omega, alpha = np.empty_like(u), np.empty_like(u), np.empty_like(u)
        for chart, at in self.history.charts_at(time_s):
            phi, slope, bend = chart.driver(u[at])
            theta[at], omega[at] = phi, slope * v[at]
            alpha[at] = bend * v[at] ** 2 + slope * a[at]
        return theta, omega, alpha

    @cached_property
    def _doubt(self) -> Doubt:
        """The error of the integration."""
        return Doubt.between(self.history, self.other())

    @cached_property
    def _looks(self) -> tuple[Array, Array, Array]:
        """Angle, rate and acceleration of the driver at instants that are close."""
        ends = np.append(self.history.starts_s, self.history.end_s)
        share = np.linspace(0.0, 1.0, 17)
        return self._driver((ends[:-1, None] + np.diff(ends)[:, None] * share).ravel())

    @cached_property
    def _growth(self) -> tuple[Array, Array]:
        reach = min(2.0 * np.pi, self.range_rad)
        return growth(self.history, self.peak_speed_rad_s / reach if reach > 0.0 else 0.0)


def history_energy(scene: Scene, history: CoordinateHistory, time_s: Array) -> EnergyBalance:
    """Return the energies of an integrated motion at times [s], (T,)."""
    u, v, _ = history.state(time_s)
    window = history.windows_at(time_s)
    series, before = _work(scene, history)
    share = (time_s - history.starts_s[window]) / history.long_s[window]
    work = before[window] + sums(series[window], np.clip(share, 0.0, MOST))
    kinetic, potential = np.empty_like(u), np.empty_like(u)
    for chart, at in history.charts_at(time_s):
        if at.any():
            machine = Machine(scene, chart)
            wound = history.wound_at(window[at])
            kinetic[at] = machine.kinetic(u[at], v[at])
            potential[at] = machine.potential(u[at], wound)
    return EnergyBalance(kinetic, potential, np.asarray(work))


def _work(scene: Scene, history: CoordinateHistory) -> tuple[Array, Array]:
    """Return the series of the work in each window, and the work before it [J]."""
    n = history.windows[0].swing.shape[1]
    rule = gauss(n)
    long_s = history.long_s
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
