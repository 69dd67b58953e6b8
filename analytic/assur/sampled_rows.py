"""Rows of a triad over a chunk of samples, on moving supports of its legs.

Each row is a distance g that is 0 where the leg closes, and so are its rate and second rate. All of
them are linear in the place, the rate or the second rate of the central link, by the same force n
through a point: n . V + (r x n) omega = ..., r from the link's anchor. Bounds are a posteriori: of
g at the motion found, from its errors and those of the inputs.
"""

from __future__ import annotations

import operator
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from analytic.assur.eliminant import AngleRow, CircleRow, LegRow, LineRow, ThroughRow
from analytic.dyads import plane
from analytic.dyads.parts import MovingLine
from analytic.dyads.plane import EPS, ZERO, AngleError, BodyKinematics, PointKinematics, Real, Vec
from models.motion import Order
from models.scene import Point

Gap = tuple[Real, Real]
"""Distance [m], or its rate, and a bound of its error."""
Sway = tuple[Real, Real]
"""Largest change of n, and of r x n [m], within the bounds of a pose."""


@dataclass(frozen=True, slots=True)
class LocalPoint:
    """Point in the frame of the central link: at a constant place, or moving in it."""

    p: Vec
    v: Vec = ZERO
    a: Vec = ZERO
    error: plane.PointError = plane.EXACT_POINT
    moves: bool = False

    def on(self, body: BodyKinematics) -> PointKinematics:
        """Return its motion, carried by the link."""
        if not self.moves:
            return body.point((self.p.x, self.p.y))
        arm, drift, pull = (each.turned(body.turn) for each in (self.p, self.v, self.a))
        w, g = body.omega, body.alpha
        at = body.anchor
        motion = PointKinematics(
            at.p + arm,
            at.v + arm.perp(w) + drift,
            at.a + arm.perp(g) + arm * -(w * w) + drift.perp(2.0 * w) + pull,
            None,
        )
        if body.error is None or at.error is None:
            return motion
        return replace(motion, error=self._error(body, motion))

    def _error(self, body: BodyKinematics, motion: PointKinematics) -> plane.PointError:
        assert body.error is not None
        assert body.anchor.error is not None
        e, at, own = body.error, body.anchor.error, self.error
        r, v, a = self.p.norm(), self.v.norm(), self.a.norm()
        w, g = np.abs(body.omega), np.abs(body.alpha)
        ww, gg = w + e.omega, g + e.alpha
        gain = e.alpha + e.omega * (2.0 * w + e.omega)
        return plane.PointError(
            at.position + r * e.theta + own.position + EPS * (motion.p.norm() + 4.0 * r),
            at.velocity
            + r * (e.omega + ww * e.theta)
            + v * e.theta
            + ww * own.position
            + own.velocity
            + EPS * (motion.v.norm() + 5.0 * (r * w + v)),
            at.acceleration
            + r * (gain + (gg + ww * ww) * e.theta)
            + (gg + ww * ww) * own.position
            + 2.0 * (v * (e.omega + ww * e.theta) + ww * own.velocity)
            + a * e.theta
            + own.acceleration
            + EPS * (motion.a.norm() + 6.0 * (r * (g + w * w) + 2.0 * v * w + a)),
        )


class SampledRow(Protocol):
    """Row at a pose of the central link, with its rates: ``body``."""

    def wrench(self, body: BodyKinematics) -> tuple[Vec, Real]:
        """Return n, and r x n [m]; for an angle 0, and a length."""

    def gap(self, order: Order, body: BodyKinematics) -> Gap:
        """Return g, its rate or its second rate."""

    def sway(self, body: BodyKinematics) -> Sway:
        """Return the largest change of the wrench within the bounds of the pose."""

    def at(self, index: int) -> LegRow:
        """Return the row at one sample, in the link's frame."""


def moment(body: BodyKinematics, place: Vec, force: Vec) -> Real:
    """Return the moment of a force at a place about the anchor of the link."""
    return (place - body.anchor.p).cross(force)


