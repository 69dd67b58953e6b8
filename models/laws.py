"""How the driver moves: its angle, angular velocity and acceleration as functions of time."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


class Law(Protocol):
    """A smooth law of motion of the driver.

    ``period_s`` is what one "turn" of a run means for the law, and ``peak_speed_rad_s`` the
    speed that errors of velocity are divided by; both are positive. ``offset_rad``,
    ``phase_rad`` and ``fastest_rad_s``, the constant parts of the angle and of the phase and the
    fastest circular frequency in the law, are what the rounding of the law grows with.
    """

    @property
    def offset_rad(self) -> float: ...

    @property
    def phase_rad(self) -> float: ...

    @property
    def fastest_rad_s(self) -> float: ...

    @property
    def period_s(self) -> float: ...

    @property
    def peak_speed_rad_s(self) -> float: ...

    def at(self, time_s: Array) -> tuple[Array, Array, Array]:
        """Angle [rad], angular velocity [rad/s], angular acceleration [rad/s^2], shape of time."""
        ...

    def turned(self, angle_rad: float) -> Law:
        """The law with a constant angle [rad] added."""
        ...

    def mirrored(self) -> Law:
        """The law with every angle of the opposite sign."""
        ...

    def sped_up(self, factor: float) -> Law:
        """The law that runs ``factor`` times as fast through the same angles."""
        ...


@dataclass(frozen=True)
class ConstantSpeed:
    """theta = start + speed t."""

    start_rad: float
    speed_rad_s: float

    def __post_init__(self) -> None:
        _finite(self)
        if self.speed_rad_s == 0.0:
            raise ValueError("speed_rad_s is 0: a driver at rest drives nothing")

    @property
    def offset_rad(self) -> float:
        return abs(self.start_rad)

    @property
    def phase_rad(self) -> float:
        return 0.0

    @property
    def fastest_rad_s(self) -> float:
        return abs(self.speed_rad_s)

    @property
    def period_s(self) -> float:
        return math.tau / abs(self.speed_rad_s)

    @property
    def peak_speed_rad_s(self) -> float:
        return abs(self.speed_rad_s)

    def angle(self, time_s: Array) -> Array:
        """The angle alone [rad]."""
        return self.start_rad + self.speed_rad_s * time_s

    def at(self, time_s: Array) -> tuple[Array, Array, Array]:
        theta = self.angle(time_s)
        return theta, np.full_like(theta, self.speed_rad_s), np.zeros_like(theta)

    def turned(self, angle_rad: float) -> ConstantSpeed:
        return replace(self, start_rad=self.start_rad + angle_rad)

    def mirrored(self) -> ConstantSpeed:
        return ConstantSpeed(-self.start_rad, -self.speed_rad_s)

    def sped_up(self, factor: float) -> ConstantSpeed:
        return replace(self, speed_rad_s=self.speed_rad_s * factor)


@dataclass(frozen=True)
class Oscillating:
    """theta = centre + amplitude sin(frequency t + phase); frequency is circular [rad/s]."""

    centre_rad: float
    amplitude_rad: float
    frequency_rad_s: float
    phase_rad: float = 0.0

    def __post_init__(self) -> None:
        _finite(self)
        if self.amplitude_rad == 0.0 or self.frequency_rad_s == 0.0:
            raise ValueError(
                "an oscillating driver needs an amplitude and a frequency other than 0"
            )

    @property
    def offset_rad(self) -> float:
        return abs(self.centre_rad) + abs(self.amplitude_rad * self.phase_rad)

    @property
    def fastest_rad_s(self) -> float:
        return abs(self.frequency_rad_s)

    @property
    def period_s(self) -> float:
        return math.tau / abs(self.frequency_rad_s)

    @property
    def peak_speed_rad_s(self) -> float:
        return abs(self.amplitude_rad * self.frequency_rad_s)

    def at(self, time_s: Array) -> tuple[Array, Array, Array]:
        phase = self.frequency_rad_s * time_s + self.phase_rad
        swing = self.amplitude_rad * np.sin(phase)
        omega = self.amplitude_rad * self.frequency_rad_s * np.cos(phase)
        return self.centre_rad + swing, omega, -(self.frequency_rad_s**2) * swing

    def turned(self, angle_rad: float) -> Oscillating:
        return replace(self, centre_rad=self.centre_rad + angle_rad)

    def mirrored(self) -> Oscillating:
        return replace(self, centre_rad=-self.centre_rad, amplitude_rad=-self.amplitude_rad)

    def sped_up(self, factor: float) -> Oscillating:
        return replace(self, frequency_rad_s=self.frequency_rad_s * factor)


@dataclass(frozen=True)
class FromRest:
    """From rest to a constant speed by a cycloidal ramp of ``rise_s``; acceleration is continuous.

    Within the ramp, with tau = t / rise: omega = speed (tau - sin(2 pi tau) / (2 pi)).
    """

    start_rad: float
    speed_rad_s: float
    rise_s: float

    def __post_init__(self) -> None:
        _finite(self)
        if self.speed_rad_s == 0.0 or self.rise_s <= 0.0:
            raise ValueError("a start from rest needs speed_rad_s other than 0 and rise_s above 0")

    @property
    def offset_rad(self) -> float:
        return abs(self.start_rad)

    @property
    def phase_rad(self) -> float:
        return 0.0

    @property
    def fastest_rad_s(self) -> float:
        return max(abs(self.speed_rad_s), math.tau / self.rise_s)

    @property
    def period_s(self) -> float:
        return math.tau / abs(self.speed_rad_s)

    @property
    def peak_speed_rad_s(self) -> float:
        return abs(self.speed_rad_s)

    def at(self, time_s: Array) -> tuple[Array, Array, Array]:
        tau = np.clip(time_s / self.rise_s, 0.0, 1.0)
        turn = math.tau * tau
        share = tau**2 / 2 - np.sin(turn / 2) ** 2 / (2 * math.pi**2)
        ramp = self.speed_rad_s * self.rise_s * share
        after = self.speed_rad_s * np.maximum(time_s - self.rise_s, 0.0)
        omega = self.speed_rad_s * (tau - np.sin(turn) / math.tau)
        alpha = self.speed_rad_s / self.rise_s * 2.0 * np.sin(turn / 2) ** 2
        return self.start_rad + ramp + after, omega, alpha

    def turned(self, angle_rad: float) -> FromRest:
        return replace(self, start_rad=self.start_rad + angle_rad)

    def mirrored(self) -> FromRest:
        return replace(self, start_rad=-self.start_rad, speed_rad_s=-self.speed_rad_s)

    def sped_up(self, factor: float) -> FromRest:
        return replace(self, speed_rad_s=self.speed_rad_s * factor, rise_s=self.rise_s / factor)


def _finite(law: ConstantSpeed | Oscillating | FromRest) -> None:
    """Refuse a law with a number that is not finite."""
    for name, number in vars(law).items():
        if not math.isfinite(number):
            raise ValueError(f"{name} is {number}: a law of motion needs finite numbers")
