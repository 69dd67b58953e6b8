"""Characteristics of several waves: the pulse of one, and sums of Fourier's."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from models.array import Array
from models.characteristics import EPS, Characteristic


@dataclass(frozen=True)
class Pulse(Characteristic):
    """amplitude sin(2 pi (x - start) / period) for one period from ``start`` on, and 0 beside it.

    Source: the thesis on elastic mechanisms, whose torque on the crank it is.
    """

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
