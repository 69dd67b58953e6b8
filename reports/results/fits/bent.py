"""Least squares of floor + C dt^p on the logarithms of errors, without a starting value.

A largest error over a run scatters by a share of itself, so residuals are taken of logarithms.
With y the step over the finest one the model is written

    error = E (1 + q (y^p - 1)),    floor = E (1 - q),    C = E q / finest^p

so that q, the share of the finest error that still falls with the step, is 1 without a floor, 0 for
an error that no step changes, and below 0 where the error comes up to its floor. The best E for
given p and q is a mean of logarithms; p and q are scanned.
"""

from __future__ import annotations

import math

import numpy as np

from models.array import Array
from reports.results.fits.curves import Allowed, Curve

ORDERS = np.linspace(0.3, 5.0, 48)
"""Orders that are tried for an error over a floor."""
LEAST_SHARE = 1e-9
"""Shares below this are none: an error that falls by nine decades to its floor fits."""
BELOW = -0.3
"""How far the finest error may be below a floor that it rises to, as a share of itself: more would
be a guess about steps that nobody ran."""


def bent(dt_s: Array, error: Array) -> Curve:
    """floor + C dt^p through three points or more (shape (n,))."""
    scan = _Scan(dt_s, error)
    near, width = ORDERS, ORDERS[1] - ORDERS[0]
    for _ in range(4):  # closer and closer around the best order
        units = scan.best(near)
        misfits = scan.misfit(near, units[:, None])[:, 0]
        best = int(np.argmin(misfits))
        order, unit, misfit = near[best], units[best], float(misfits[best])
        near = np.clip(order + np.linspace(-width, width, 11), ORDERS[0], ORDERS[-1])
        width /= 5.0
    level = math.exp(scan.level(np.array([order]), np.array([[unit]]))[0, 0])
    share, finest = float(_share(unit)), float(dt_s.min())
    coefficient = level * share / finest**order
    return Curve(
        float(order), level * (1.0 - share), float(coefficient), finest, misfit, len(error), 3
    )


def bent_within(dt_s: Array, error: Array, best: Curve, more: float) -> Allowed:
    """Orders and floors of all curves whose misfit is at most that of ``best`` and ``more``."""
    scan, limit = _Scan(dt_s, error), best.misfit + more
    orders = np.union1d(ORDERS, [best.order])
    for _ in range(3):  # closer and closer around the orders that are allowed
        good = np.flatnonzero(scan.misfit(orders, scan.best(orders)[:, None])[:, 0] <= limit)
        if not good.size:
            break
        low, high = max(good[0] - 1, 0), min(good[-1] + 1, len(orders) - 1)
        orders = np.union1d(np.linspace(orders[low], orders[high], 31), [best.order])
    steps = np.geomspace(1e-3, 2.0 * _HIGH, 40)
    offsets = np.concatenate([-steps[::-1], [0.0], steps])
    tried = (scan.best(orders)[:, None] + offsets).clip(_LOW, _HIGH)
    slack = limit - scan.misfit(orders, tried)
    at, _ = inside = np.nonzero(slack >= 0.0)
    if not at.size:
        return Allowed((best.order, best.order), (best.floor, best.floor))
    free = np.sqrt(slack[inside] / len(error))  # E alone may be off by so much
    level, rest = scan.level(orders, tried)[inside], 1.0 - _share(tried[inside])
    return Allowed(
        (float(orders[at].min()), float(orders[at].max())),
        (float((rest * np.exp(level - free)).min()), float((rest * np.exp(level + free)).max())),
    )


class _Scan:
    """Level ln E and misfit for orders (shape (k,)) and scanning units of shares (shape (k, m))."""

    def __init__(self, dt_s: Array, error: Array) -> None:
        self._x = np.log(dt_s / dt_s.min())
        self._e = np.log(error)

    def level(self, orders: Array, units: Array) -> Array:
        return np.asarray(self._rest(orders, units).mean(axis=-1))

    def misfit(self, orders: Array, units: Array) -> Array:
        rest = self._rest(orders, units)
        good = np.asarray(np.isfinite(rest).all(axis=-1))
        rest = np.where(good[:, :, None], rest, 0.0)
        away = rest - rest.mean(axis=-1, keepdims=True)
        return np.where(good, np.sum(away**2, axis=-1), np.inf)

    def best(self, orders: Array) -> Array:
        """The unit with the least misfit for each order, shape (k,)."""
        middle = np.full(len(orders), 0.5 * (_LOW + _HIGH))
        width = 0.5 * (_HIGH - _LOW)
        for number in (41, 11, 11, 11, 11):
            tried = (middle[:, None] + np.linspace(-width, width, number)).clip(_LOW, _HIGH)
            misfit = self.misfit(orders, tried)
            middle = np.take_along_axis(tried, misfit.argmin(axis=1)[:, None], axis=1)[:, 0]
            width = 2.0 * width / (number - 1)
        return middle

    def _rest(self, orders: Array, units: Array) -> Array:
        """ln(error / (1 + q (y^p - 1))), shape (k, m, n); infinite where that is not positive."""
        rise = np.expm1(orders[:, None] * self._x)
        curve = _share(units)[:, :, None] * rise[:, None, :]
        bad = curve <= -1.0
        return np.where(bad, np.inf, self._e - np.log1p(np.where(bad, 0.0, curve)))


def _share(units: Array) -> Array:
    """The share q of scanning units: evenly spaced in ln |q| on both sides of 0."""
    return np.asarray(LEAST_SHARE * np.sinh(units))


_LOW, _HIGH = math.asinh(BELOW / LEAST_SHARE), math.asinh(1.0 / LEAST_SHARE)
