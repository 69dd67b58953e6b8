"""Free motion of a mechanism of any mobility, by its method of integration."""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.linalg import qr  # type: ignore[import-untyped]  # ships no stubs

from analytic.multibody.adaptive import Adaptive
from analytic.multibody.as_motion import as_motion
from analytic.multibody.bodies import Configuration, EnergyBalance
from analytic.multibody.dynamics import Dynamics, joint_forces
from analytic.multibody.generalised_forces import edges
from analytic.multibody.outset import Outset
from analytic.multibody.steps import FixedSteps, SingularPassage, StateHistory
from models.array import Array, Mask, from_end, samples
from models.errors import CrankcheckError
from models.motion import Motion
from models.scene import Scene
from models.scene.driver import check_within

TOLERANCE = 1e-13
NUDGE = 1e-6
"""Change of the start for the growth of a change [rad, or of the longest link]."""
LOOKS = 2001
"""Number of times at which the growth of a change is computed."""
MOST_NUMBERS = 4_000_000
"""Number of derivatives of markers that are computed at a time."""


@dataclass(frozen=True)
class Projection:
    """Method of order 8 with adaptive steps to ``tolerance``; after each step the state is
    projected onto the constraints."""

    tolerance: float = TOLERANCE


@dataclass(frozen=True)
class Baumgarte:
    """Constraints whose violation decays by ``alpha`` and ``beta`` [1/s]; alpha = beta is critical
    damping. With ``step_s`` [s] in equal steps, of order 4; without, as `Projection`."""

    alpha: float
    beta: float
    step_s: float | None = None
    tolerance: float = TOLERANCE

    def __post_init__(self) -> None:
        rates, step = (self.alpha, self.beta), 1.0 if self.step_s is None else self.step_s
        if not (np.isfinite([*rates, step]).all() and min(rates) >= 0.0 and step > 0.0):
            raise CrankcheckError(
                f"Baumgarte: found alpha {self.alpha:g}, beta {self.beta:g} and step_s "
                f"{self.step_s}; give rates [1/s] of 0 or more, and a step [s] above 0"
            )


Method = Projection | Baumgarte


