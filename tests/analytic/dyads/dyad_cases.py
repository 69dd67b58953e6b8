"""Random dyads of each kind, in bunches that share their lengths, up to their toggle positions.

Every bunch can solve itself in floats (the solver under test, on arrays) and, sample by sample, in
fifty digits (the oracle) from the same inputs, or from inputs moved within their stated errors.
"""

import math
import operator
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from mpmath import mp
from numpy.typing import NDArray

from analytic.dyads import plane, prp, rpp, rpr, rrp, rrr
from analytic.dyads.parts import Dyad, MovingLine
from analytic.dyads.plane import ZERO, AngleError, PointError, PointKinematics, Vec
from models.array import Array
from tests.analytic import oracle
from tests.analytic.change_points.jets import Jet, Number

BUNCH = 50
EXACTLY = 0.1
"""Share of the dyads near toggle that stand in it exactly, but for rounding."""
CLOSE = 1e-12
"""Dyads nearer to toggle stand at the origin: elsewhere the rounding of a place is more."""


class Exact:
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
        error = PointError(*self.error) if self.error.any() else plane.EXACT_POINT
        if not (self.x[1:].any() or self.y[1:].any()):  # as the ground gives its pins
            return PointKinematics(p, ZERO, ZERO, error)
        return PointKinematics(p, v, a, error)

    def place(self, i: int, shift: Exact | Moved) -> oracle.Place:
        moves = zip(*(shift.vector(float(e)) for e in self.error[:, i]), strict=True)
        pairs = zip((self.x[:, i].tolist(), self.y[:, i].tolist()), moves, strict=True)
        return oracle.Place(*(Jet(*map(operator.add, map(mp.mpf, v), m)) for v, m in pairs))


@dataclass(frozen=True)
class Lines:
    """Turning lines: a point of each, and per level its angle and error, (3, n)."""

    through: Points
    angle: Array
    error: Array

    def kinematics(self) -> MovingLine:
        theta, omega, alpha = self.angle
        error = AngleError(*self.error) if self.error.any() else plane.EXACT_ANGLE
        along = Vec(np.cos(theta), np.sin(theta))
        return MovingLine(self.through.kinematics(), along, omega, alpha, error)

    def place(self, i: int, shift: Exact | Moved) -> oracle.Line:
        pairs = zip(self.angle[:, i].tolist(), self.error[:, i].tolist(), strict=True)
        angle = (mp.mpf(v) + shift.number(e) for v, e in pairs)
        return oracle.Line(self.through.place(i, shift), Jet(*angle))


@dataclass(frozen=True)
class Draw:
    """How to draw: half of the dyads at toggle; inputs wrong by ``wrong`` (relative)."""

    rng: np.random.Generator
    wrong: tuple[float, float] | None = None

    def log(self, low: float, high: float, n: int | None = None) -> Array:
        return np.asarray(10.0 ** self.rng.uniform(math.log10(low), math.log10(high), n))

    def sign(self, n: int | None = None) -> NDArray[np.int64]:
        return np.asarray(self.rng.choice((-1, 1), n))

    def clearances(self) -> tuple[Array, NDArray[np.bool_]]:
        """Relative distances from toggle, and which of them are those of dyads near it."""
        near = np.arange(BUNCH) % 2 == 0
        close = np.where(self.rng.random(BUNCH) < 0.3, 1e-4, 1.0) * self.log(1e-12, 1e-6, BUNCH)
        close[self.rng.random(BUNCH) < EXACTLY] = 0.0
        return np.where(near, close, self.rng.uniform(0.02, 0.98, BUNCH)), near

    def origins(self, scale: float, near: NDArray[np.bool_], home: NDArray[np.bool_]) -> Array:
        """Where the mechanism stands (2, n): up to a million lengths away, a hundred near toggle;
        or at the origin."""
        far = np.where(near, self.log(0.1, 1e2, BUNCH), self.log(0.1, 1e6, BUNCH))
        return scale * far * ~home * _directed(self.rng.uniform(0.0, math.tau, BUNCH))

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


