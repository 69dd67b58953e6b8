"""Vectors of the plane, and the motion of points and bodies in it, over a chunk of samples.

Components are arrays of one chunk, or plain floats where the quantity is constant (the ground), so
that constants cost nothing. Unit vectors represent angles: no tangent runs to infinity, and the
angle is taken once, at the end, by arctan2.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from models.scene import Point

Real = Any
"""Array of one chunk, or a float: the type checker cannot do arithmetic with that union."""

EPS = float(np.finfo(np.float64).eps)


class Vec:
    """A vector (x, y) of the plane."""

    __slots__ = ("x", "y")

    def __init__(self, x: Real, y: Real) -> None:
        self.x = x
        self.y = y

    def __add__(self, other: Vec) -> Vec:
        if self is ZERO:
            return other
        if other is ZERO:
            return self
        return Vec(self.x + other.x, self.y + other.y)

    def __sub__(self, other: Vec) -> Vec:
        if other is ZERO:
            return self
        return Vec(self.x - other.x, self.y - other.y)

    def __neg__(self) -> Vec:
        return Vec(-self.x, -self.y)

    def __mul__(self, factor: Real) -> Vec:
        return Vec(self.x * factor, self.y * factor)

    def less(self, other: Vec, factor: Real) -> Vec:
        """Return the vector less ``factor`` times another."""
        return Vec(_less(self.x, other.x * factor), _less(self.y, other.y * factor))

    def more(self, other: Vec, factor: Real) -> Vec:
        """Return the vector plus ``factor`` times another."""
        x, y = other.x * factor, other.y * factor
        x += self.x
        y += self.y
        return Vec(x, y)

    # The sums below are taken in place, in the array of their first product: half the memory
    # traffic of a new array each, which takes most of the time of a chunk.

    def dot(self, other: Vec) -> Real:
        sum_ = self.x * other.x
        sum_ += self.y * other.y
        return sum_

    def cross(self, other: Vec) -> Real:
        """Return the component of the cross product out of the plane."""
        difference = self.x * other.y
        difference -= self.y * other.x
        return difference

    def square(self) -> Real:
        return self.dot(self)

    def norm(self) -> Real:
        return np.hypot(self.x, self.y)

    def perp(self, factor: Real = 1.0) -> Vec:
        """Return the vector turned by +90 deg, times ``factor``."""
        return Vec(self.y * -factor, self.x * factor)

    def turned(self, by: Vec) -> Vec:
        """Return the vector turned by the angle of the unit vector ``by`` (complex product)."""
        if by is UNTURNED:
            return self
        x, y = self.x * by.x, self.x * by.y
        x -= self.y * by.y
        y += self.y * by.x
        return Vec(x, y)


def _less(a: Real, fresh: Real) -> Real:
    """Return a - fresh, in the array of ``fresh`` if it is one."""
    if isinstance(fresh, np.ndarray):
        return np.subtract(a, fresh, out=fresh)
    return a - fresh


UNTURNED = Vec(1.0, 0.0)
ZERO = Vec(0.0, 0.0)
"""Vector that costs nothing to add; compare by identity."""
STEADY = 0.0
"""Angular acceleration of a body at constant speed; compare by identity."""


def direction(angle_rad: float) -> Vec:
    """Return the unit vector of an angle; `UNTURNED` for 0, which makes turning by it free."""
    if angle_rad == 0.0:
        return UNTURNED
    return Vec(math.cos(angle_rad), math.sin(angle_rad))


class PointError(NamedTuple):
    """Bounds on the error of a point: position [m], velocity [m/s], acceleration [m/s^2]."""

    position: Real
    velocity: Real
    acceleration: Real


class AngleError(NamedTuple):
    """Bounds on the error of a body's angle [rad], rate [rad/s], acceleration [rad/s^2]."""

    theta: Real
    omega: Real
    alpha: Real


