"""Vectors of the plane, and the motion of points and bodies in it, over a chunk of samples.

Components are arrays of one chunk, or plain floats where the quantity is constant (the ground), so
that constants cost nothing. Unit vectors stand for angles: no tangent runs to infinity, and the
angle is taken once, at the end, by arctan2.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from models.scene import Point

Array = NDArray[np.float64]
Real = Array | float

EPS = float(np.finfo(np.float64).eps)


class Vec:
    """A vector (x, y) of the plane."""

    __slots__ = ("x", "y")

    def __init__(self, x: Real, y: Real) -> None:
        self.x = x
        self.y = y

    def __add__(self, other: Vec) -> Vec:
        return Vec(self.x + other.x, self.y + other.y)

    def __sub__(self, other: Vec) -> Vec:
        return Vec(self.x - other.x, self.y - other.y)

    def __neg__(self) -> Vec:
        return Vec(-self.x, -self.y)

    def __mul__(self, factor: Real) -> Vec:
        return Vec(self.x * factor, self.y * factor)

    def dot(self, other: Vec) -> Real:
        return self.x * other.x + self.y * other.y

    def cross(self, other: Vec) -> Real:
        """The component of the cross product out of the plane."""
        return self.x * other.y - self.y * other.x

    def square(self) -> Real:
        return self.x * self.x + self.y * self.y

    def norm(self) -> Real:
        return np.hypot(self.x, self.y)

    def perp(self) -> Vec:
        """The vector turned by +90 deg."""
        return Vec(-self.y, self.x)

    def turned(self, by: Vec) -> Vec:
        """The vector turned by the angle of the unit vector ``by`` (product of complex numbers)."""
        if by is UNTURNED:
            return self
        return Vec(self.x * by.x - self.y * by.y, self.x * by.y + self.y * by.x)


UNTURNED = Vec(1.0, 0.0)
ZERO = Vec(0.0, 0.0)


def direction(angle_rad: float) -> Vec:
    """The unit vector of an angle; `UNTURNED` itself for 0, which makes turning by it free."""
    if angle_rad == 0.0:
        return UNTURNED
    return Vec(float(np.cos(angle_rad)), float(np.sin(angle_rad)))


@dataclass(frozen=True, slots=True)
class PointError:
    """Bounds on the error of a point: position [m], velocity [m/s], acceleration [m/s^2]."""

    position: Real
    velocity: Real
    acceleration: Real


@dataclass(frozen=True, slots=True)
class AngleError:
    """Bounds on the error of a body's angle [rad], rate [rad/s], acceleration [rad/s^2]."""

    theta: Real
    omega: Real
    alpha: Real


EXACT_POINT = PointError(0.0, 0.0, 0.0)
EXACT_ANGLE = AngleError(0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class PointKinematics:
    """Position [m], velocity [m/s] and acceleration [m/s^2] of a point, with bounds if asked for."""

    p: Vec
    v: Vec
    a: Vec
    error: PointError | None


@dataclass(frozen=True, slots=True)
class BodyKinematics:
    """A body by one of its points (``anchor``, at ``local`` in its frame) and its rotation.

    ``turn`` is the unit vector of the frame's x-axis. ``theta`` is kept where the angle is known
    without an arctan2 (driver, ground).
    """

    local: Point
    anchor: PointKinematics
    turn: Vec
    omega: Real
    alpha: Real
    error: AngleError | None
    theta: Real | None = None

    def point(self, local: Point) -> PointKinematics:
        """The motion of the point at ``local`` [m] in the body's frame."""
        if local == self.local:
            return self.anchor
        span = Vec(local[0] - self.local[0], local[1] - self.local[1])
        arm = Vec(
            span.x * self.turn.x - span.y * self.turn.y if span.y else self.turn.x * span.x,
            span.x * self.turn.y + span.y * self.turn.x if span.y else self.turn.y * span.x,
        )
        square = self.omega * self.omega
        velocity = arm.perp() * self.omega
        acceleration = arm.perp() * self.alpha - arm * square
        at = self.anchor
        found = PointKinematics(at.p + arm, at.v + velocity, at.a + acceleration, None)
        if self.error is None or at.error is None:
            return found
        return PointKinematics(found.p, found.v, found.a, self._point_error(found, span))

    def _point_error(self, found: PointKinematics, span: Vec) -> PointError:
        """The anchor's errors, those of the rotation over the arm, and the rounding of the sums."""
        assert self.error is not None
        assert self.anchor.error is not None
        e, at, r = self.error, self.anchor.error, float(np.hypot(span.x, span.y))
        rate, gain = abs(self.omega), abs(self.alpha)
        speed, pull = r * rate, r * (gain + rate * rate)
        return PointError(
            at.position + r * e.theta + 4 * EPS * (found.p.norm() + self.anchor.p.norm() + r),
            at.velocity + r * (e.omega + rate * e.theta)
            + 4 * EPS * (found.v.norm() + self.anchor.v.norm() + speed),
            at.acceleration
            + r * (e.alpha + e.omega * (2 * rate + e.omega) + (gain + rate * rate) * e.theta)
            + 6 * EPS * (found.a.norm() + self.anchor.a.norm() + pull),
        )


def fixed_point(place: Point) -> PointKinematics:
    """A point that rests and is known exactly."""
    return PointKinematics(Vec(*place), ZERO, ZERO, EXACT_POINT)


def fixed_body() -> BodyKinematics:
    """The ground."""
    return BodyKinematics((0.0, 0.0), fixed_point((0.0, 0.0)), UNTURNED, 0.0, 0.0, EXACT_ANGLE, 0.0)
