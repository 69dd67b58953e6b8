"""How an error depends on the step: a floor, a power of the step, and how the two add up.

    error^2 = floor^2 + 2 a floor C dt^p + (C dt^p)^2

Both parts are errors over a whole run. With alignment a = 1 they point the same way everywhere and
error = floor + C dt^p; MuJoCo's soft pins and its first-order step often work against each other
(a < 0), and the error then dips before it rises to its floor.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from models.array import Array


@dataclass(frozen=True)
class Curve:
    """A curve through points; ``coefficient`` is C [unit / s^order], below 0 where the error comes
    up to its floor.

    ``misfit`` is the sum of squared residuals of ln error, ``points`` and ``parameters`` say how
    many there are.
    """

    order: float
    floor: float
    coefficient: float
    finest_s: float
    misfit: float
    points: int
    parameters: int
    alignment: float = 1.0

    @property
    def freedom(self) -> int:
        return self.points - self.parameters

    @property
    def scatter(self) -> float:
        """Root mean square residual per degree of freedom, as a share of the error."""
        return math.sqrt(self.misfit / max(self.freedom, 1))

    @property
    def slope(self) -> float:
        """d ln error / d ln dt at the finest step."""
        step = self.coefficient * self.finest_s**self.order
        square = self.at(self.finest_s) ** 2
        return float(self.order * step * (self.alignment * self.floor + step) / square)

    @property
    def rest(self) -> float:
        """The floor as a share of the error at the finest step."""
        return self.floor / self.at(self.finest_s)

    def at(self, dt_s: float) -> float:
        step = self.coefficient * dt_s**self.order
        square = self.floor**2 + 2.0 * self.alignment * self.floor * step + step**2
        return math.sqrt(max(square, 0.0))


@dataclass(frozen=True)
class Allowed:
    """Least and largest order and floor of all curves whose misfit is below a limit."""

    order: tuple[float, float]
    floor: tuple[float, float]


def straight(dt_s: Array, error: Array) -> Curve:
    """C dt^p, p of any sign, through two points or more (shape (n,))."""
    x, e = np.log(dt_s / dt_s.min()), np.log(error)
    away = x - x.mean()
    order = float(away @ e / (away @ away))
    level = float(e.mean() - order * x.mean())
    misfit = float(np.sum((e - level - order * x) ** 2))
    finest = float(dt_s.min())
    return Curve(order, 0.0, math.exp(level) / finest**order, finest, misfit, len(e), 2)


def curvature(dt_s: Array, error: Array) -> Array:
    """Misfits of a straight line and of a parabola in the logarithms, shape (2,).

    One order after another leaves much between the two, and scatter does not.
    """
    x, e = np.log(dt_s / dt_s.min()), np.log(error)
    powers = np.vander(x - x.mean(), 3)
    bases = (powers[:, 1:], powers)
    return np.array([np.sum((e - base @ np.linalg.lstsq(base, e)[0]) ** 2) for base in bases])


STEPS_OF_HALVING = 60
"""Halvings of an interval of ln dt: to rounding."""


def reach(
    knots: Sequence[tuple[float, float]],
    target: float,
    error_at: Callable[[float], float | None] = lambda dt_s: None,
) -> float | None:
    """The coarsest step at which, and at all finer ones, the error is at most ``target``.

    ``knots`` are (step, error), finest first; between two of them the error is that of
    ``error_at``, or where that is None a straight line in the logarithms. None where the finest
    error is over the target already, and where none is: the step is then outside of the knots.
    """
    pairs = itertools.pairwise(knots)
    rise = next((x for x in pairs if x[0][1] > target or x[1][1] >= target), None)
    if rise is None or rise[0][1] > target:
        return None
    (fine, below), (coarse, above) = rise
    low, high = math.log(fine), math.log(coarse)
    for _ in range(STEPS_OF_HALVING):
        middle = 0.5 * (low + high)
        dt_s = math.exp(middle)
        error = error_at(dt_s)
        if error is None:
            error = interpolate((fine, coarse), (below, above), dt_s) or 0.0
        low, high = (middle, high) if error <= target else (low, middle)
    return math.exp(low)


def interpolate(dt_s: Sequence[float], values: Sequence[float], at_s: float) -> float | None:
    """A positive quantity, such as the time per turn, at a step between measured ones.

    A straight line in the logarithms; None outside of the measured steps.
    """
    points = sorted(zip(dt_s, values, strict=True))
    for (fine, first), (coarse, second) in itertools.pairwise(points):
        if fine <= at_s <= coarse:
            if not (first > 0.0 and second > 0.0 and coarse > fine):
                return second if at_s == coarse else first
            part = math.log(at_s / fine) / math.log(coarse / fine)
            return math.exp((1.0 - part) * math.log(first) + part * math.log(second))
    return None
