"""How the magnitude of a load goes over time, over the driver's angle or over a displacement."""

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
    speed [m/s or rad/s].

    Raises ValueError for numbers that give no magnitude.
    """

    @abstractmethod
    def at(self, x: Array) -> Array:
        """The magnitude, shape of ``x``. Raises ValueError where there is none."""

    def at_one(self, x: float) -> float:
        """As `at`, to the bit, of one place: what an engine asks for at every step."""
        return float(self.at(np.array([x]))[0])

    def nearest(self, x: float) -> float:
        """The place next to ``x`` that has a magnitude."""
        return x

    @property
    def kinks(self) -> tuple[float, ...]:
        """The places, within a period where it has one, in which it is not smooth."""
        return ()

    @property
    def repeats_after(self) -> float | None:
        """Its period; None for one that goes on and never repeats."""
        return None

    def kinks_between(self, first: float, last: float) -> Iterator[float]:
        """The places from ``first`` to ``last`` in which it is not smooth, in order, those of all
        periods; there may be very many."""
        yield from (kink for kink in self.kinks if first <= kink <= last)

    @abstractmethod
    def steepest(self, x: Array, by: Array | float) -> Array | float:
        """A bound on its slope within ``by`` of ``x``."""

    @abstractmethod
    def rounding(self, x: Array) -> Array | float:
        """A bound on what rounding does to `at`."""

    @abstractmethod
    def carried(self, size: float, *, stretch: float = 1.0, shift: float = 0.0) -> Characteristic:
        """``size`` times itself, over an argument that is stretched, then shifted:
        size c((x - shift) / stretch)."""


@dataclass(frozen=True)
class Constant(Characteristic):
    """The same everywhere."""

    value: float

    def at(self, x: Array) -> Array:
        return np.full_like(x, self.value)

    def at_one(self, x: float) -> float:
        return float(self.value)

    def steepest(self, x: Array, by: Array | float) -> Array | float:
        return 0.0

    def rounding(self, x: Array) -> Array | float:
        return 0.0

    def carried(self, size: float, *, stretch: float = 1.0, shift: float = 0.0) -> Constant:
        return Constant(size * self.value)


@dataclass(frozen=True)
class Sine(Characteristic):
    """amplitude sin(2 pi x / period + phase); a constant load beside it shifts it."""

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
            raise ValueError("found no coefficient; give one at least, that of x^0 first")

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
