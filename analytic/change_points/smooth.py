"""The smooth motion through a change point, by interpolation from both sides of it.

::

            . o  o   o     o       q, q', q'' of an unknown of the dyad at Chebyshev nodes, q by the
        o o                        driver's angle; none of them is in the change point, and all
    o       |  window  |           lie on the branch that passes it smoothly

On that branch the unknowns are analytic functions of the driver's angle, also where the formulas
of the dyad say 0/0. Source of the interpolation and of its stability: J.-P. Berrut and L. N.
Trefethen, Barycentric Lagrange interpolation, SIAM Review 46 (2004), section 5 and 7.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from analytic.dyads.parts import First, SlideError, Sliding, Turning
from analytic.dyads.plane import EPS, AngleError, Real, Vec
from models.array import Array

COUNT, FEWER = 24, 20
"""Nodes of an interpolation, and of the one that it is compared with; even, so none is central."""
PROBES = np.linspace(-1.0, 1.0, 32)
SAFETY = 2.0

Index = NDArray[np.intp]
Unknown = Turning | Sliding
Solved = Callable[[Array], tuple[Unknown, Unknown]]
"""The two unknowns of a dyad at driver angles, per unit speed of the driver, with bounds."""


def nodes(count: int) -> Array:
    """Chebyshev nodes of the first kind in (-1, 1), increasing."""
    return np.asarray(-np.cos((2 * np.arange(count) + 1) * (np.pi / (2 * count))))


WINDOW = 0.99 * float(nodes(COUNT)[COUNT // 2])
"""Half of the gap in the middle of the nodes, or hardly less, over half their range."""


def weights(count: int, x: Array) -> Array:
    """The value at places ``x``, none of them a node, as weights of the values at the nodes."""
    places = np.arange(count)
    one = (-1.0) ** places * np.sin((2 * places + 1) * (np.pi / (2 * count)))
    terms = one / (x[:, None] - nodes(count))
    return np.asarray(terms / terms.sum(axis=1, keepdims=True))


@dataclass(frozen=True)
class Interpolant:
    """An unknown with its first two derivatives by the driver's angle.

    ``values`` and ``bounds`` are those at the nodes, (3, n); ``doubt`` is what interpolation may
    add, (3,), and ``third`` bounds the third derivative in the window.
    """

    values: Array
    bounds: Array
    doubt: Array
    third: float

    @staticmethod
    def of(
        fine: tuple[Array, Array], coarse: tuple[Array, Array], half: float, *, turning: bool
    ) -> Interpolant:
        """The series of one set of nodes, held to that of another; angles but for whole turns."""
        values, bounds = fine
        at = PROBES * WINDOW
        seen = values @ weights(COUNT, at).T
        apart = seen - coarse[0] @ weights(FEWER, at).T
        if turning:
            apart[0] -= 2.0 * np.pi * np.round(apart[0] / (2.0 * np.pi))
        doubt = np.abs(apart).max(axis=1)
        doubt = SAFETY * doubt + COUNT * EPS * np.abs(values).max(axis=1)
        third = np.abs(np.diff(seen[2])).max() / (half * WINDOW * float(PROBES[1] - PROBES[0]))
        return Interpolant(
            values, bounds, doubt, SAFETY * float(third + doubt[2] / (half * WINDOW))
        )

    def worst(self) -> Array:
        """The largest bounds in the window, (3,)."""
        share = np.abs(weights(COUNT, PROBES * WINDOW))
        return np.asarray((self.bounds @ share.T).max(axis=1) + self.doubt)

    def at(self, x: Array, speed: Rates) -> tuple[tuple[Array, ...], tuple[Array, ...]]:
        """The unknown, its rate and acceleration, and their bounds, at places in (-1, 1)."""
        share = weights(COUNT, x)
        q, q1, q2 = self.values @ share.T
        b, b1, b2 = self.bounds @ np.abs(share).T + self.doubt[:, None]
        w, g, e = np.abs(speed.omega), np.abs(speed.alpha), speed.error
        # The driver's angle is uncertain too: over e.theta each derivative changes by the next.
        s1, s2 = np.abs(q1) + b1, np.abs(q2) + b2
        b, b1, b2 = b + s1 * e.theta, b1 + s2 * e.theta, b2 + self.third * e.theta
        rate = (w + e.omega) * b1 + s1 * e.omega
        second = (g + e.alpha) * b1 + s1 * e.alpha + (w + e.omega) ** 2 * b2
        second = second + s2 * e.omega * (2.0 * w + e.omega)
        found = q, q1 * speed.omega, q1 * speed.alpha + q2 * speed.omega**2
        sizes = 1.0 + np.abs(q), s1 * w, s2 * w**2 + s1 * g
        bounds = (b, rate, second)
        return found, tuple(e + 4 * EPS * k for e, k in zip(bounds, sizes, strict=True))


@dataclass(frozen=True)
class Rates:
    """The driver's rate and acceleration at some samples, with the bounds of all three levels."""

    omega: Array
    alpha: Array
    error: AngleError