EXACT_POINT = PointError(0.0, 0.0, 0.0)
EXACT_ANGLE = AngleError(0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class PointKinematics:
    """Position [m], velocity [m/s], acceleration [m/s^2] of a point, with bounds if required."""

    p: Vec
    v: Vec
    a: Vec
    error: PointError | None


@dataclass(frozen=True, slots=True)
class BodyKinematics:
    """Body by one of its points (``anchor``, at ``local`` in its frame) and its rotation.

    ``turn`` is along the frame's x-axis, of constant length ``length``: a vector between two pins
    becomes a unit vector only where one is needed. ``theta`` is kept where the angle is known
    without an arctan2 (driver, ground).
    """

    local: Point
    anchor: PointKinematics
    turn: Vec
    omega: Real
    alpha: Real
    error: AngleError | None
    theta: Real | None = None
    length: float = 1.0

    def unit(self, angle_rad: float) -> Vec:
        """Return the unit vector at a constant angle to the body's frame."""
        turned = self.turn.turned(direction(angle_rad))
        return turned if self.length == 1.0 else turned * (1.0 / self.length)

    def point(self, local: Point) -> PointKinematics:
        """Return the motion of the point at ``local`` [m] in the body's frame."""
        if local == self.local:
            return self.anchor
        x, y = local[0] - self.local[0], local[1] - self.local[1]
        span = Vec(x / self.length, y / self.length)
        arm = self.turn * span.x if y == 0.0 else self.turn.turned(span)
        velocity = arm.perp(self.omega)
        acceleration = arm * -(self.omega * self.omega)
        if self.alpha is not STEADY:
            acceleration = arm.perp(self.alpha) + acceleration
        at = self.anchor
        motion = PointKinematics(at.p + arm, at.v + velocity, at.a + acceleration, None)
        if self.error is None or at.error is None:
            return motion
        error = self._point_error(motion, math.hypot(x, y))
        return PointKinematics(motion.p, motion.v, motion.a, error)

    def _point_error(self, motion: PointKinematics, r: float) -> PointError:
        """Return the anchor's errors, those of the rotation over the arm, and the rounding: half a
        unit of the sum, and that of the arm's coordinates, its turn and its rates."""
        assert self.error is not None
        assert self.anchor.error is not None
        e, at = self.error, self.anchor.error
        rate, gain = abs(self.omega), abs(self.alpha)
        speed, pull = r * rate, r * (gain + rate * rate)
        change = e.alpha + e.omega * (2 * rate + e.omega)
        return PointError(
            at.position + r * e.theta + EPS * (0.5 * motion.p.norm() + 3.0 * r),
            at.velocity
            + r * (e.omega + (rate + e.omega) * e.theta)
            + EPS * (0.5 * motion.v.norm() + 4.0 * speed),
            at.acceleration
            + r * (change + (gain + rate * rate + change) * e.theta)
            + EPS * (0.5 * motion.a.norm() + 5.0 * pull),
        )


def fixed_point(place: Point) -> PointKinematics:
    """Return a point that rests and is known exactly."""
    p = Vec(*place) if any(place) else ZERO
    return PointKinematics(p, ZERO, ZERO, EXACT_POINT)


def fixed_body(*, certified: bool) -> BodyKinematics:
    """Return the ground."""
    error = EXACT_ANGLE if certified else None
    return BodyKinematics((0.0, 0.0), fixed_point((0.0, 0.0)), UNTURNED, 0.0, STEADY, error, 0.0)


def sample(values: Real, index: int) -> float:
    """Return one sample of a series, or of a constant."""
    return float(np.ravel(values)[index if np.size(values) > 1 else 0])


Three = tuple[Real, Real, Real]


def cross_three(a: Three, b: Three) -> Three:
    """Return the cross product of two vectors of three numbers."""
    return (
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    )


def dot_three(a: Three, b: Three) -> Real:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def rounding_of_angles(*angles: float) -> float:
    """Return the rounding of the direction of a sum of constant angles [rad]; 0 where all are.

    Within a turn they may come from degrees, which are rounded to radians; larger ones are exact. A
    small sum of large angles has the rounding of the large ones.
    """
    sizes = [abs(angle) for angle in angles if angle]
    if not sizes:
        return 0.0
    summed = sum(sizes) if len(sizes) > 1 else 0.0
    return EPS * (3.0 + sum(min(size, math.tau) for size in sizes) + summed)
