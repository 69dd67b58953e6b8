"""Lines cut to a box: of what is far larger than the paper, only what is on it is drawn."""

from __future__ import annotations

import math

import numpy as np

from models.array import Array

ROUND = 721
"""Places along a whole circle."""


def cut_line(places: Array, low: Array, high: Array) -> list[Array]:
    """The parts of a line through places (n, 2) that are in a box, each (k, 2) of two or more.

    A step from outside to outside that is longer than the box is wide and high is a jump of a curve
    that comes back from infinity, and is left out.
    """
    start, step = places[:-1], np.diff(places, axis=0)
    near, far = _shares(start, step, low, high)
    outside = (near > 0.0) & (far < 1.0)
    jump = outside & (np.hypot(*step.T) > math.dist(low, high)) & (len(places) > 2)
    parts: list[list[Array]] = []
    on = False  # whether the part before goes on
    for k in np.flatnonzero((near < far) & ~jump):
        first, last = start[k] + near[k] * step[k], start[k] + far[k] * step[k]
        on = on and near[k] == 0.0 and bool(np.array_equal(parts[-1][-1], start[k]))
        if not on:
            parts.append([first])
        # the next one begins exactly where this one ends
        parts[-1].append(places[k + 1] if far[k] == 1.0 else last)
        on = far[k] == 1.0
    return [np.array(part) for part in parts]


def _shares(start: Array, step: Array, low: Array, high: Array) -> tuple[Array, Array]:
    """Between which shares of their steps lines are in a box (Liang and Barsky), (n,) each."""
    with np.errstate(divide="ignore", invalid="ignore"):
        one, other = (low - start) / step, (high - start) / step
    within = (low <= start) & (start <= high)
    enters = np.where(step == 0.0, np.where(within, -np.inf, np.inf), np.minimum(one, other))
    leaves = np.where(step == 0.0, np.where(within, np.inf, -np.inf), np.maximum(one, other))
    return np.maximum(enters.max(axis=1), 0.0), np.minimum(leaves.min(axis=1), 1.0)


def near_angles(middle: Array, radius: float, low: Array, high: Array) -> tuple[float, float]:
    """Between which angles [rad] a circle may be in a box: of one that is far larger than the box,
    most is of no use, and slow to draw."""
    away = (low + high) / 2 - middle
    reach = math.dist(low, high) / 2
    half = math.asin(reach / radius) if radius > reach else math.pi
    angle = math.atan2(away[1], away[0])
    return angle - half, angle + half


def arc_places(middle: Array, radius: float, start: float, end: float) -> Array:
    """Places along an arc between two angles [rad], (n, 2), closely."""
    angle = np.linspace(start, end, ROUND)
    return np.asarray(middle + radius * np.stack([np.cos(angle), np.sin(angle)], axis=1))