@dataclass(frozen=True)
class Bunch:
    """Dyads of one kind with the same lengths.

    ``exact`` is the oracle's formula, with both of its inputs and what else it takes; ``sine`` the
    conditioning; ``size`` the largest length in the closure of each sample over the smallest link,
    the factor that rounding comes with.
    """

    dyad: Dyad
    exact: tuple[Any, ...]
    sine: Array
    size: Array

    def truth(self, i: int, shift: Exact | Moved) -> tuple[Jet, Jet]:
        formula, one, other, *more = self.exact
        return formula(one.place(i, shift), other.place(i, shift), *more)


def _each(
    formula: Callable[..., Number], one: Points, other: Points | Lines, *more: float
) -> Array:
    pairs = ((one.place(i, Exact()), other.place(i, Exact())) for i in range(BUNCH))
    return np.array([float(formula(*pair, *more)) for pair in pairs])


def _directed(angle: Array) -> Array:
    return np.array([np.cos(angle), np.sin(angle)])


def draw_rrr(draw: Draw) -> Bunch:
    scale, rate = float(draw.log(1e-3, 1e3)), float(draw.log(1e-2, 1e2))
    l1, l2 = (float(scale * draw.log(0.1, 10.0)) for _ in range(2))
    branch = int(draw.sign())
    clear, near = draw.clearances()
    outer, inner = l1 + l2, abs(l1 - l2)
    at_outer = draw.rng.random(BUNCH) < 0.5
    d = np.where(at_outer, outer * (1.0 - clear), inner * (1.0 + clear))
    d = np.where(near, d, inner + (outer - inner) * clear)
    place = draw.origins(outer, near, clear < CLOSE)
    first = draw.points(place, scale, rate)
    away = d * _directed(draw.rng.uniform(-math.pi, math.pi, BUNCH))
    second = draw.points(place + away, scale, rate, rest=bool(draw.rng.random() < 0.3))
    dyad = rrr.solve(first.kinematics(), second.kinematics(), l1, l2, branch, certified=True)
    sine = _each(oracle.sine_rrr, first, second, l1, l2)
    exact, size = (oracle.rrr, first, second, l1, l2, branch), np.hypot(*place) + outer
    return Bunch(dyad, exact, sine, size / min(l1, l2))


def draw_rrp(draw: Draw) -> Bunch:
    scale, rate = float(draw.log(1e-3, 1e3)), float(draw.log(1e-2, 1e2))
    length, branch = float(scale * draw.log(0.1, 10.0)), int(draw.sign())
    clear, near = draw.clearances()
    height = length * (1.0 - clear) * draw.sign(BUNCH)
    theta = draw.rng.uniform(-math.pi, math.pi, BUNCH)
    home = clear < CLOSE
    theta = np.where(home, 0.0, theta)  # else the height is not what it should be exactly
    place = draw.origins(length, near, home)
    line = draw.lines(place, theta, scale, rate)
    ahead = length * draw.log(1e-9, 10.0, BUNCH) * draw.sign(BUNCH)
    e = _directed(theta)
    pin = draw.points(place + ahead * e + height * np.array([-e[1], e[0]]), scale, rate)
    dyad = rrp.solve(pin.kinematics(), line.kinematics(), length, branch, certified=True)
    high = _each(oracle.rrp_short, pin, line, length) / length
    sine = np.sqrt(np.maximum(0.0, -high * (2.0 + high)))
    exact, size = (oracle.rrp, pin, line, length, branch), np.hypot(*place) + np.abs(ahead) + length
    return Bunch(dyad, exact, sine, size / length)


