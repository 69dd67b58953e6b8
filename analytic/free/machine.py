"""The equation of a machine with one freedom, with its driver's angle phi as the coordinate.

With rates v', theta' and q' of bodies and springs per unit of the driver's::

    J phi'' + J' phi'^2 / 2 = Q       J = sum (m v'^2 + I theta'^2)
                                      Q = sum (F v' + M theta') - sum (pull q')

J and J' come of the kinematics to second order, in closed form. Q is that of weights, loads and
springs; loads and dampers may depend on time and speed. Source: problem book "Bai tap co hoc may",
chapter on real motion; I. I. Artobolevskii, Theory of Mechanisms, on reduced masses.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from analytic.dyads.chunk import Chunk
from analytic.forces.reduced_machine import inertia_and_slope, loaded_bodies
from analytic.forces.springs import spring_lengths
from analytic.forces.virtual_power import torque_by_power
from analytic.kinematics import driven_chunk, unit_chunk
from models.array import Array
from models.scene import Scene


@dataclass(frozen=True)
class Machine:
    """A scene with one freedom, reduced to its driver."""

    scene: Scene

    def inertia(self, theta: Array) -> tuple[Array, Array]:
        """J and J' [kg m^2] at driver angles [rad], (T,)."""
        unit = unit_chunk(self.scene, theta, bound=False)
        return inertia_and_slope(self.scene, unit)

    def push(self, time_s: Array, theta: Array, omega: Array) -> Array:
        """Q [N m] at times [s], driver angles [rad] and rates [rad/s], (T,)."""
        unit = unit_chunk(self.scene, theta, bound=False)
        return self._push(time_s, unit, omega)

    def _push(self, time_s: Array, unit: Chunk, omega: Array) -> Array:
        chunk = driven_chunk(self.scene, unit.theta, omega)
        bodies = loaded_bodies(self.scene, chunk, time_s)
        total = -np.asarray(torque_by_power(bodies, unit, chunk).value)
        rates = {spring.name: rate for spring, _, rate in spring_lengths(self.scene, unit)}
        for spring, q, rate in spring_lengths(self.scene, chunk):
            total = (
                total
                - (spring.rate * (q - spring.free) + spring.damping * rate) * rates[spring.name]
            )
        return np.broadcast_to(total, time_s.shape)

    def acceleration(self, time_s: Array, theta: Array, omega: Array) -> Array:
        """phi'' [rad/s^2] at times [s], driver angles [rad] and rates [rad/s], (T,)."""
        unit = unit_chunk(self.scene, theta, bound=False)
        inertia, slope = inertia_and_slope(self.scene, unit)
        push = self._push(time_s, unit, omega)
        return np.asarray((push - 0.5 * slope * omega**2) / inertia)
