"""Where a window first comes to a change of formula: looked for at its nodes, foretold between two
of them by interpolation, and found to rounding where it is asked for."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from analytic.free.kinks import Kinked
from models.array import Array

Formulas = Callable[[Array], list[Kinked]]
"""The formulas with kinks at times after the start of a window [s], (T,)."""
NEIGHBOURS = 3
"""Looks on either side that a crossing is foretold from."""
AROUND = np.concatenate(
    [-(10.0 ** np.arange(-3.0, -17.5, -0.5)), [0.0], 10.0 ** np.arange(-17.0, -2.5, 0.5)]
)
"""Looks about a crossing, over the time that is looked over."""
ROUNDS = 8
"""Of looking closer, each of which about doubles the digits."""


@dataclass(frozen=True)
class FormulaChange:
    """A first change of formula: between ``low_s`` and ``high_s``, and foretold at ``at_s`` [s]."""

    low_s: float
    high_s: float
    at_s: float


def first_crossing(rows: list[Kinked], looks: Array) -> FormulaChange | None:
    """The first one in formulas at looks [s], (T,); None where all are as at the first look."""
    if not rows:
        return None
    pieces = np.array([row.pieces for row in rows])
    changed = pieces != pieces[:, :1]
    if not changed.any():
        return None
    k = int(np.argmax(changed.any(axis=0)))
    low, high = float(looks[k - 1]), float(looks[k])
    at = min(_foretold(row, looks, k) for row, own in zip(rows, changed, strict=True) if own[k])
    return FormulaChange(low, high, min(max(at, low), high))


def precisely(formulas: Formulas, crossing: FormulaChange, first: float, least_s: float) -> float:
    """The time [s] at which the formulas of time ``first`` have just given way, to ``least_s``."""
    long_s = crossing.high_s
    for _ in range(ROUNDS):
        low, high = crossing.low_s, crossing.high_s
        if high - low <= least_s or np.nextafter(low, high) >= high:
            break
        near = crossing.at_s + long_s * AROUND
        near = near[(low < near) & (near < high)]
        looks = np.concatenate([[first], [low] if low > first else [], near, [high]])
        closer = first_crossing(formulas(looks), looks)
        if closer is None:  # within rounding of it
            break
        crossing = closer
    return crossing.high_s


def _foretold(row: Kinked, looks: Array, k: int) -> float:
    """When a formula comes to its kink, from the looks about: the time as a polynomial of what it
    goes over, where that goes one way, else by a straight line."""
    off = row.x - row.border(k)
    some = slice(max(k - NEIGHBOURS, 0), k + NEIGHBOURS)
    x, t = off[some], looks[some]
    steps = np.diff(x)
    if not (np.all(steps > 0.0) or np.all(steps < 0.0)):
        x, t = off[k - 1 : k + 1], looks[k - 1 : k + 1]
        if x[0] == x[1]:
            return float(t[1])
    values = t.copy()
    for n in range(1, len(x)):  # Neville's scheme at 0
        values = (x[n:] * values[:-1] - x[:-n] * values[1:]) / (x[n:] - x[:-n])
    return float(values[0])
