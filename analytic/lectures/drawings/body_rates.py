"""How a body moves at one instant, by one of its points and its rotation."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from analytic.lectures.drawings.placed_mechanism import quarter_turn
from models.array import Array


@dataclass(frozen=True)
class BodyRates:
    """A body by its point at ``place`` [m], with that point's ``velocity`` [m/s] and
    ``acceleration`` [m/s^2], (2,) each, and by ``omega`` [rad/s] and ``alpha`` [rad/s^2]."""

    place: Array
    velocity: Array
    acceleration: Array
    omega: float
    alpha: float

    def velocity_at(self, place: Array) -> Array:
        """Of the body's point at a place [m/s], (2,)."""
        return np.asarray(self.velocity + self.omega * quarter_turn(place - self.place))

    def acceleration_at(self, place: Array) -> Array:
        """Of the body's point at a place [m/s^2], (2,)."""
        arm = place - self.place
        turning = self.alpha * quarter_turn(arm) - self.omega**2 * arm
        return np.asarray(self.acceleration + turning)


STILL = BodyRates(np.zeros(2), np.zeros(2), np.zeros(2), 0.0, 0.0)
"""The ground."""