@dataclass(frozen=True)
class Piece:
    """The two unknowns of a dyad around a change point.

    ``half`` is half the range of the nodes; ``doubt`` is the largest bound of a derivative by the
    driver's angle over that derivative, or over 1 and the longest length of the scene.
    """

    half: float
    first: Interpolant
    second: Interpolant
    doubt: float

    @property
    def window(self) -> float:
        """How far from the change point it is used [rad]."""
        return self.half * WINDOW

    @staticmethod
    def of(solved: Solved, centre: float, half: float, longest_m: float) -> Piece:
        """The piece around the driver angle ``centre``. Raises OpenError at nodes out of reach."""
        wide, narrow = centre + half * nodes(COUNT), centre + half * nodes(FEWER)
        series: list[Interpolant] = []
        doubt = 0.0
        for fine, coarse in zip(solved(wide), solved(narrow), strict=True):
            turning = isinstance(fine, Turning)
            found = Interpolant.of(
                _levels(fine, wide), _levels(coarse, narrow), half, turning=turning
            )
            sizes = np.abs(found.values).max(axis=1) + (1.0 if turning else longest_m)
            doubt = max(doubt, float((found.worst() / sizes)[1:].max()))
            series.append(found)
        return Piece(half, series[0], series[1], doubt)


def _levels(found: Unknown, theta: Array) -> tuple[Array, Array]:
    """Values and bounds of an unknown at the nodes, each (3, n); angles without jumps."""
    assert found.error is not None
    if isinstance(found, Sliding):
        e = found.error
        rows = [found.s, found.speed, found.acceleration, e.displacement, e.speed, e.acceleration]
    else:
        angle = np.arctan2(found.turn.y, found.turn.x)
        # Whole turns that the rate at both ends of a step does not account for are jumps.
        step = np.diff(angle) - 0.5 * np.diff(theta) * (found.omega[1:] + found.omega[:-1])
        angle[1:] -= np.cumsum(np.round(step / (2.0 * np.pi))) * (2.0 * np.pi)
        turn = found.error.theta + 2 * EPS * (np.abs(angle) + np.pi)
        rows = [angle, found.omega, found.alpha, turn, found.error.omega, found.error.alpha]
    table = np.stack([np.broadcast_to(row, theta.shape) for row in rows])
    return table[:3], table[3:]


def put(
    unknown: First,
    shape: tuple[int, ...],
    index: Index,
    values: tuple[Array, ...],
    bounds: tuple[Array, ...],
) -> First:
    """An unknown over all samples, its values and bounds at those of ``index`` replaced."""

    def into(old: Real, new: Array) -> Array:
        array = np.array(np.broadcast_to(old, shape))
        array[index] = new
        return array

    if isinstance(unknown, Sliding):
        s, speed, acceleration = map(into, (unknown.s, unknown.speed, unknown.acceleration), values)
        e = unknown.error
        if e is not None:
            e = SlideError(*map(into, (e.displacement, e.speed, e.acceleration), bounds))
        return Sliding(s, speed, acceleration, e)
    angle, length, error = values[0], unknown.length, unknown.error
    x = into(unknown.turn.x, length * np.cos(angle))
    y = into(unknown.turn.y, length * np.sin(angle))
    omega, alpha = map(into, (unknown.omega, unknown.alpha), values[1:])
    if error is not None:
        error = AngleError(*map(into, (error.theta, error.omega, error.alpha), bounds))
    return Turning(Vec(x, y), omega, alpha, error, length)
