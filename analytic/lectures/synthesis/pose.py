"""Positions of a body in the plane, and what lies between two of them: poles and bisectors."""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from dataclasses import dataclass

from models.errors import CrankcheckError

PARALLEL = 1e-9
"""An angle [rad] between two positions that is smaller is a pure translation: its pole lies beyond
all distances that a mechanism has."""


@dataclass(frozen=True)
class Pose:
    """Where a body is: its reference point [m], and the angle of its own x-axis [rad]."""

    point: complex
    angle: float

    def at(self, place: complex) -> complex:
        """Where a place of the body's own frame is."""
        return self.point + cmath.exp(1j * self.angle) * place

    def back(self, place: complex) -> complex:
        """Where a place of the plane is in the body's own frame."""
        return (place - self.point) * cmath.exp(-1j * self.angle)


@dataclass(frozen=True)
class Bisector:
    """The line of all points as far from one place as from another."""

    middle: complex
    along: complex
    """A unit vector, a quarter turn to the left of that from the first place to the second."""

    def at(self, distance: float) -> complex:
        """The point so far from the middle."""
        return self.middle + distance * self.along


def bisector(first: complex, second: complex) -> Bisector:
    """That of two places. Raises CrankcheckError where they coincide."""
    across = second - first
    if across == 0.0:
        raise CrankcheckError(
            f"a point that stays at ({first.real:g}, {first.imag:g}) m has no bisector between its "
            "places; move it, or take it for a fixed pivot"
        )
    return Bisector(0.5 * (first + second), 1j * across / abs(across))


def turn_between(first: Pose, second: Pose) -> float:
    """The angle from one position to another [rad], in (-pi, pi]."""
    turn = math.remainder(second.angle - first.angle, math.tau)
    return math.pi if turn == -math.pi else turn


def pole(first: Pose, second: Pose) -> complex | None:
    """The rotopole: the point about which a body turns from one position into the other; None of a
    pure translation, whose pole is at infinity, across the way."""
    turn = turn_between(first, second)
    if abs(turn) < PARALLEL:
        return None
    rotation = cmath.exp(1j * (second.angle - first.angle))
    return (second.point - rotation * first.point) / (1.0 - rotation)


def circle_through(a: complex, b: complex, c: complex) -> complex | None:
    """The centre of the circle through three points; None where they lie on a line, and it is at
    infinity."""
    p, q = b - a, c - a
    across = (p.conjugate() * q).imag
    if abs(across) <= 1e-12 * abs(p) * abs(q):
        return None
    return a + 1j * (p * abs(q) ** 2 - q * abs(p) ** 2) / (2.0 * across)


def refuse_coinciding(poses: Sequence[Pose], size: float) -> None:
    """Raise CrankcheckError where two positions are one, over a ``size`` [m]."""
    for j, second in enumerate(poses):
        for i, first in enumerate(poses[:j]):
            near = abs(second.point - first.point) <= 1e-9 * size
            if near and abs(turn_between(first, second)) <= PARALLEL:
                raise CrankcheckError(
                    f"positions {i + 1} and {j + 1} coincide; give positions that differ in place "
                    "or in angle"
                )
