"""Prismatic pairs as lines that a body rides on, and the bodies of the solved unknowns.

A prismatic pair joins a guide (the body that carries the line) and a slider body (block or link).
Either of the two may be the known one, so the pair is first written as a line of the *known* body
(`RidingLine`), on which a pin of the unknown body rides at a constant offset.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from analytic.dyads import plane
from analytic.dyads.chunk import Chunk
from analytic.dyads.parts import MovingLine, Sliding, Turning
from analytic.dyads.plane import EPS, BodyKinematics, PointError, PointKinematics, Vec
from analytic.structure.mobility import Structure
from models.scene import Point, Scene
from models.scene.joints import less, local_point, sliding_body, turned


def total(*points: Point) -> Point:
    return (math.fsum(p[0] for p in points), math.fsum(p[1] for p in points))


def rounding_of(angles: tuple[float, ...], *vectors: Point, onto: Point = (0.0, 0.0)) -> float:
    """Return the rounding of a place from constant vectors, turned by sums of the angles [m].

    ``onto`` is the vector that they were added to; 0 where there was nothing to add.
    """
    length = sum(math.hypot(*v) for v in vectors)
    turning = plane.rounding_of_angles(*angles) + 2 * EPS
    return turning * length + EPS * math.hypot(*onto) if length else 0.0


def _loosened(error: PointError, slack: float, body: BodyKinematics) -> PointError:
    """Return the error of a point whose place on its body is uncertain by ``slack`` [m]."""
    assert body.error is not None
    rate = np.abs(body.omega) + body.error.omega
    gain = np.abs(body.alpha) + body.error.alpha + rate * rate
    return PointError(
        error.position + slack, error.velocity + slack * rate, error.acceleration + slack * gain
    )


@dataclass(frozen=True)
class PlacedBodies:
    """Supports of a group: the bodies ``known`` of a scene, placed before it."""

    scene: Scene
    structure: Structure
    known: frozenset[str]

    def holder(self, pin: str) -> str:
        """Return a known body that carries the pin."""
        return next(body for body in self.structure.pins[pin] if body in self.known)

    def local(self, body: str, point: str) -> Point:
        """Return a point in the frame of a body that carries it [m]."""
        return local_point(self.scene, body, point)


class Bar:
    """Link from a known pin that holds it, ``outer``, to another of its pins, ``inner``."""

    def __init__(self, placed: PlacedBodies, link: str, outer: str, inner: str) -> None:
        self.link, self.outer, self.holder = link, outer, placed.holder(outer)
        self.local = placed.local(link, outer)
        span = less(placed.local(link, inner), self.local)
        self.length = math.hypot(*span)
        self.back = Vec(span[0] / self.length, span[1] / self.length)

    def anchor(self, chunk: Chunk) -> PointKinematics:
        """Return the motion of the known pin."""
        return chunk.point(self.holder, self.outer)

    def body(self, turning: Turning, anchor: PointKinematics) -> BodyKinematics:
        """Return the link, by its rotation and the motion of the known pin."""
        return turning_body(turning, self.back, self.local, anchor)


def turning_body(
    found: Turning, back: Vec, local: Point, anchor: PointKinematics, rounding: float = 0.0
) -> BodyKinematics:
    """Return the body whose frame has the angle of ``found`` less that of ``back``, which is known
    up to ``rounding`` [rad]."""
    aligned = back.x == 1.0 and back.y == 0.0
    turn = found.turn if aligned else found.turn.turned(Vec(back.x, -back.y))
    error = found.error
    if error is not None and rounding:
        error = error._replace(theta=error.theta + rounding)
    return BodyKinematics(local, anchor, turn, found.omega, found.alpha, error, None, found.length)


def following_body(
    known: BodyKinematics, by: float, rounding: float, local: Point, anchor: PointKinematics
) -> BodyKinematics:
    """Return the body at the angle ``by``, known up to ``rounding`` [rad], to a known body."""
    theta = None if known.theta is None else known.theta + by
    error = known.error
    if error is not None:
        error = error._replace(theta=error.theta + rounding)
    turn = known.turn.turned(plane.direction(by))
    return replace(known, local=local, anchor=anchor, turn=turn, error=error, theta=theta)


@dataclass(frozen=True)
class RidingLine:
    """Prismatic pair as a line of its known body.

    The line goes through ``base`` at ``angle`` in the known body's frame; the slider's displacement
    is ``sign`` times the coordinate on this line. The unknown body keeps the angle ``follow`` to
    the known one, the sum of ``angles``, and its point ``rider`` (in its own frame) is on the line.
    ``slack`` bounds the rounding of a computed ``base`` [m].
    """

    known: str
    base: Point
    angle: float
    sign: int
    follow: float
    angles: tuple[float, float]
    rider: Point
    slack: float = 0.0

    @staticmethod
    def of(placed: PlacedBodies, name: str) -> RidingLine:
        """Return the pair of slider ``name``, of which one body is known."""
        slider = placed.scene.sliders[name]
        body = sliding_body(slider)
        pin = placed.local(body, slider.point)
        line, angle = slider.direction_rad, slider.angle_rad
        if slider.on in placed.known:
            both = (line, angle)
            return RidingLine(slider.on, slider.through_m, line, 1, line + angle, both, pin)
        both = (-line, -angle)
        return RidingLine(body, pin, -angle, -1, -line - angle, both, slider.through_m)

    def through(self, local: Point) -> tuple[RidingLine, float]:
        """Return the parallel line of another point of the unknown body, and its lead on it."""
        away = less(local, self.rider)
        lead, aside = turned(away, self.follow - self.angle)
        base = total(self.base, turned((0.0, aside), self.angle))
        slack = rounding_of((*self.angles, self.angle, self.angle), away, onto=base)
        return replace(self, base=base, rider=local, slack=slack), lead

    @property
    def rounding(self) -> float:
        """Rounding of the angle that the unknown body keeps [rad]."""
        return plane.rounding_of_angles(*self.angles)

    def follower(self, chunk: Chunk, local: Point, anchor: PointKinematics) -> BodyKinematics:
        """Return the unknown body, from the motion of its point ``local`` [m]."""
        known = chunk.bodies[self.known]
        return following_body(known, self.follow, self.rounding, local, anchor)

    def line(self, chunk: Chunk) -> MovingLine:
        """Return the line in motion."""
        body = chunk.bodies[self.known]
        along = body.unit(self.angle)
        error = body.error
        if error is not None:
            rounding = plane.rounding_of_angles(self.angle) + EPS  # that of its length
            error = error._replace(theta=error.theta + rounding)
        point = body.point(self.base)
        if self.slack and error is not None and point.error is not None:
            point = replace(point, error=_loosened(point.error, self.slack, body))
        return MovingLine(point, along, body.omega, body.alpha, error)

    def displacement(self, found: Sliding, lead: float) -> Sliding:
        """Return the slider's own displacement from the coordinate of a point that leads it."""
        own = without_lead(found, lead, self.slack)
        if self.sign > 0:
            return own
        return replace(own, s=-own.s, speed=-own.speed, acceleration=-own.acceleration)


