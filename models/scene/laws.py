"""Laws of the driver: its angle, angular velocity and acceleration as functions of time."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass, field, replace
from typing import ClassVar, Self

import numpy as np

from models.array import Array

MOST_TURNS = 1e7
"""Limit at which 9 digits of the angle within a turn are left: times beyond it are dates, or not in
s."""


class Law(ABC):
    """A smooth law of motion of the driver. Raises ValueError for numbers that drive nothing.

    Its coordinate is an angle in rad; for a driven slider it is the displacement in m, and the same
    names stand for m, m/s and m/s^2 (`models.scene.Driver`). ``period_s`` is the time of one "turn"
    of a run, and ``peak_speed_rad_s`` the scale of velocity errors; both are positive. The rounding
    of the law grows with ``offset_rad``, ``phase_rad`` and ``fastest_rad_s``: the constant parts of
    the angle and of the phase, and the fastest circular frequency.
    """

    is_free: ClassVar[bool] = False
    """True if nothing drives it after the start."""

    def __post_init__(self) -> None:
        for name, number in vars(self).items():
            try:
                finite = math.isfinite(number)
            except (TypeError, OverflowError):
                finite = False
            if not finite:
                raise ValueError(f"{name} is {number!r:.60}: a law of motion needs finite numbers")

    @property
    @abstractmethod
    def offset_rad(self) -> float: ...

    @property
    def phase_rad(self) -> float:
        return 0.0

    @property
    def fastest_rad_s(self) -> float:
        return self.peak_speed_rad_s

    @property
    def period_s(self) -> float:
        return math.tau / self.peak_speed_rad_s

    @property
    @abstractmethod
    def peak_speed_rad_s(self) -> float: ...

    @property
    def kinks_s(self) -> tuple[float, ...]:
        """Instants [s] at which it is not smooth: its formula changes."""
        return ()

    def fastest_until(self, time_s: float) -> float:
        """Return the largest speed from the start to a time [rad/s]; by default the peak."""
        return self.peak_speed_rad_s

    @abstractmethod
    def at(self, time_s: Array) -> tuple[Array, Array, Array]:
        """Angle [rad], angular velocity [rad/s], angular acceleration [rad/s^2], shape of time."""

    @abstractmethod
    def turned(self, angle_rad: float) -> Law:
        """The law with a constant angle [rad] added."""


@dataclass(frozen=True)
class _ToSpeed(Law):
    """A law that starts at an angle and reaches one speed. ``travel_rad`` is the travel that counts
    as one "turn" of a run: a whole turn, except for a driven slider, which has none."""

    start_rad: float
    speed_rad_s: float
    travel_rad: float = field(default=math.tau, kw_only=True)

    def __post_init__(self) -> None:
        super().__post_init__()
        if not self.travel_rad > 0.0:
            raise ValueError(f"the travel of a run is {self.travel_rad:g}: give one above 0")

    @property
    def period_s(self) -> float:
        return self.travel_rad / self.peak_speed_rad_s

    @property
    def offset_rad(self) -> float:
        return abs(self.start_rad)

    @property
    def peak_speed_rad_s(self) -> float:
        return abs(self.speed_rad_s)

    def turned(self, angle_rad: float) -> Self:
        return replace(self, start_rad=self.start_rad + angle_rad)


@dataclass(frozen=True)
class ConstantSpeed(_ToSpeed):
    """theta = start + speed t."""

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.speed_rad_s == 0.0:
            raise ValueError("its speed is 0: a driver at rest drives nothing")

    def angle(self, time_s: Array) -> Array:
        """The angle alone [rad]."""
        return self.start_rad + self.speed_rad_s * time_s

    def at(self, time_s: Array) -> tuple[Array, Array, Array]:
        theta = self.angle(time_s)
        return theta, np.full_like(theta, self.speed_rad_s), np.zeros_like(theta)


@dataclass(frozen=True)
class Oscillating(Law):
    """theta = centre + amplitude sin(frequency t + phase); frequency is circular [rad/s]."""

    centre_rad: float
    amplitude_rad: float
    frequency_rad_s: float
    phase_rad: float = 0.0

    def __post_init__(self) -> None:
        super().__post_init__()
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


@dataclass(frozen=True)
class FromRest(_ToSpeed):
    """From rest to a constant speed by a cycloidal ramp of ``rise_s``; acceleration is continuous.
    Within the ramp, with tau = t / rise: omega = speed (tau - sin(2 pi tau) / (2 pi))."""

    rise_s: float

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.speed_rad_s == 0.0 or self.rise_s <= 0.0:
            raise ValueError("a start from rest needs speed_rad_s other than 0 and rise_s above 0")

    @property
    def fastest_rad_s(self) -> float:
        return max(abs(self.speed_rad_s), math.tau / self.rise_s)

    @property
    def kinks_s(self) -> tuple[float, ...]:
        return (self.rise_s,)

    def at(self, time_s: Array) -> tuple[Array, Array, Array]:
        share, rate, second = _ramp(time_s, self.rise_s)
        speed = self.speed_rad_s
        return self.start_rad + speed * share, speed * rate, speed * second


@dataclass(frozen=True)
class Accelerating(_ToSpeed):
    """theta = start + speed t + acceleration t^2 / 2, at all times; the speed may change its sign.

    A turn of a run takes as long as the driver's first whole turn away from its start, to either
    side, and the peak speed is the largest within it. Later turns are quicker.
    """

    acceleration_rad_s2: float

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.acceleration_rad_s2 == 0.0:
            raise ValueError('acceleration_rad_s2 is 0: use law = "constant"')

    @property
    def _first_turn(self) -> tuple[float, float]:
        """Its duration [s], and the largest speed within it [rad/s]."""
        speed, rate = abs(self.speed_rad_s), abs(self.acceleration_rad_s2)
        turn = self.travel_rad
        slows_down = self.speed_rad_s * self.acceleration_rad_s2 < 0.0
        if slows_down and speed**2 >= 2.0 * turn * rate:
            return 2.0 * turn / (speed + math.sqrt(speed**2 - 2.0 * turn * rate)), speed
        end = math.sqrt(speed**2 + 2.0 * turn * rate)
        if slows_down:  # it turns round within the turn, and passes its start
            return (speed + end) / rate, end
        return 2.0 * turn / (speed + end), end

    @property
    def period_s(self) -> float:
        return self._first_turn[0]

    @property
    def peak_speed_rad_s(self) -> float:
        return self._first_turn[1]

    def fastest_until(self, time_s: float) -> float:
        return max(self.peak_speed_rad_s, abs(float(self.at(np.array(time_s))[1])))

    def at(self, time_s: Array) -> tuple[Array, Array, Array]:
        gained = self.acceleration_rad_s2 * time_s
        theta = self.start_rad + (self.speed_rad_s + 0.5 * gained) * time_s
        return theta, self.speed_rad_s + gained, np.full_like(theta, self.acceleration_rad_s2)


@dataclass(frozen=True)
class SpeedChange(Law):
    """From one constant speed to another by a cycloidal ramp of ``rise_s`` that begins at ``at_s``.

    With ``rise_s`` 0 the speed jumps: it is the new one from ``at_s`` on, and the acceleration is
    0 on both sides. The speeds may have different signs, and the first may be 0.
    """

    start_rad: float
    before_rad_s: float
    after_rad_s: float
    at_s: float
    rise_s: float

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.after_rad_s == 0.0 or self.rise_s < 0.0:
            raise ValueError(
                "a change of speed needs after_rad_s other than 0 and rise_s of 0 or more"
            )

    @property
    def offset_rad(self) -> float:
        return abs(self.start_rad) + abs((self.after_rad_s - self.before_rad_s) * self.at_s)

    @property
    def fastest_rad_s(self) -> float:
        return max(self.peak_speed_rad_s, math.tau / self.rise_s if self.rise_s else 0.0)

    @property
    def peak_speed_rad_s(self) -> float:
        return max(abs(self.before_rad_s), abs(self.after_rad_s))

    @property
    def kinks_s(self) -> tuple[float, ...]:
        return (self.at_s, self.at_s + self.rise_s)

    def at(self, time_s: Array) -> tuple[Array, Array, Array]:
        gain = self.after_rad_s - self.before_rad_s
        share, rate, second = _ramp(time_s - self.at_s, self.rise_s)
        theta = self.start_rad + self.before_rad_s * time_s + gain * share
        return theta, self.before_rad_s + gain * rate, gain * second

    def turned(self, angle_rad: float) -> SpeedChange:
        return replace(self, start_rad=self.start_rad + angle_rad)


def _ramp(time_s: Array, rise_s: float) -> tuple[Array, Array, Array]:
    """A speed that rises from 0 to 1: its integral [s], the speed [1], its rate [1/s]."""
    after = np.maximum(time_s - rise_s, 0.0)
    if rise_s == 0.0:
        return after, np.where(time_s >= 0.0, 1.0, 0.0), np.zeros_like(time_s)
    tau = np.clip(time_s / rise_s, 0.0, 1.0)
    half = np.sin(math.pi * tau) ** 2
    share = rise_s * (tau**2 / 2 - half / (2 * math.pi**2)) + after
    return share, tau - np.sin(math.tau * tau) / math.tau, 2.0 / rise_s * half
