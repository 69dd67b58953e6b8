"""The second opinion of driven mechanisms with elastic links: a multiplier for the drive as well.

The driver's equation is one more constraint, which depends on time, as in the thesis::

    phi - phi(t) = 0        its multiplier: the driving torque, but for its sign

    | M      Phi_q^T |  | q''    |     | Q     |
    | Phi_q  0       |  | lambda |  =  | gamma |

All coordinates are integrated, by an explicit method of order 8; after each step the state is put
back onto the constraints. No coordinate is eliminated. Source: Thesis on vibration of planar
mechanisms with elastic links (2018), chapter 2.
"""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.integrate import DOP853, OdeSolution  # type: ignore[import-untyped]  # ships no stubs

from analytic.multibody.as_motion import as_motion
from analytic.multibody.assembly import Assembly
from analytic.multibody.bodies import Configuration
from analytic.multibody.dynamics import Saddle, joint_forces
from analytic.multibody.generalised_forces import GeneralisedForces
from analytic.multibody.multibody_motion import TOLERANCE
from models.array import Array, samples
from models.motion import Motion

MOST_PROJECTIONS = 10
CLOSED = 1e-14
"""A step of a projection, over the longest link or in radians, after which none is made."""


@dataclass(frozen=True)
class DrivenMultipliers:
    """The motion of an assembly whose driver follows its law, from a state (n,) at time 0 to
    ``until_s``."""

    assembly: Assembly
    start: tuple[Array, Array]
    until_s: float

    @cached_property
    def _forces(self) -> GeneralisedForces:
        return GeneralisedForces(self.assembly, self.start[0])

    @property
    def _driver(self) -> int:
        """The number of the driver's angle among the coordinates."""
        return self.assembly.at[self.assembly.scene.driver.link] + 2

    def _told(self, time_s: float) -> tuple[float, float, float]:
        angle, speed, rate = self.assembly.scene.driver.law.at(np.array([time_s]))
        return float(angle[0]), float(speed[0]), float(rate[0])

    def _rows(self, now: Configuration) -> Array:
        """Phi_q (m + 1, n) at one sample, the driver's last."""
        drive = np.zeros((1, self.assembly.size))
        drive[0, self._driver] = 1.0
        return np.concatenate([self.assembly.joints.jacobian(now)[0], drive])

    def _open(self, time_s: float, now: Configuration) -> tuple[Array, Array]:
        """By how much the constraints are open, and how fast they open, (m + 1,) each."""
        angle, speed, _ = self._told(time_s)
        gaps = self.assembly.joints.gaps(now)[0]
        opening = self._rows(now) @ now.rates[0]
        opening[-1] -= speed
        return np.append(gaps, now.q[0, self._driver] - angle), opening

    def solve(self, time_s: float, now: Configuration) -> tuple[Array, Array]:
        """q'' (n,) and the multipliers (m + 1,) at one sample."""
        mass, right = self.assembly.weigh(now.q, now.rates)
        right += self._forces.on(np.array([time_s]), now)
        bottom = np.append(self.assembly.joints.gamma(now)[0], self._told(time_s)[2])
        return Saddle(mass[0], self._rows(now), redundant=False).solve(right[0], bottom)

    def _slope(self, time_s: float, state: Array) -> Array:
        n = self.assembly.size
        now = self.assembly.at_rates(state[None, :n], state[None, n:])
        return np.concatenate([state[n:], self.solve(time_s, now)[0]])

    def _closed(self, time_s: float, state: Array) -> Array:
        """The state on the constraints that is next to one, in the norm of the mass matrix."""
        n, assembly = self.assembly.size, self.assembly
        q, rates = state[:n], state[n:]
        for _ in range(MOST_PROJECTIONS):
            now = assembly.at_rates(q[None], rates[None])
            saddle = Saddle(assembly.mass(now.q)[0], self._rows(now), redundant=False)
            step, _ = saddle.solve(0.0, -self._open(time_s, now)[0])
            q = q + step
            if np.abs(step / assembly.units).max() <= CLOSED:
                break
        now = assembly.at_rates(q[None], rates[None])
        saddle = Saddle(assembly.mass(now.q)[0], self._rows(now), redundant=False)
        step, _ = saddle.solve(0.0, -self._open(time_s, now)[1])
        return np.concatenate([q, rates + step])

    @cached_property
    def _history(self) -> OdeSolution:
        """The state over time, of a law and loads without kinks."""
        state = np.concatenate(self.start)
        times, within = [0.0], []
        absolute = TOLERANCE * np.tile(self.assembly.units, 2)
        solver = DOP853(self._slope, 0.0, state, self.until_s, rtol=TOLERANCE, atol=absolute)
        while solver.status == "running":
            trouble = solver.step()
            assert solver.status != "failed", trouble
            times.append(float(solver.t))
            within.append(solver.dense_output())
            solver.y = self._closed(float(solver.t), solver.y)
        return OdeSolution(times, within)

    def at(self, time_s: Array) -> Motion:
        """The motion at times [s], (T,), with its reactions and the driving torque."""
        instants, assembly = samples(time_s, "time_s"), self.assembly
        each = zip(instants, self._history(instants).T, strict=True)
        states = np.array([self._closed(float(t), state) for t, state in each])
        now = assembly.at_rates(states[:, : assembly.size], states[:, assembly.size :])
        solved = [
            self.solve(float(t), now.some(np.arange(len(instants)) == i))
            for i, t in enumerate(instants)
        ]
        seconds, multipliers = (np.array(own) for own in zip(*solved, strict=True))
        motion = as_motion(assembly, instants, now, seconds)
        forces = joint_forces(assembly, instants, -multipliers[:, :-1], -multipliers[:, -1])
        return replace(motion, forces=forces)