def without_lead(found: Sliding, lead: float, slack: float) -> Sliding:
    """Return the displacement behind a leading point; ``slack`` bounds the rounding of the lead."""
    error = found.error
    if error is not None and slack:
        rounding = EPS * (abs(lead) + np.abs(found.s)) + slack
        error = error._replace(displacement=error.displacement + rounding)
    return replace(found, s=found.s - lead, error=error)


def riding_point(line: MovingLine, found: Sliding) -> PointKinematics:
    """Return the motion of the point that slides on a moving line."""
    s, speed = found.s, found.speed
    p = line.at(s)
    v = line.velocity(s) + line.along * speed
    a = line.acceleration(s, speed) + line.along * found.acceleration
    if found.error is None:
        return PointKinematics(p, v, a, None)
    assert line.error is not None
    e = found.error
    place, drift, shove = line.errors(s, speed, e.displacement, e.speed)
    sizes = line.sizes(s, speed)
    error = PointError(
        place + e.displacement + 2 * EPS * sizes[0],
        drift + e.speed + np.abs(speed) * line.error.theta + 3 * EPS * (sizes[1] + np.abs(speed)),
        shove
        + e.acceleration
        + np.abs(found.acceleration) * line.error.theta
        + 4 * EPS * (sizes[2] + np.abs(found.acceleration)),
    )
    return PointKinematics(p, v, a, error)
