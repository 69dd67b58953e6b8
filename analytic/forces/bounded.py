"""Numbers and vectors of the plane that carry a bound of their own error.

Every operation adds the errors of its operands to first order and beyond, and its own rounding
(running error analysis: N. J. Higham, Accuracy and Stability of Numerical Algorithms, section 3.3),
so that a formula is written once. An error of None is not required, and no operation computes it.
"""

from __future__ import annotations

import numpy as np

from analytic.dyads.plane import EPS, ZERO, Real, Vec, cross_three, dot_three


class Bounded:
    """Number, and a bound of its error or None."""

    __slots__ = ("error", "value")

    def __init__(self, value: Real, error: Real | None = 0.0) -> None:
        self.value = value
        self.error = error

    def __add__(self, other: Bounded) -> Bounded:
        if self is NOUGHT:
            return other
        if other is NOUGHT:
            return self
        return _rounded(self.value + other.value, self, other)

    def __sub__(self, other: Bounded) -> Bounded:
        if other is NOUGHT:
            return self
        return _rounded(self.value - other.value, self, other)

    def __neg__(self) -> Bounded:
        return self if self is NOUGHT else Bounded(-self.value, self.error)

    def __mul__(self, other: Bounded) -> Bounded:
        if self is NOUGHT or other is NOUGHT:
            return NOUGHT
        value = self.value * other.value
        if self.error is None or other.error is None:
            return Bounded(value, None)
        error = np.abs(self.value) * other.error
        error = error + self.error * (np.abs(other.value) + other.error)
        return Bounded(value, error + EPS * np.abs(value))

    def inverse(self) -> Bounded:
        """Return 1 over it; nothing is certain where its error is as large as itself."""
        value = 1.0 / self.value
        if self.error is None:
            return Bounded(value, None)
        size = np.abs(self.value)
        left = size - self.error
        error = np.where(left > 0.0, (self.error / left + EPS) / size, np.inf)
        return Bounded(value, error)


def _rounded(value: Real, one: Bounded, other: Bounded) -> Bounded:
    """Return a sum or a difference of two, rounded."""
    if one.error is None or other.error is None:
        return Bounded(value, None)
    return Bounded(value, one.error + other.error + EPS * np.abs(value))


NOUGHT = Bounded(0.0)
"""Number that costs nothing to add; compare by identity."""


class BoundedVec:
    """Vector, its largest possible length, and a bound of the length of its error or None.

    ``size`` counts only where there is an error.
    """

    __slots__ = ("error", "size", "v")

    def __init__(self, v: Vec, size: Real, error: Real | None) -> None:
        self.v = v
        self.size = size
        self.error = error

    def __add__(self, other: BoundedVec) -> BoundedVec:
        if self is NOWHERE:
            return other
        if other is NOWHERE:
            return self
        return _sum(self.v + other.v, self, other)

    def __sub__(self, other: BoundedVec) -> BoundedVec:
        if other is NOWHERE:
            return self
        if self is NOWHERE:
            return -other
        return _sum(self.v - other.v, self, other)

    def __neg__(self) -> BoundedVec:
        return self if self is NOWHERE else BoundedVec(-self.v, self.size, self.error)

    def __mul__(self, factor: Bounded) -> BoundedVec:
        if self is NOWHERE or factor is NOUGHT:
            return NOWHERE
        v = self.v * factor.value
        if self.error is None or factor.error is None:
            return BoundedVec(v, 0.0, None)
        most = np.abs(factor.value) + factor.error
        size = self.size * most
        return BoundedVec(v, size, self.size * factor.error + most * self.error + EPS * size)

    def perp(self) -> BoundedVec:
        """Return the vector turned by +90 deg."""
        return self if self is NOWHERE else BoundedVec(self.v.perp(), self.size, self.error)

    def dot(self, other: BoundedVec) -> Bounded:
        if self is NOWHERE or other is NOWHERE:
            return NOUGHT
        return _product(self.v.dot(other.v), self, other)

    def cross(self, other: BoundedVec) -> Bounded:
        """Return the component of the cross product out of the plane."""
        if self is NOWHERE or other is NOWHERE:
            return NOUGHT
        return _product(self.v.cross(other.v), self, other)


def _sum(v: Vec, one: BoundedVec, other: BoundedVec) -> BoundedVec:
    if one.error is None or other.error is None:
        return BoundedVec(v, 0.0, None)
    size = v.norm()
    return BoundedVec(v, size, one.error + other.error + EPS * size)


def _product(value: Real, one: BoundedVec, other: BoundedVec) -> Bounded:
    """Return a dot or a cross product: each of its two terms is rounded, and their sum."""
    if one.error is None or other.error is None:
        return Bounded(value, None)
    error = one.size * other.error + one.error * (other.size + other.error)
    return Bounded(value, error + 2 * EPS * (one.size * other.size))


NOWHERE = BoundedVec(ZERO, 0.0, 0.0)
"""Vector that costs nothing to add; compare by identity."""

Three = tuple[Bounded, Bounded, Bounded]


def solved_three(columns: tuple[Three, Three, Three], given: Three) -> Three:
    """Return the x with columns x = -given, by Cramer's rule."""
    a, b, c = columns
    bc, ca, ab = cross_three(b, c), cross_three(c, a), cross_three(a, b)
    inverse = -dot_three(a, bc).inverse()
    x, y, z = (dot_three(given, one) * inverse for one in (bc, ca, ab))
    return x, y, z