@dataclass(frozen=True, eq=False)
class MultibodyMotion:
    """Free motion of a scene from its release at time 0 to ``until_s``, by one method."""

    dynamics: Dynamics
    method: Method
    until_s: float
    start: tuple[Array, Array]

    @property
    def scene(self) -> Scene:
        return self.dynamics.assembly.scene

    @cached_property
    def _history(self) -> StateHistory:
        return self._integrated(*self.start, self.method)

    def _integrated(self, q: Array, rates: Array, method: Method) -> StateHistory:
        dynamics, by_projection = self._equations(method), isinstance(method, Projection)
        steps: Adaptive | FixedSteps = Adaptive(dynamics, method.tolerance, projected=by_projection)
        if isinstance(method, Baumgarte) and method.step_s is not None:
            steps = FixedSteps(dynamics, method.step_s)
        return steps.history(q, rates, self.until_s)

    def _equations(self, method: Method) -> Dynamics:
        """Return the equations that a method integrates."""
        if isinstance(method, Projection):
            return self.dynamics
        return replace(self.dynamics, alpha=method.alpha, beta=method.beta)

    def at(self, time_s: Array) -> Motion:
        """Return the motion at times [s], (T,), with reactions. Raises CrankcheckError beyond its
        end."""
        instants, assembly, parts = samples(time_s, "time_s"), self.dynamics.assembly, []
        for some, now, _ in self._configurations(instants):
            seconds, multipliers = self._solved(some, now)
            driving = self.dynamics.forces.driving(some, now)
            forces = joint_forces(assembly, some, -multipliers, driving)
            parts.append(replace(as_motion(assembly, some, now, seconds), forces=forces))
        return Motion.joined(parts)

    def outside(self, time_s: Array) -> Motion:
        """Return the motion that leads to the start, at times below 0 [s], (T,), or that goes on
        from the end, at times above ``until_s``: within a step of it. The third derivatives of the
        coordinates are taken as constant."""
        end_s, later, h = from_end(time_s, self.until_s)
        within, t = end_s + np.array([0.0, h, 2.0 * h]), later[:, None]
        _, now, _ = next(self._configurations(within))
        seconds, _ = self._solved(within, now)
        thirds = (4.0 * seconds[1] - 3.0 * seconds[0] - seconds[2]) / (2.0 * h)
        q = now.q[0] + t * (now.rates[0] + t * (seconds[0] / 2.0 + t * thirds / 6.0))
        rates = now.rates[0] + t * (seconds[0] + t * thirds / 2.0)
        q, rates = self.dynamics.closed(q, rates)
        assembly = self.dynamics.assembly
        return as_motion(assembly, time_s, assembly.at_rates(q, rates), seconds[0] + t * thirds)

    @property
    def edges_s(self) -> tuple[float, ...]:
        """Instants at which loads over time are not smooth [s]."""
        return tuple(edges(self.scene, self.until_s)[1:-1])

    def _passing(self, time_s: Array) -> Iterator[tuple[SingularPassage, Mask]]:
        """Yield the passages through change points, and the mask of the times [s] in each."""
        for passage in self._history.passages:
            yield passage, (passage.begin_s < time_s) & (time_s < passage.end_s)

    def _passed(self, time_s: Array) -> Mask:
        """Return the mask of the times [s] in any passage."""
        passed = np.zeros(len(time_s), dtype=bool)
        for _, within in self._passing(time_s):
            passed |= within
        return passed

    def _solved(self, time_s: Array, now: Configuration) -> tuple[Array, Array]:
        """Return q'' (T, n) and the multipliers (T, m); in a change point, which leaves them open,
        those of the motion before and after it, and the smallest multipliers."""
        n, passed, dynamics = now.q.shape[1], self._passed(time_s), self._equations(self.method)
        if not passed.any():
            return dynamics.solve(time_s, now)
        seconds = np.empty_like(now.q)
        multipliers = np.empty((len(time_s), self.dynamics.assembly.joints.count))
        if not passed.all():
            found = dynamics.solve(time_s[~passed], now.some(~passed))
            seconds[~passed], multipliers[~passed] = found
        for passage, within in self._passing(time_s):
            seconds[within] = passage.slope(time_s[within])[n : 2 * n].T
        multipliers[passed] = dynamics.multipliers(
            time_s[passed], now.some(passed), seconds[passed]
        )
        return seconds, multipliers

    def energy(self, time_s: Array) -> EnergyBalance:
        """Return the energies at times [s], (T,)."""
        instants = samples(time_s, "time_s")
        parts = [
            self.dynamics.energies(now, work) for _, now, work in self._configurations(instants)
        ]
        return EnergyBalance.joined(parts)

    def _configurations(self, time_s: Array) -> Iterator[tuple[Array, Configuration, Array]]:
        """Yield times, all markers then, and the work until then, in blocks."""
        check_within(self.scene, time_s, self.until_s)
        assembly = self.dynamics.assembly
        n = assembly.size
        at_once = max(1, MOST_NUMBERS // (3 * n * assembly.markers))
        for first in range(0, len(time_s), at_once):
            some = time_s[first : first + at_once]
            state = self._history.state(np.minimum(some, self.until_s)).T
            q, rates = state[:, :n], state[:, n : 2 * n]
            if isinstance(self.method, Projection):  # between steps too
                within = ~self._passed(some)
                q[within], rates[within] = self.dynamics.closed(q[within], rates[within])
            yield some, assembly.at_rates(q, rates), state[:, -1]

    def sensitivity(self, time_s: Array) -> Array:
        """Return G (T,): the largest growth of a small change of the start by then, in any
        coordinate, at least 1.

        The change is one of place, along any of the freedoms; or of speed, per peak speed over the
        range of the coordinates (a turn, or as many longest links, at most): changes that are the
        same part of the motion.
        """
        return np.interp(time_s, *self._growth)

    @cached_property
    def _growth(self) -> tuple[Array, Array]:
        time_s = np.linspace(0.0, self.until_s, LOOKS)
        rough, outset = Projection(1e-10), Outset(self.dynamics.assembly)
        q, rates = self.start
        n = len(q)
        unit = self.dynamics.assembly.units[:, None]
        state = self._integrated(q, rates, rough).state(time_s)
        near = state[:n]
        reach = min(math.tau, float((np.ptp(near, axis=1) / unit[:, 0]).max()))
        peak = float(np.abs(state[n : 2 * n] / unit).max())
        per_s = peak / reach if reach > 0.0 else 0.0
        growth = np.ones(LOOKS)
        free = outset.freedoms(q)
        # As many coordinates as freedoms, those that move most, keep their speeds.
        leads = qr(free / unit[:, 0], mode="r", pivoting=True)[1][: len(free)]
        for direction in free:
            moved: Array = self.dynamics.closed((q + NUDGE * direction)[None], rates[None])[0][0]
            beside = outset.freedoms(moved)
            as_fast = np.linalg.lstsq(beside[:, leads].T, rates[leads], rcond=None)[0] @ beside
            for start in ((moved, as_fast), (q, rates + NUDGE * per_s * direction)):
                far = self._integrated(*start, rough).state(time_s)[:n]
                growth = np.maximum(growth, np.abs((far - near) / unit).max(axis=0) / NUDGE)
        return time_s, np.maximum.accumulate(growth)
