"""Starts for a path with timing: which shapes fit, with the best place and size of each.

Of P_j = O + G a exp(i phi_j) + Q u(phi_j) the first two terms span the same plane for all
four-bars, as the angles phi_j are given but for their start. What they leave of the points, y, and
of the coupler's direction, w, tells the rest: the least sum of squares is |y|^2 - |w* y|^2 / |w|^2.
That is one product for a shape and a start of the crank, so that tens of thousands are looked at.
"""

from __future__ import annotations

import math

import numpy as np

from analytic.lectures.synthesis.path.atlas import between, spread
from analytic.lectures.synthesis.path.fit import LARGEST, Fitted, placed
from analytic.lectures.synthesis.path.task import UnitPath
from analytic.lectures.synthesis.path.unit_four_bar import (
    BOUNDS,
    FULL,
    Complexes,
    Family,
    direction,
    lengths,
)
from models.array import Array

LOOKS = 16000
"""Shapes, each with a start of the crank, of a family and an assembly."""
BLOCK = 4000
"""That are looked at together."""
APART = 0.12
"""Of the box of shapes and starts: starts that are nearer lead to the same fit, mostly."""


def timed_starts(path: UnitPath, count: int, seed: int, *, limited: bool) -> list[Fitted]:
    """The best shapes of either assembly for points with timing, the best first; with ``limited``
    also those whose crank does not turn fully."""
    families = (*FULL, "limited") if limited else FULL
    found = [
        each
        for mirrored in (False, True)
        for family in families
        for each in _best(path.mirrored if mirrored else path, family, count, seed, mirrored)
    ]
    found.sort(key=lambda each: each.cost)
    return found[:count]


def _best(path: UnitPath, family: Family, count: int, seed: int, mirrored: bool) -> list[Fitted]:
    """Those of one family, spread over its box."""
    share = spread(LOOKS, 4, seed)
    x, start = between(share[:, :3], BOUNDS[family]), math.tau * share[:, 3]
    cost = np.concatenate(
        [
            _costs(path, family, x[:, k : k + BLOCK], start[k : k + BLOCK])
            for k in range(0, LOOKS, BLOCK)
        ]
    )
    kept: list[int] = []
    for k in np.argsort(cost, kind="stable")[: 20 * count].tolist():
        off = np.abs(share[kept] - share[k])
        off[:, 3] = np.minimum(off[:, 3], 1.0 - off[:, 3])  # the start of a crank is an angle
        if np.isfinite(cost[k]) and not np.any(np.max(off, axis=1) < APART):
            kept.append(k)
        if len(kept) == count:
            break
    return [_start(path, family, x[:, k], float(start[k]), float(cost[k]), mirrored) for k in kept]


def _costs(path: UnitPath, family: Family, x: Array, start: Array) -> Array:
    """The least sums of squares, inf where the mechanism is too large or does not close."""
    assert path.turned is not None
    crank = np.exp(1j * path.turned)
    common, triangle = np.linalg.qr(np.stack([np.ones_like(crank), crank], axis=1))
    a, b, c = (each[:, None] for each in lengths(family, x))
    u, cosine = direction((a, b, c), start[:, None] + path.turned)
    y, w = _left(path.points[None], common)[0], _left(u, common)
    square = np.sum(np.abs(w) ** 2, axis=1)
    product = w.conj() @ y
    arm = product / np.maximum(square, 1e-12)
    cost = np.sum(np.abs(y) ** 2) - np.abs(product) ** 2 / np.maximum(square, 1e-12)
    ground = ((path.points - arm[:, None] * u) @ common[:, 1].conj()) / (triangle[1, 1] * a[:, 0])
    bad = (
        (np.abs(arm) > LARGEST)
        | (np.abs(ground) > LARGEST)
        | (np.max(np.abs(cosine), axis=1) >= 1.0)
    )
    return np.where(bad, np.inf, cost)


def _left(rows: Complexes, common: Complexes) -> Complexes:
    """What is left of rows (E, N) outside the plane of two columns (N, 2)."""
    return np.asarray(rows - (rows @ common.conj()) @ common.T)


def _start(
    path: UnitPath, family: Family, x: Array, start: float, cost: float, mirrored: bool
) -> Fitted:
    assert path.turned is not None
    phi = start + path.turned
    return Fitted(family, x, placed(lengths(family, x), phi, path.points), phi, cost, mirrored)
