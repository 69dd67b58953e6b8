"""Between measured points: the step that reaches an error, and what was measured at it."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Sequence

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
