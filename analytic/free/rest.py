"""A machine at rest: which way it leaves, and when."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from analytic.free.window import Acceleration
from models.array import Array

LOOKS, LOOKED = 257, 7
"""Instants at which an end of rest is looked for, and how often between two of them."""
TINY = 1e-150
"""A rate that only says which way the machine is about to move."""


def way_out(acceleration: Acceleration, at: float, time_s: Array) -> Array:
    """Which way a machine leaves its rest at a coordinate, 0 where it is held, at times [s], (T,).

    Where a load on one stroke lets it leave both ways, that in which it is pushed without: at
    rest no stroke has begun.
    """
    u, v = np.full_like(time_s, at), np.full_like(time_s, TINY)
    ahead = acceleration(time_s, u, v)
    back = acceleration(time_s, u, -v)
    way = np.where(ahead > 0.0, 1.0, np.where(back < 0.0, -1.0, 0.0))
    either = (ahead > 0.0) & (back < 0.0)
    if either.any():
        still = acceleration(time_s, u, np.zeros_like(v))
        way[either & (still < 0.0)] = -1.0
    return way


def rest_until(way: Callable[[Array], Array], low: float, high: float) -> float:
    """When the rest since ``low`` ends, ``high`` at the latest [s]."""
    for _ in range(LOOKED):
        looks = np.linspace(low, high, LOOKS)
        moved = np.flatnonzero(way(looks[1:]) != 0.0)
        if not moved.size:
            break
        k = int(moved[0])
        low, high = float(looks[k]), float(looks[k + 1])
    return high
