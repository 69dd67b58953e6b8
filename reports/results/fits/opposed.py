"""Least squares of a floor and a part C dt^p that do not point the same way.

The square of the error (`reports.results.fits.curves`) is floor^2 + b y^p + c y^(2 p), with y the
step over the finest one: linear in three numbers for each order, and the order is scanned.
Residuals are half the relative ones of the square, which for a small scatter are those of the
logarithm.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from models.array import Array
from reports.results.fits.curves import Allowed, Curve

ORDERS = np.linspace(0.5, 3.0, 101)


@dataclass(frozen=True)
class _Scan:
    """For each of `ORDERS` (k of them): floor^2, b, c (shape (k, 3)), the misfit (shape (k,),
    infinite where the numbers are no alignment between -1 and 1), and the variance of floor^2 for
    unit misfit (shape (k,))."""

    squares: Array
    misfit: Array
    variance: Array


def opposed(dt_s: Array, error: Array) -> Curve | None:
    """The curve through four points or more (shape (n,)); None where there is none."""
    scan = _scan(dt_s, error)
    best = int(np.argmin(scan.misfit))
    if not math.isfinite(scan.misfit[best]):
        return None
    floor, step = np.sqrt(scan.squares[best, [0, 2]])
    finest, order = float(dt_s.min()), float(ORDERS[best])
    alignment = float(scan.squares[best, 1] / (2.0 * floor * step))
    return Curve(
        order,
        float(floor),
        float(step) / finest**order,
        finest,
        float(scan.misfit[best]),
        len(error),
        4,
        alignment,
    )


def opposed_within(dt_s: Array, error: Array, best: Curve, more: float) -> Allowed:
    """Orders and floors of all curves whose misfit is at most that of ``best`` and ``more``."""
    scan = _scan(dt_s, error)
    slack = best.misfit + more - scan.misfit
    good = slack >= 0.0
    half = 2.0 * np.sqrt(slack[good] * scan.variance[good])
    square = scan.squares[good, 0]
    return Allowed(
        (float(ORDERS[good].min()), float(ORDERS[good].max())),
        (
            math.sqrt(max(float((square - half).min()), 0.0)),
            math.sqrt(float((square + half).max())),
        ),
    )


def _scan(dt_s: Array, error: Array) -> _Scan:
    powers = (dt_s / dt_s.min()) ** ORDERS[:, None]
    base = np.stack([np.ones_like(powers), powers, powers**2], axis=-1) / error[:, None] ** 2
    size = np.linalg.norm(base, axis=1)
    inverse = np.linalg.pinv(base / size[:, None, :])
    squares = inverse.sum(axis=-1) / size
    misfit = np.sum((np.einsum("kni,ki->kn", base, squares) - 1.0) ** 2, axis=-1) / 4.0
    floor, cross, step = squares.T
    possible = (floor > 0.0) & (step > 0.0) & (cross**2 <= 4.0 * floor * step)
    variance = np.sum(inverse[:, 0, :] ** 2, axis=-1) / size[:, 0] ** 2
    return _Scan(squares, np.where(possible, misfit, np.inf), variance)
