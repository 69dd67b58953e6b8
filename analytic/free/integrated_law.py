"""The motion of a driver that was integrated, as a law: all that takes a law takes it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from models.array import Array
from models.laws import Law

AngleHistory = Callable[[Array], tuple[Array, Array, Array]]
"""Angle [rad], rate [rad/s] and acceleration [rad/s^2] at times [s]."""


@dataclass(frozen=True, eq=False)
class IntegratedLaw(Law):
    """What a free driver does from ``start_s`` to ``end_s``, as an integration has it."""

    history: AngleHistory
    start_s: float
    end_s: float
    peak_rad_s: float
    ahead_rad: float = 0.0

    def __post_init__(self) -> None:  # a history is no number
        assert np.isfinite([self.start_s, self.end_s, self.peak_rad_s]).all()

    @property
    def offset_rad(self) -> float:
        return abs(float(self.history(np.array([self.start_s]))[0][0]))

    @property
    def period_s(self) -> float:
        return self.end_s - self.start_s

    @property
    def peak_speed_rad_s(self) -> float:
        return self.peak_rad_s

    def at(self, time_s: Array) -> tuple[Array, Array, Array]:
        theta, omega, alpha = self.history(time_s)
        return theta + self.ahead_rad, omega, alpha

    def turned(self, angle_rad: float) -> IntegratedLaw:
        return replace(self, ahead_rad=self.ahead_rad + angle_rad)
