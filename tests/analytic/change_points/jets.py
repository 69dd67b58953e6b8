"""Numbers of fifty digits that carry their first and second derivative by time.

The oracle writes each mechanism as an explicit formula of such numbers; its velocities and
accelerations then follow by the rules of differentiation alone, and no Jacobian is ever formed.
"""

from __future__ import annotations

from typing import Any

from mpmath import mp, mpf

mp.dps = 50

Number = Any
"""An mpf, or anything that it computes with exactly (float, int)."""


class Jet:
    """A value with its first and second derivative by time."""

    __slots__ = ("rate", "second", "value")

    def __init__(self, value: Number, rate: Number = 0, second: Number = 0) -> None:
        self.value, self.rate, self.second = mpf(value), mpf(rate), mpf(second)

    def __add__(self, other: Jet | Number) -> Jet:
        if not isinstance(other, Jet):
            return _made(self.value + other, self.rate, self.second)
        return _made(self.value + other.value, self.rate + other.rate, self.second + other.second)

    __radd__ = __add__

    def __neg__(self) -> Jet:
        return _made(-self.value, -self.rate, -self.second)

    def __sub__(self, other: Jet | Number) -> Jet:
        return self + (-other)

    def __rsub__(self, other: Number) -> Jet:
        return (-self) + other

    def __mul__(self, other: Jet | Number) -> Jet:
        if not isinstance(other, Jet):
            return _made(self.value * other, self.rate * other, self.second * other)
        a, b = self, other
        return _made(
            a.value * b.value,
            a.rate * b.value + a.value * b.rate,
            a.second * b.value + 2 * (a.rate * b.rate) + a.value * b.second,
        )

    __rmul__ = __mul__

    def __truediv__(self, other: Jet | Number) -> Jet:
        if not isinstance(other, Jet):
            return _made(self.value / other, self.rate / other, self.second / other)
        value = self.value / other.value
        rate = (self.rate - value * other.rate) / other.value
        second = (self.second - 2 * rate * other.rate - value * other.second) / other.value
        return _made(value, rate, second)

    def through(self, value: Number, slope: Number, bend: Number) -> Jet:
        """A function of this number, given with its first and second derivative by it."""
        return _made(value, slope * self.rate, slope * self.second + bend * self.rate**2)


def _made(value: Number, rate: Number, second: Number) -> Jet:
    """A jet of numbers of fifty digits, which are not rounded again."""
    jet = Jet.__new__(Jet)
    jet.value, jet.rate, jet.second = value, rate, second
    return jet


UNKNOWN = mpf("nan")
"""The rate of what has none: the square root of a number that passes zero."""


def sqrt(a: Jet) -> Jet:
    """The root, 0 without derivatives where the number is not above 0."""
    if a.value <= 0:
        return Jet(0, UNKNOWN, UNKNOWN)
    root = mp.sqrt(a.value)
    return a.through(root, 1 / (2 * root), -1 / (4 * root * a.value))


def cos_sin(a: Jet) -> tuple[Jet, Jet]:
    c, s = mp.cos_sin(a.value)
    return a.through(c, -s, -c), a.through(s, c, -s)


def cos(a: Jet) -> Jet:
    return cos_sin(a)[0]


def sin(a: Jet) -> Jet:
    return cos_sin(a)[1]


def acos(a: Jet) -> Jet:
    """Without derivatives at the ends of its range, and held there beyond them."""
    if abs(a.value) >= 1:
        return Jet(mp.acos(mp.sign(a.value)), UNKNOWN, UNKNOWN)
    root = mp.sqrt((1 - a.value) * (1 + a.value))
    return a.through(mp.acos(a.value), -1 / root, -a.value / root**3)


def atan2(y: Jet, x: Jet) -> Jet:
    square = x.value * x.value + y.value * y.value
    turn = x.value * y.rate - y.value * x.rate
    rate = turn / square
    second = x.value * y.second - y.value * x.second
    second -= 2 * rate * (x.value * x.rate + y.value * y.rate)
    return Jet(mp.atan2(y.value, x.value), rate, second / square)