@dataclass(frozen=True, slots=True)
class RowCircle:
    """Point of the link at a distance (T,) from a known pin: constant, or with rates."""

    point: LocalPoint
    pin: PointKinematics
    length: Real
    rate: Real = 0.0
    second: Real = 0.0
    off: tuple[Real, Real, Real] = (0.0, 0.0, 0.0)

    def wrench(self, body: BodyKinematics) -> tuple[Vec, Real]:
        place = self.point.on(body).p
        away = place - self.pin.p
        n = away * (1.0 / away.norm())
        return n, moment(body, place, n)

    def gap(self, order: Order, body: BodyKinematics) -> Gap:
        at, pin, off = self.point.on(body), self.pin, self.off
        away = at.p - pin.p
        far = away.norm()
        e, known = at.error, pin.error
        place = 0.0
        if e is not None and known is not None:
            place = e.position + known.position
        if order == 0:
            return far - self.length, place + off[0] + 2 * EPS * (far + pin.p.norm())
        n = away * (1.0 / far)
        lean = np.where(place < 0.5 * far, 2.0 * place / far, 2.0) + 2 * EPS
        drift = at.v - pin.v
        speed = drift.norm()
        if order == 1:
            value = n.dot(drift) - self.rate
            if e is None or known is None:
                return value, 0.0
            loose = e.velocity + known.velocity
            return value, loose + lean * (speed + loose) + off[1] + 3 * EPS * (speed + pin.v.norm())
        pull = at.a - pin.a
        value = n.dot(pull) + (speed * speed - self.rate * self.rate) / far - self.second
        if e is None or known is None:
            return value, 0.0
        loose, shove = e.velocity + known.velocity, e.acceleration + known.acceleration
        near = np.maximum(far - place, 0.25 * far)
        turning = (2.0 * speed + loose) * loose / near + speed * speed * place / (near * far)
        rated = 2.0 * np.abs(self.rate) * off[1] / near
        rounding = 4 * EPS * (pull.norm() + pin.a.norm() + speed * speed / far)
        return value, shove + lean * (pull.norm() + shove) + turning + rated + off[2] + rounding

    def sway(self, body: BodyKinematics) -> Sway:
        at = self.point.on(body)
        assert at.error is not None
        assert self.pin.error is not None
        assert body.error is not None
        far, arm = (at.p - self.pin.p).norm(), (at.p - body.anchor.p).norm()
        place = at.error.position + self.pin.error.position
        lean = np.where(place < 0.5 * far, 2.0 * place / far, 2.0)
        return lean, arm * (lean + body.error.theta) + self.point.error.position

    def at(self, index: int) -> LegRow:
        length = plane.sample(self.length, index)
        return CircleRow(_one(self.point.p, index), _one(self.pin.p, index), length)


@dataclass(frozen=True, slots=True)
class OnLine:
    """Point of the link on a known line."""

    point: LocalPoint
    line: MovingLine

    def wrench(self, body: BodyKinematics) -> tuple[Vec, Real]:
        n = self.line.along.perp()
        return n, moment(body, self.point.on(body).p, n)

    def gap(self, order: Order, body: BodyKinematics) -> Gap:
        return gap_of_line(order, self.line, self.point.on(body))

    def sway(self, body: BodyKinematics) -> Sway:
        assert self.line.error is not None
        assert body.error is not None
        lean = self.line.error.theta + EPS
        arm = (self.point.on(body).p - body.anchor.p).norm()
        return lean, arm * (lean + body.error.theta) + self.point.error.position

    def at(self, index: int) -> LegRow:
        normal, through = self.line.along.perp(), self.line.point.p
        return LineRow(_one(self.point.p, index), _one(normal, index), _one(through, index))