def draw_rpr(draw: Draw) -> Bunch:
    scale, rate = float(draw.log(1e-3, 1e3)), float(draw.log(1e-2, 1e2))
    offset = float(scale * draw.log(0.01, 10.0)) * int(draw.sign())
    central = bool(draw.rng.random() < 0.3)
    branch = int(draw.sign())
    clear, near = draw.clearances()
    if central:  # the line passes through its pin: nothing is singular before the pins meet
        offset, d = 0.0, scale * np.maximum(np.sqrt(clear), 1e-6)
        clear = np.maximum(clear, 1e-12)
    else:
        d = np.where(near, abs(offset) * (1.0 + clear), abs(offset) / (1.0 - clear * clear))
    place = draw.origins(float(np.max(d)) if central else abs(offset), near, clear < CLOSE)
    second = draw.points(place, scale, rate, rest=bool(draw.rng.random() < 0.3))
    away = d * _directed(draw.rng.uniform(-math.pi, math.pi, BUNCH))
    first = draw.points(place + away, scale, rate)
    dyad = rpr.solve(first.kinematics(), second.kinematics(), offset, branch, certified=True)
    # Negative where it closes; the sine squared is (d^2 - h^2) / d^2.
    high = _each(oracle.rpr_short, first, second, offset) / d
    sine = np.sqrt(np.maximum(0.0, -high * (1.0 + abs(offset) / d)))
    exact, size = (oracle.rpr, first, second, offset, branch), np.hypot(*place) + scale + d
    return Bunch(dyad, exact, sine, size / d)


def _line_angles(draw: Draw) -> Array:
    """Angles between two lines: anything, or nearly (or but for rounding) parallel."""
    clear, near = draw.clearances()
    clear = np.maximum(clear, 1e-15)  # in floats no nearer: parallel lines do not close
    half = np.where(draw.rng.random(BUNCH) < 0.5, math.pi, 0.0)
    return np.where(near, half + clear * draw.sign(BUNCH), math.pi * clear * draw.sign(BUNCH))


def draw_prp(draw: Draw) -> Bunch:
    scale, rate = float(draw.log(1e-3, 1e3)), float(draw.log(1e-2, 1e2))
    between = _line_angles(draw)
    theta = draw.rng.uniform(-1.0, 1.0, BUNCH)
    place = draw.origins(scale, np.abs(np.sin(between)) < 1e-5, np.zeros(BUNCH, dtype=bool))
    line1 = draw.lines(place, theta, scale, rate)
    away = scale * draw.rng.normal(size=(2, BUNCH))
    line2 = draw.lines(place + away, theta + between, scale, rate)
    dyad = prp.solve(line1.kinematics(), line2.kinematics(), certified=True)
    size = (np.hypot(*place) + np.hypot(*away)) / scale
    exact = (oracle.prp, line1, line2)
    return Bunch(dyad, exact, np.abs(np.sin(between)), size)


def draw_rpp(draw: Draw) -> Bunch:
    scale, rate = float(draw.log(1e-3, 1e3)), float(draw.log(1e-2, 1e2))
    near = bool(draw.rng.random() < 0.5)  # the angle is one for the whole bunch
    angle = float(draw.log(1e-12, 1e-6)) if near else float(draw.rng.uniform(0.02, 3.12))
    inner = (angle if draw.rng.random() < 0.5 else math.pi - angle) * int(draw.sign())
    theta = draw.rng.uniform(-math.pi, math.pi, BUNCH)
    place = draw.origins(scale, np.full(BUNCH, near), np.zeros(BUNCH, dtype=bool))
    line = draw.lines(place, theta, scale, rate)
    away = scale * draw.rng.normal(size=(2, BUNCH))
    pin = draw.points(place + away, scale, rate)
    turn = Vec(math.cos(inner), math.sin(inner))
    dyad = rpp.solve(pin.kinematics(), line.kinematics(), turn, certified=True)
    sine, size = np.full(BUNCH, abs(math.sin(inner))), np.hypot(*place) + np.hypot(*away)
    return Bunch(dyad, (oracle.rpp, pin, line, inner), sine, size / scale)


DRAWS = (draw_rrr, draw_rrp, draw_rpr, draw_prp, draw_rpp)
KINDS = {draw.__name__[-3:].upper(): draw for draw in DRAWS}
