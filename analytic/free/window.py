"""One window of time, solved by Gauss' collocation and Newton's method.

::

    t0   o    o      o      o    o   t0 + h      the polynomial of degree n - 1 that is a(t, u, u')
                                                 at the n nodes; u and u' are its integrals

The end of a window is of order 2 n, its inside of order n. Polynomials are kept by their
coefficients in Legendre's, whose decay shows whether a window is short enough. Source: E. Hairer,
S. P. Norsett, G. Wanner, Solving Ordinary Differential Equations I, section II.7.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np
from numpy.polynomial import legendre

from models.array import Array


@dataclass(frozen=True)
class Gauss:
    """Rule of n nodes in (0, 1), ``places``: ``once`` and ``twice`` (n, n) integrate values at the
    nodes from 0 to the nodes, ``end_once`` and ``end_twice`` (n,) to 1; ``series`` (n, n) makes
    coefficients of them, which ``lift_once`` (n + 1, n) and ``lift_twice`` (n + 2, n) integrate."""

    places: Array
    once: Array
    twice: Array
    end_once: Array
    end_twice: Array
    series: Array
    lift_once: Array
    lift_twice: Array

    @property
    def count(self) -> int:
        return len(self.places)


@lru_cache(maxsize=8)
def gauss(count: int) -> Gauss:
    """Return the rule of ``count`` nodes."""
    x, w = legendre.leggauss(count)
    orders = np.arange(count)
    # Gauss' rule is exact for products of two of these polynomials.
    series = (orders[:, None] + 0.5) * legendre.legvander(x, count - 1).T * w
    lift_once = _integral(count)
    lift_twice = _integral(count + 1) @ lift_once
    once = legendre.legvander(x, count) @ lift_once @ series
    twice = legendre.legvander(x, count + 1) @ lift_twice @ series
    end_once = lift_once.sum(axis=0) @ series  # each polynomial is 1 at the end
    end_twice = lift_twice.sum(axis=0) @ series
    return Gauss(0.5 * (x + 1.0), once, twice, end_once, end_twice, series, lift_once, lift_twice)


def _integral(count: int) -> Array:
    """Return the matrix that integrates Legendre's polynomials over [0, 1], from 0."""
    table = np.zeros((count + 1, count))
    for k in range(count):
        table[: k + 2, k] = 0.5 * legendre.legint(np.eye(count)[k], lbnd=-1)[: k + 2]
    return table


def sums(coefficients: Array, share: Array) -> Array:
    """Return the values of series (..., n) at shares of their windows that broadcast with (...,),
    by Clenshaw's recurrence."""
    x = 2.0 * share - 1.0
    one, two = np.zeros_like(x), np.zeros_like(x)
    for k in range(coefficients.shape[-1] - 1, 0, -1):
        one, two = (
            coefficients[..., k] + (2 * k + 1) / (k + 1) * x * one - (k + 1) / (k + 2) * two,
            one,
        )
    return np.asarray(coefficients[..., 0] + x * one - 0.5 * two)


Acceleration = Callable[[Array, Array, Array], Array]
"""u'' at times, coordinates and rates, (T,)."""
MOST_ROUNDS = 14
NUDGE = 1e-6
"""Change of coordinates and rates, over their scale, for the derivatives of the acceleration."""
STALLED = 1e-11
"""Change of the acceleration, over its largest, that is rounding where it no longer shrinks."""
SLOW = 1e-6
"""Movement of the coordinate in a window, below which it is resolved no further."""


@dataclass(frozen=True)
class Scale:
    """Scale of a motion: its coordinate (at least 1), its rate."""

    u: float
    v: float


