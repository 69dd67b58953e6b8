"""Complex numbers that vary in time: value, first and second derivative, with bounds of errors.

A product has its derivatives by Leibniz's rule. Every operation adds the errors of its operands, to
first order and beyond, and its own rounding (running error analysis: N. J. Higham, Accuracy and
Stability of Numerical Algorithms, section 3.3).
"""

from __future__ import annotations

from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from analytic.dyads.plane import EPS, BodyKinematics, Real
from models.array import Array

Complex = NDArray[np.complex128]
Number = TypeVar("Number", Array, Complex)


class Varying:
    """Number with two derivatives by time, (3, ...), and bounds of the moduli of their errors."""

    __slots__ = ("error", "value")

    def __init__(self, value: Complex, error: Array) -> None:
        self.value = value
        self.error = error

    @staticmethod
    def constant(value: complex, error: float = 0.0) -> Varying:
        """Return a number that is the same at all times."""
        return Varying(np.array([[value], [0], [0]], complex), np.array([[error], [0.0], [0.0]]))

    @staticmethod
    def of(
        levels: tuple[Real, Real, Real], errors: tuple[Real, Real, Real], like: Array
    ) -> Varying:
        """Return a number by its derivatives and bounds, each (T,) as ``like``, or a constant."""
        value, error = (np.empty((3, like.size), kind) for kind in (complex, float))
        for k in range(3):
            value[k], error[k] = levels[k], errors[k]
        return Varying(value, error)

    def __add__(self, other: Varying) -> Varying:
        value = self.value + other.value
        return Varying(value, self.error + other.error + EPS * np.abs(value))

    def __mul__(self, other: Varying) -> Varying:
        mine, its = np.abs(self.value), np.abs(other.value)
        error = leibniz(mine, other.error) + leibniz(self.error, its + other.error)
        # A complex product is rounded by sqrt(5) / 2 of EPS, and three of them are added.
        rounding = 4 * EPS * leibniz(mine, its)
        return Varying(leibniz(self.value, other.value), error + rounding)

    def conj(self) -> Varying:
        return Varying(self.value.conj(), self.error)

    @property
    def each(self) -> Varying:
        """The number with an axis for parameters, (3, 1, T)."""
        return Varying(self.value[:, None], self.error[:, None])


def leibniz(a: Number, b: Number) -> Number:
    """Return a product with its derivatives by time, (3, ...)."""
    return np.stack(
        np.broadcast_arrays(
            a[0] * b[0], a[1] * b[0] + a[0] * b[1], a[2] * b[0] + 2.0 * (a[1] * b[1]) + a[0] * b[2]
        )
    )


NOTHING, ONE, MINUS, QUARTER = (Varying.constant(c) for c in (0.0, 1.0, -1.0, 1j))
"""0, 1, -1, and a quarter of a turn."""


def turning(body: BodyKinematics, like: Array) -> Varying:
    """Return exp(i theta) of a body at samples as ``like`` (T,)."""
    e = body.error or (0.0, 0.0, 0.0)
    u = (body.turn.x + 1j * body.turn.y) / body.length
    omega, size = 1j * body.omega, np.abs(body.omega)
    bend, size2 = 1j * body.alpha - body.omega**2, np.abs(body.alpha) + body.omega**2
    off = e[0] + 2 * EPS
    wrong = e[2] + e[1] * (2.0 * size + e[1])
    errors = (
        off,
        e[1] + (size + e[1]) * off + 2 * EPS * size,
        wrong + (size2 + wrong) * off + 4 * EPS * size2,
    )
    return Varying.of((u, omega * u, bend * u), errors, like)
