"""Magnitude of a load over time, driver angle, displacement or speed."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from models.array import Array

EPS = float(np.finfo(np.float64).eps)


class Characteristic(ABC):
    """The magnitude of a load [N or N m] over time [s], driver angle [rad], displacement [m] or
    speed [m/s or rad/s]. Raises ValueError for numbers that give no magnitude."""

    @abstractmethod
    def at(self, x: Array) -> Array:
        """Return the magnitude, shape of ``x``. Raises ValueError where there is none."""

    def at_one(self, x: float) -> float:
        """Return `at`, to the bit, for one place: engines call it at every step."""
        return float(self.at(np.array([x]))[0])

    def nearest(self, x: float) -> float:
        """Return the place next to ``x`` that has a magnitude."""
        return x

    @property
    def kinks(self) -> tuple[float, ...]:
        """Places, within a period if there is one, in which it is not smooth."""
        return ()

    @property
    def repeats_after(self) -> float | None:
        """Period; None without one."""
        return None

    def kinks_between(self, first: float, last: float) -> Iterator[float]:
        """Yield, in order, the places from ``first`` to ``last`` in which it is not smooth, of all
        periods; there may be very many."""
        yield from (kink for kink in self.kinks if first <= kink <= last)

    @abstractmethod
    def steepest(self, x: Array, by: Array | float) -> Array | float:
        """Return a bound on the slope within ``by`` of ``x``."""

    def rounding(self, x: Array) -> Array | float:
        """Return a bound on the rounding error of `at`."""
        return 0.0

    @abstractmethod
    def carried(self, size: float, *, stretch: float = 1.0, shift: float = 0.0) -> Characteristic:
        """Return ``size`` times itself, over an argument that is stretched, then shifted: size c((x
        - shift) / stretch)."""


@dataclass(frozen=True)
class Constant(Characteristic):
    """A constant magnitude."""

    value: float

    def at(self, x: Array) -> Array:
        return np.full_like(x, self.value)

    def at_one(self, x: float) -> float:
        return float(self.value)

    def steepest(self, x: Array, by: Array | float) -> Array | float:
        return 0.0

    def carried(self, size: float, *, stretch: float = 1.0, shift: float = 0.0) -> Constant:
        return Constant(size * self.value)


@dataclass(frozen=True)
class Sine(Characteristic):
    """amplitude sin(2 pi x / period + phase); an additional constant load shifts it."""

    amplitude: float
    period: float
    phase_rad: float = 0.0

    def __post_init__(self) -> None:
        if not self.period > 0.0:
            raise ValueError(f"found a period of {self.period:g}; give one above 0")

    @property
    def repeats_after(self) -> float | None:
        return self.period

    def at(self, x: Array) -> Array:
        return np.asarray(self.amplitude * np.sin(math.tau / self.period * x + self.phase_rad))

    def steepest(self, x: Array, by: Array | float) -> Array | float:
        return abs(self.amplitude) * math.tau / self.period

    def rounding(self, x: Array) -> Array | float:
        turned = np.abs(x) * (math.tau / self.period) + abs(self.phase_rad)
        return np.asarray(3 * EPS * abs(self.amplitude) * (1.0 + turned))

    def carried(self, size: float, *, stretch: float = 1.0, shift: float = 0.0) -> Sine:
        period = abs(stretch) * self.period
        if stretch < 0.0:  # sin(-x + phase) = -sin(x - phase)
            return Sine(-size * self.amplitude, period, -self.phase_rad - math.tau * shift / period)
        return Sine(size * self.amplitude, period, self.phase_rad - math.tau * shift / period)


@dataclass(frozen=True)
class Polynomial(Characteristic):
    """c0 + c1 x + c2 x^2 + ..."""

    coefficients: tuple[float, ...]

    def __post_init__(self) -> None:
        if not self.coefficients:
            raise ValueError("found no coefficient; give at least one, that of x^0 first")

    def at(self, x: Array) -> Array:
        return np.asarray(np.polynomial.polynomial.polyval(x, self.coefficients))

    def at_one(self, x: float) -> float:
        *lower, total = self.coefficients
        for coefficient in reversed(lower):
            total = coefficient + total * x
        return total

    def steepest(self, x: Array, by: Array | float) -> Array | float:
        slope = [k * abs(c) for k, c in enumerate(self.coefficients)][1:] or [0.0]
        return np.asarray(np.polynomial.polynomial.polyval(np.abs(x) + by, slope))

    def rounding(self, x: Array) -> Array | float:
        sizes = [abs(c) for c in self.coefficients]
        size = np.asarray(np.polynomial.polynomial.polyval(np.abs(x), sizes))
        return np.asarray(len(sizes) * EPS * size)

    def carried(self, size: float, *, stretch: float = 1.0, shift: float = 0.0) -> Polynomial:
        c = [size * value / stretch**k for k, value in enumerate(self.coefficients)]
        # About the new origin, by binomials: c_j = sum over k of c_k (k over j) (-shift)^(k - j).
        moved = (
            sum(c[k] * math.comb(k, j) * (-shift) ** (k - j) for k in range(j, len(c)))
            for j in range(len(c))
        )
        return Polynomial(tuple(moved))


@dataclass(frozen=True)
class Staircase(Characteristic):
    """``values[k]`` from ``places[k]`` on, up to the next place; 0 before the first. The new value
    holds in the place itself. The slope is unbounded there: `steepest` gives infinity."""

    places: tuple[float, ...]
    values: tuple[float, ...]

    def __post_init__(self) -> None:
        if len(self.places) != len(self.values) or not self.places:
            raise ValueError(
                f"found {len(self.places)} places and {len(self.values)} values; give one each, of "
                "one step at least"
            )
        for before, after in zip(self.places, self.places[1:], strict=False):
            if not after > before:
                raise ValueError(
                    f"found {after:g} after {before:g}; the instants of steps have to increase "
                    "from one to the next"
                )

    @property
    def kinks(self) -> tuple[float, ...]:
        return self.places

    def at(self, x: Array) -> Array:
        level = np.searchsorted(self.places, x, side="right")
        return np.asarray(np.concatenate([[0.0], self.values])[level])

    def steepest(self, x: Array, by: Array | float) -> Array | float:
        low = np.searchsorted(self.places, np.asarray(x) - by, side="left")
        high = np.searchsorted(self.places, np.asarray(x) + by, side="right")
        return np.where((high > low) & (np.asarray(by) > 0.0), np.inf, 0.0)

    def carried(self, size: float, *, stretch: float = 1.0, shift: float = 0.0) -> Staircase:
        if stretch < 0.0:
            raise ValueError(
                "steps have no mirror image: a load that stays on would have been on before"
            )
        places = tuple(stretch * place + shift for place in self.places)
        return Staircase(places, tuple(size * value for value in self.values))


@dataclass(frozen=True)
class Pulse(Characteristic):
    """amplitude sin(2 pi (x - start) / period) for one period from ``start`` on, and 0 beside it.
    Source: the thesis on elastic mechanisms (torque on the crank)."""

    amplitude: float
    period: float
    start: float = 0.0

    def __post_init__(self) -> None:
        if not self.period > 0.0:
            raise ValueError(f"found a period of {self.period:g}; give one above 0")

    @property
    def kinks(self) -> tuple[float, ...]:
        return (self.start, self.start + self.period)

    def at(self, x: Array) -> Array:
        since = np.clip(np.asarray(x) - self.start, 0.0, self.period)
        # Its end is the zero that rounding would miss.
        wave = self.amplitude * np.sin(math.tau / self.period * since)
        return np.where((since > 0.0) & (since < self.period), wave, 0.0)

    def steepest(self, x: Array, by: Array | float) -> Array | float:
        return abs(self.amplitude) * math.tau / self.period

    def rounding(self, x: Array) -> Array | float:
        turned = (np.abs(x) + abs(self.start)) * (math.tau / self.period)
        return np.asarray(3 * EPS * abs(self.amplitude) * (1.0 + turned))

    def carried(self, size: float, *, stretch: float = 1.0, shift: float = 0.0) -> Pulse:
        period, start = abs(stretch) * self.period, stretch * self.start + shift
        if stretch > 0.0:
            return Pulse(size * self.amplitude, period, start)
        # Seen from behind a wave of a sine begins at its end, with the other sign.
        return Pulse(-size * self.amplitude, period, start - period)


@dataclass(frozen=True)
class FourierSum(Characteristic):
    """mean + sum over k from 1 on of c_k cos(2 pi k x / period) + s_k sin(2 pi k x / period)."""

    mean: float
    cosines: tuple[float, ...]
    sines: tuple[float, ...]
    period: float

    def __post_init__(self) -> None:
        if not self.period > 0.0:
            raise ValueError(f"found a period of {self.period:g}; give one above 0")
        if len(self.cosines) != len(self.sines):
            raise ValueError(
                f"found {len(self.cosines)} cosines and {len(self.sines)} sines; give one each, 0 "
                "where there is none"
            )

    @property
    def repeats_after(self) -> float | None:
        return self.period

    def _phases(self, x: Array) -> Array:
        orders = np.arange(1, len(self.cosines) + 1)
        return np.asarray(math.tau / self.period * orders * np.asarray(x)[..., None])

    @property
    def _sizes(self) -> Array:
        return np.hypot(self.cosines, self.sines)

    def at(self, x: Array) -> Array:
        phases = self._phases(x)
        waves = np.cos(phases) @ np.array(self.cosines) + np.sin(phases) @ np.array(self.sines)
        return np.asarray(self.mean + waves)

    def steepest(self, x: Array, by: Array | float) -> Array | float:
        orders = np.arange(1, len(self.cosines) + 1)
        return float(math.tau / self.period * (orders @ self._sizes))

    def rounding(self, x: Array) -> Array | float:
        turned = np.abs(self._phases(x)) @ self._sizes
        return np.asarray(4 * EPS * (abs(self.mean) + len(self.sines) * sum(self._sizes) + turned))

    def carried(self, size: float, *, stretch: float = 1.0, shift: float = 0.0) -> FourierSum:
        period, turned = abs(stretch) * self.period, math.copysign(1.0, stretch)
        cosines, sines = [], []
        for k, (c, s) in enumerate(zip(self.cosines, self.sines, strict=True), start=1):
            # cos(k (x - shift)) and sin(k (x - shift)), written out.
            lag = math.tau * k * shift / period
            across = turned * s
            cosines.append(size * (c * math.cos(lag) - across * math.sin(lag)))
            sines.append(size * (c * math.sin(lag) + across * math.cos(lag)))
        return FourierSum(size * self.mean, tuple(cosines), tuple(sines), period)