@dataclass(frozen=True)
class WindowSolution:
    """Solved window: accelerations at the nodes, and u, u' at its end; best values where Newton's
    method has not ``converged``."""

    rule: Gauss
    long_s: float
    u0: float
    v0: float
    a: Array
    end: tuple[float, float]
    by_u: Array
    by_v: Array
    converged: bool

    def after(self, lasts_s: float) -> tuple[float, float]:
        """Return u and u' a while after the start [s]: at the end, or hardly beyond it."""
        if lasts_s == self.long_s:
            return self.end
        u, v = self.at(np.array([lasts_s]))[:, 0]
        return float(u), float(v)

    def at(self, after_s: Array) -> Array:
        """Return u and u' at times after the start [s], (2, T)."""
        u, v, _ = self.series
        both = np.zeros((2, 1, u.size))
        both[0, 0], both[1, 0, : v.size] = u, v
        return sums(both, after_s / self.long_s)

    @cached_property
    def series(self) -> tuple[Array, Array, Array]:
        """Coefficients of u, u', u''."""
        h, own = self.long_s, self.rule.series @ self.a
        v = h * (self.rule.lift_once @ own)
        v[0] += self.v0
        u = h * h * (self.rule.lift_twice @ own)
        u[:2] += self.u0 + 0.5 * h * self.v0, 0.5 * h * self.v0
        return u, v, own

    def excess(self, scale: Scale) -> float:
        """Return the truncation of the polynomials over the allowed one, at most 1."""
        own, h, n = np.abs(self.series[2]), self.long_s, self.rule.count
        tail = float(max(own[-1], own[-2]))
        rate = max(scale.v, abs(self.v0), SLOW * scale.u / h)
        room = min(4e-15 * n * n * scale.u / h**2, 2e-14 * n * rate / h)
        return tail / room

    def changes(self) -> tuple[Array, Array]:
        """Return the derivatives of u and u' at the end by those at the start, (2, 2), and of u at
        the nodes, (2, n): the columns, and rows, belong to a start that is off in u, and in u'."""
        h, rule = self.long_s, self.rule
        matrix = _matrix(rule, h, self.by_u, self.by_v)
        sides = np.stack([self.by_u, self.by_u * h * rule.places + self.by_v], axis=1)
        a = np.linalg.solve(matrix, sides)
        end_u = np.array([1.0, h]) + h * h * rule.end_twice @ a
        end_v = np.array([0.0, 1.0]) + h * rule.end_once @ a
        within = np.stack([np.ones(rule.count), h * rule.places]) + h * h * (rule.twice @ a).T
        return np.stack([end_u, end_v]), within


def _matrix(rule: Gauss, h: float, by_u: Array, by_v: Array) -> Array:
    """Return the matrix of Newton's method for the accelerations at the nodes."""
    return np.asarray(
        np.eye(rule.count) - h * h * by_u[:, None] * rule.twice - h * by_v[:, None] * rule.once
    )


def solve_window(
    rule: Gauss,
    acceleration: Acceleration,
    start: tuple[float, float, float],
    long_s: float,
    first: Array,
    scale: Scale,
) -> WindowSolution | None:
    """Solve a window from ``start`` (time, u, u'); None where it has no solution.

    ``first`` is the initial guess of the accelerations at the nodes. Raises whatever
    ``acceleration`` raises.
    """
    time_s, u0, v0 = start
    h, n, a = long_s, rule.count, first
    times = np.tile(time_s + h * rule.places, 3)
    before, converged = np.inf, False
    for _ in range(MOST_ROUNDS):
        u = u0 + h * (rule.places * v0) + h * h * (rule.twice @ a)
        v = v0 + h * (rule.once @ a)
        off_u = NUDGE * scale.u
        # Away from rest, where friction and strokes change.
        off_v = np.copysign(NUDGE * max(scale.v, float(np.abs(v).max()), 1e-9), v)
        found = acceleration(
            times, np.concatenate([u, u + off_u, u]), np.concatenate([v, v, v + off_v])
        )
        if not np.isfinite(found).all():
            return None
        by_u, by_v = (found[n : 2 * n] - found[:n]) / off_u, (found[2 * n :] - found[:n]) / off_v
        step = np.linalg.solve(_matrix(rule, h, by_u, by_v), found[:n] - a)
        a = a + step
        change = float(np.abs(step).max())
        size = max(float(np.abs(a).max()), float(np.abs(v).max()) / h, SLOW * scale.u / h**2)
        stalled = change <= STALLED * size and change > 0.25 * before
        # The rest shrinks at least as in this round: no other one confirms it.
        left = change * min(change / before, 1.0) if math.isfinite(before) else change
        if converged := change <= 1e-15 * size or left <= 1e-17 * size or stalled:
            break
        before = change
    end_v = v0 + h * float(rule.end_once @ a)
    end_u = u0 + (h * v0 + h * h * float(rule.end_twice @ a))
    return WindowSolution(rule, h, u0, v0, a, (end_u, end_v), by_u, by_v, converged)
