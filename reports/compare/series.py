"""Error series: of an angle, differenced over time, and how large it is and where."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from models.array import Array


@dataclass(frozen=True)
class Size:
    """How large an error series is, in the unit of the series.

    ``maximum`` is NaN as soon as one sample is not finite: a number that is missing is a failure,
    not a sample to leave out. ``index`` is where the maximum stands, or the first such sample.
    """

    maximum: float
    rms: float
    final: float
    index: int


def size(series: Array) -> Size:
    """Maximum, root mean square and last value of the magnitude of ``series`` (T,)."""
    magnitude = np.abs(series)
    index = int(np.argmax(magnitude))  # the first NaN, where there is one
    largest = float(magnitude[index])
    if not math.isfinite(largest):
        broken = int(np.flatnonzero(~np.isfinite(series))[0])
        return Size(math.nan, math.nan, float(series[-1]), broken)
    # Squares of the pure ratio: no overflow for an engine that has run away.
    rms = largest * float(np.sqrt(np.mean((magnitude / largest) ** 2))) if largest > 0.0 else 0.0
    return Size(largest, rms, float(magnitude[-1]), index)


def angle_error(engine: Array, reference: Array) -> Array:
    """Difference of two continuous angles [rad], less the whole turns that it starts with.

    The engine may count turns from elsewhere; after the first sample a whole turn is an error, at
    one sample alone as well.
    """
    error = engine - reference
    first = float(error[0]) / math.tau if error.size else 0.0
    turns = float(np.round(first)) if math.isfinite(first) else 0.0
    return np.asarray(error - math.tau * turns)


def length(vectors: Array) -> Array:
    """Euclidean length of each row of (T, 2); of a (T,) series its magnitude."""
    return np.hypot(vectors[:, 0], vectors[:, 1]) if vectors.ndim == 2 else np.abs(vectors)


def rate(error: Array, step_s: float) -> Array:
    """First derivative by central differences; the two ends are dropped.

    The derivative of the *error* is the difference of the two differenced motions: the truncation
    of the formula, the same for engine and reference, cancels, and what is left is the engine's.
    """
    return np.asarray((error[2:] - error[:-2]) / (2.0 * step_s))


def second_rate(error: Array, step_s: float) -> Array:
    """Second derivative by central differences; the two ends are dropped."""
    return np.asarray((error[2:] - 2.0 * error[1:-1] + error[:-2]) / step_s**2)
