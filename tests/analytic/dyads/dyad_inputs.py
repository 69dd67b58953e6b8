"""Random inputs of dyads: points in motion, turning lines, and the errors that they may carry."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from mpmath import mp
from numpy.typing import NDArray

from analytic.dyads.parts import MovingLine
from analytic.dyads.plane import (
    EXACT_ANGLE,
    EXACT_POINT,
    ZERO,
    AngleError,
    PointError,
    PointKinematics,
    Vec,
)
from models.array import Array
from tests.analytic import oracle
from tests.analytic.change_points.jets import Jet, Number

BUNCH = 50
EXACTLY = 0.1
"""Share of the dyads near toggle that stand in it exactly, but for rounding."""
CLOSE = 1e-12
"""Dyads nearer to toggle stand at the origin: elsewhere the rounding of a place is more."""


class Exact:
    """The inputs as they are."""

    def vector(self, size: float) -> tuple[Number, Number]:
        return 0, 0

    def number(self, size: float) -> Number:
        return 0


class Moved:
    """The inputs wrong by exactly what they may be wrong by, in random directions."""

    def __init__(self, rng: np.random.Generator) -> None:
        self.rng = rng

    def vector(self, size: float) -> tuple[Number, Number]:
        c, s = mp.cos_sin(self.rng.uniform(0.0, math.tau))
        return c * size, s * size

    def number(self, size: float) -> Number:
        return mp.mpf(size) * int(self.rng.choice((-1, 1)))


@dataclass(frozen=True)
class Points:
    """Points in motion: per level (position, velocity, acceleration) x, y and error, (3, n)."""

    x: Array
    y: Array
    error: Array

    def kinematics(self) -> PointKinematics:
        p, v, a = (Vec(self.x[k], self.y[k]) for k in range(3))
        error = PointError(*self.error) if self.error.any() else EXACT_POINT
        if not (self.x[1:].any() or self.y[1:].any()):  # as the ground gives its pins
            return PointKinematics(p, ZERO, ZERO, error)
        return PointKinematics(p, v, a, error)

    def place(self, i: int, shift: Exact | Moved) -> oracle.Place:
        moves = [shift.vector(float(e)) for e in self.error[:, i]]
        x = (mp.mpf(float(v)) + move[0] for v, move in zip(self.x[:, i], moves, strict=True))
        y = (mp.mpf(float(v)) + move[1] for v, move in zip(self.y[:, i], moves, strict=True))
        return oracle.Place(Jet(*x), Jet(*y))


@dataclass(frozen=True)
class Lines:
    """Turning lines: a point of each, and per level its angle and error, (3, n)."""

    through: Points
    angle: Array
    error: Array

    def kinematics(self) -> MovingLine:
        theta, omega, alpha = self.angle
        error = AngleError(*self.error) if self.error.any() else EXACT_ANGLE
        along = Vec(np.cos(theta), np.sin(theta))
        return MovingLine(self.through.kinematics(), along, omega, alpha, error)

    def line(self, i: int, shift: Exact | Moved) -> oracle.Line:
        angle = (
            mp.mpf(float(v)) + shift.number(float(e))
            for v, e in zip(self.angle[:, i], self.error[:, i], strict=True)
        )
        return oracle.Line(self.through.place(i, shift), Jet(*angle))


@dataclass(frozen=True)
class Draw:
    """How to draw: ``near`` half of the dyads at toggle; inputs wrong by ``wrong`` (relative)."""

    rng: np.random.Generator
    near: bool = True
    wrong: tuple[float, float] | None = None
    far_m: float = 1e6
    """Places lie up to so many lengths from the origin (a hundred, for those near toggle)."""

    def log(self, low: float, high: float, n: int | None = None) -> Array:
        return np.asarray(10.0 ** self.rng.uniform(math.log10(low), math.log10(high), n))

    def sign(self, n: int | None = None) -> NDArray[np.int64]:
        return np.asarray(self.rng.choice((-1, 1), n))

    def clearances(self) -> tuple[Array, NDArray[np.bool_]]:
        """Relative distances from toggle, and which of them are those of dyads near it."""
        near = np.arange(BUNCH) % 2 == 0 if self.near else np.zeros(BUNCH, dtype=bool)
        close = np.where(self.rng.random(BUNCH) < 0.3, 1e-4, 1.0) * self.log(1e-12, 1e-6, BUNCH)
        close[self.rng.random(BUNCH) < EXACTLY] = 0.0
        return np.where(near, close, self.rng.uniform(0.02, 0.98, BUNCH)), near

    def origins(self, scale: float, near: NDArray[np.bool_], home: NDArray[np.bool_]) -> Array:
        """Where the mechanism stands (2, n): anywhere, or at the origin."""
        far = np.where(near, self.log(0.1, 1e2, BUNCH), self.log(0.1, self.far_m, BUNCH))
        angle = self.rng.uniform(0.0, math.tau, BUNCH)
        return scale * far * np.where(home, 0.0, 1.0) * np.array([np.cos(angle), np.sin(angle)])

    def errors(self, scale: float, rate: float) -> Array:
        """Errors of the inputs at each level (3, n)."""
        if self.wrong is None:
            return np.zeros((3, BUNCH))
        share = self.log(*self.wrong, BUNCH) * self.log(0.1, 10.0, 3 * BUNCH).reshape(3, BUNCH)
        share *= self.rng.random((3, BUNCH)) < 0.7  # now and then one level alone is wrong
        return share * scale * np.array([[1.0], [rate], [rate**2]])

    def points(self, place: Array, scale: float, rate: float, *, rest: bool = False) -> Points:
        motion = self.rng.normal(size=(2, 2, BUNCH)) * (0.0 if rest else scale)
        motion *= np.array([rate, rate**2])[:, None, None]
        x, y = np.concatenate([place[None], motion]).swapaxes(0, 1)
        return Points(x, y, np.zeros((3, BUNCH)) if rest else self.errors(scale, rate))

    def lines(self, place: Array, theta: Array, scale: float, rate: float) -> Lines:
        rest = bool(self.rng.random() < 0.3)
        turn = self.rng.normal(size=(2, BUNCH)) * (0.0 if rest else 1.0)
        angle = np.stack([theta, turn[0] * rate, turn[1] * rate**2])
        error = np.zeros((3, BUNCH)) if rest else self.errors(1.0, rate)
        return Lines(self.points(place, scale, rate, rest=rest), angle, error)