@dataclass(frozen=True, slots=True)
class Through:
    """Line of the link, at a direction in its frame (which may turn), through a known pin."""

    point: LocalPoint
    along: Vec
    pin: PointKinematics
    turning: tuple[Real, Real] = (0.0, 0.0)
    leaning: AngleError = plane.EXACT_ANGLE

    def line(self, body: BodyKinematics) -> MovingLine:
        """Return the line in motion."""
        error = None
        if body.error is not None:
            error = AngleError(*map(operator.add, body.error, self.leaning))
            error = error._replace(theta=error.theta + 2 * EPS)
        w, g = body.omega + self.turning[0], body.alpha + self.turning[1]
        return MovingLine(self.point.on(body), self.along.turned(body.turn), w, g, error)

    def wrench(self, body: BodyKinematics) -> tuple[Vec, Real]:
        n = self.along.turned(body.turn).perp(-1.0)
        return n, moment(body, self.pin.p, n)

    def gap(self, order: Order, body: BodyKinematics) -> Gap:
        return gap_of_line(order, self.line(body), self.pin)

    def sway(self, body: BodyKinematics) -> Sway:
        assert self.pin.error is not None
        assert body.error is not None
        assert body.anchor.error is not None
        lean = body.error.theta + self.leaning.theta + EPS
        arm = (self.pin.p - body.anchor.p).norm()
        return lean, arm * lean + self.pin.error.position + body.anchor.error.position

    def at(self, index: int) -> LegRow:
        normal, b = _one(self.along.perp(), index), _one(self.point.p, index)
        return ThroughRow(normal, b, _one(self.pin.p, index))


@dataclass(frozen=True, slots=True)
class KeptAngle:
    """Direction, which may turn, that the link keeps; ``length`` makes the angle a distance [m]."""

    along: Vec
    omega: Real
    alpha: Real
    error: AngleError | None
    length: float

    def wrench(self, body: BodyKinematics) -> tuple[Vec, Real]:
        return ZERO, self.length

    def gap(self, order: Order, body: BodyKinematics) -> Gap:
        e, own, length = self.error, body.error, self.length
        if order == 0:
            off = np.arctan2(self.along.cross(body.turn), self.along.dot(body.turn))
            return length * off, 0.0 if e is None else length * (e.theta + 4 * EPS)
        value = body.omega - self.omega if order == 1 else body.alpha - self.alpha
        if e is None or own is None:
            return length * value, 0.0
        loose = e.omega + own.omega if order == 1 else e.alpha + own.alpha
        rounding = EPS * np.abs(self.omega if order == 1 else self.alpha)
        return length * value, length * (loose + rounding)

    def sway(self, body: BodyKinematics) -> Sway:
        return 0.0, 0.0

    def at(self, index: int) -> LegRow:
        return AngleRow(_one(self.along, index))


def gap_of_line(order: Order, line: MovingLine, point: PointKinematics) -> Gap:
    """Return the distance of a point from a line along its normal, its rate or its second rate."""
    n, away = line.along.perp(), point.p - line.point.p
    s = line.along.dot(away)
    if order == 0:
        value = n.dot(away)
        if point.error is None or line.error is None:
            return value, 0.0
        place = line.errors(s, 0.0, 0.0, 0.0)[0]
        return value, place + point.error.position + 3 * EPS * (away.norm() + point.p.norm())
    drift = point.v - line.velocity(s)
    speed = line.along.dot(drift)
    if order == 1:
        value = n.dot(drift)
        if point.error is None or line.error is None:
            return value, 0.0
        place, loose, _ = line.errors(s, speed, point.error.position, 0.0)
        across = (point.error.position + place) * np.abs(line.omega)
        sizes = line.sizes(s, speed)[1] + point.v.norm()
        lean = line.error.theta + 2 * EPS
        return value, loose + point.error.velocity + across + lean * drift.norm() + 4 * EPS * sizes
    pull = point.a - line.acceleration(s, speed)
    value = n.dot(pull)
    if point.error is None or line.error is None:
        return value, 0.0
    es, ev = point.error.position, point.error.velocity
    place, loose, shove = line.errors(s, speed, es, ev)
    rate = np.abs(line.omega) + line.error.omega
    gain = np.abs(line.alpha) + line.error.alpha + rate * rate
    # The speed along the line is that of the point less the line's own, with the errors of both.
    across = (es + place) * gain + 2.0 * rate * (loose + line.error.theta * drift.norm())
    sizes = line.sizes(s, speed)[2] + point.a.norm()
    lean = line.error.theta + 2 * EPS
    return value, shove + point.error.acceleration + across + lean * pull.norm() + 5 * EPS * sizes


def _one(vector: Vec, index: int) -> Point:
    return plane.sample(vector.x, index), plane.sample(vector.y, index)
