"""A force and a moment over time, in the plane."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from models.array import Array


@dataclass(frozen=True)
class Wrench:
    """A ``force`` (T, 2) [N] and its ``moment`` (T,) [N m] about ``place`` (T, 2) [m]."""

    force: Array
    moment: Array
    place: Array

    def moment_about(self, place: Array) -> Array:
        """The moment about another place."""
        x, y = (self.place - place).T
        return np.asarray(self.moment + x * self.force[:, 1] - y * self.force[:, 0])

    def __neg__(self) -> Wrench:
        return Wrench(-self.force, -self.moment, self.place)

    def __sub__(self, other: Wrench) -> Wrench:
        """About the place of the first."""
        moment = self.moment - other.moment_about(self.place)
        return Wrench(self.force - other.force, moment, self.place)
