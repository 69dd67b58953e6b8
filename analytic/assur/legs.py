"""Legs of a triad and joints of a link to known bodies: their rows and positions.

Each makes its rows at the samples of a chunk, and, when the central link is placed, adds its own
link and sliders to the chunk.
"""

import math
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from analytic.assur.central_frame import CentralFrame
from analytic.assur.sampled_rows import KeptAngle, OnLine, RowCircle, SampledRow, Through
from analytic.dyads import prp
from analytic.dyads.chunk import Chunk
from analytic.dyads.parts import MovingLine, SlideError, Sliding, Turning
from analytic.dyads.plane import (
    EPS,
    EXACT_ANGLE,
    AngleError,
    BodyKinematics,
    PointKinematics,
    Vec,
)
from analytic.dyads.riding import Bar, PlacedBodies, RidingLine, following_body, riding_point
from models.scene import Point


class TriadLeg(Protocol):
    """Leg or joint that holds the central link by one row or two."""

    def rows(self, chunk: Chunk) -> list[SampledRow]:
        """Return its rows while the central link is unknown."""
        ...

    def place(self, chunk: Chunk, body: BodyKinematics) -> None:
        """Add its own link and sliders; ``body`` is the central link by its anchor."""
        ...

    def locals(self) -> list[tuple[str, Point]]:
        """Return the points of the central link that it holds, by body."""
        ...


@dataclass(frozen=True)
class BarLeg:
    """RR: a link between a known pin and one of the central link."""

    frame: CentralFrame
    placed: PlacedBodies
    part: str
    link: str
    outer: str
    inner: str

    @property
    def _bar(self) -> Bar:
        return Bar(self.placed, self.link, self.outer, self.inner)

    def locals(self) -> list[tuple[str, Point]]:
        return [(self.part, self.placed.local(self.part, self.inner))]

    def rows(self, chunk: Chunk) -> list[SampledRow]:
        bar, at = self._bar, self.frame.local(chunk, *self.locals()[0])
        return [RowCircle(at, bar.anchor(chunk), bar.length)]

    def place(self, chunk: Chunk, body: BodyKinematics) -> None:
        bar = self._bar
        far = self.frame.local(chunk, *self.locals()[0]).on(body)
        near = bar.anchor(chunk)
        chunk.bodies[self.link] = bar.body(spanning(near, far, bar.length), near)


def spanning(near: PointKinematics, far: PointKinematics, length: float) -> Turning:
    """Return a vector of constant length between two points, as a rotation."""
    span, drift, pull = far.p - near.p, far.v - near.v, far.a - near.a
    square = 1.0 / (length * length)
    omega, alpha = span.cross(drift) * square, span.cross(pull) * square
    error = None
    if near.error is not None and far.error is not None:
        place, loose, shove = (
            (one + other) / length
            for one, other in (
                (near.error.position, far.error.position),
                (near.error.velocity, far.error.velocity),
                (near.error.acceleration, far.error.acceleration),
            )
        )
        place = place + 4 * EPS
        lean = np.where(place < 0.5, 1.2 * place, np.pi)
        speed, shift = drift.norm() / length, pull.norm() / length
        error = AngleError(
            lean,
            loose * (1.0 + place) + (place + 4 * EPS) * speed,
            shove * (1.0 + place) + (place + 4 * EPS) * shift,
        )
    return Turning(span, omega, alpha, error, length)


@dataclass(frozen=True)
class SlidingLeg:
    """PR: a body that slides on, or along, a known one, pinned to the central link."""

    frame: CentralFrame
    placed: PlacedBodies
    part: str
    link: str
    slider: str
    inner: str

    def _riding(self) -> tuple[RidingLine, RidingLine, float, Point]:
        riding, own = (
            RidingLine.of(self.placed, self.slider),
            self.placed.local(self.link, self.inner),
        )
        return riding, *riding.through(own), own

    def locals(self) -> list[tuple[str, Point]]:
        return [(self.part, self.placed.local(self.part, self.inner))]

    def rows(self, chunk: Chunk) -> list[SampledRow]:
        at = self.frame.local(chunk, *self.locals()[0])
        return [OnLine(at, self._riding()[1].line(chunk))]

    def place(self, chunk: Chunk, body: BodyKinematics) -> None:
        riding, through, lead, own = self._riding()
        pin = self.frame.local(chunk, *self.locals()[0]).on(body)
        known = chunk.bodies[riding.known]
        chunk.bodies[self.link] = following_body(known, riding.follow, riding.rounding, own, pin)
        chunk.sliders[self.slider] = through.displacement(sliding(through.line(chunk), pin), lead)


def sliding(line: MovingLine, point: PointKinematics) -> Sliding:
    """Return the displacement of a point that runs on a moving line."""
    s = line.along.dot(point.p - line.point.p)
    drift = point.v - line.velocity(s)
    speed = line.along.dot(drift)
    pull = point.a - line.acceleration(s, speed)
    acceleration = line.along.dot(pull)
    if point.error is None or line.error is None:
        return Sliding(s, speed, acceleration)
    e, lean = point.error, line.error.theta + 2 * EPS
    place, _, _ = line.errors(s, speed, 0.0, 0.0)
    way = e.position + place + lean * np.abs(s) + 3 * EPS * (point.p.norm() + np.abs(s))
    loose = line.errors(s, speed, way, 0.0)[1] + e.velocity + lean * drift.norm()
    loose = loose + 4 * EPS * (point.v.norm() + line.sizes(s, speed)[1])
    shove = line.errors(s, speed, way, loose)[2] + e.acceleration + lean * pull.norm()
    shove = shove + 5 * EPS * (point.a.norm() + line.sizes(s, speed)[2])
    return Sliding(s, speed, acceleration, SlideError(way, loose, shove))


@dataclass(frozen=True)
class GuidedLeg:
    """RP: a body pinned to a known one that slides on, or along, the central link."""

    frame: CentralFrame
    placed: PlacedBodies
    part: str
    link: str
    outer: str
    slider: str

    def _riding(self) -> tuple[RidingLine, RidingLine, float, Point]:
        central = replace(self.placed, known=frozenset({self.part}))
        riding, own = RidingLine.of(central, self.slider), self.placed.local(self.link, self.outer)
        return riding, *riding.through(own), own

    def _pin(self, chunk: Chunk) -> PointKinematics:
        return chunk.point(self.placed.holder(self.outer), self.outer)

    def locals(self) -> list[tuple[str, Point]]:
        return [(self.part, self._riding()[1].base)]

    def _row(self, chunk: Chunk) -> Through:
        _, through, _, _ = self._riding()
        at = self.frame.local(chunk, self.part, through.base)
        lean = self.frame.leaning(chunk, self.part, through.angle)
        slack = through.slack
        if slack:
            at = replace(at, error=replace(at.error, position=at.error.position + slack))
        turning = (lean.omega, lean.alpha)
        return Through(at, lean.along, self._pin(chunk), turning, lean.error)

    def rows(self, chunk: Chunk) -> list[SampledRow]:
        return [self._row(chunk)]

    def place(self, chunk: Chunk, body: BodyKinematics) -> None:
        riding, through, lead, own = self._riding()
        pin, line = self._pin(chunk), self._row(chunk).line(body)
        carrier = chunk.bodies[self.part]
        chunk.bodies[self.link] = following_body(carrier, riding.follow, riding.rounding, own, pin)
        chunk.sliders[self.slider] = through.displacement(sliding(line, pin), lead)


@dataclass(frozen=True)
class PinnedThere:
    """R: the central link is pinned to a known body."""

    frame: CentralFrame
    placed: PlacedBodies
    part: str
    pin: str

    def locals(self) -> list[tuple[str, Point]]:
        return [(self.part, self.placed.local(self.part, self.pin))]

    def rows(self, chunk: Chunk) -> list[SampledRow]:
        at = self.frame.local(chunk, *self.locals()[0])
        known = chunk.point(self.placed.holder(self.pin), self.pin)
        error = EXACT_ANGLE if chunk.certified else None
        return [
            OnLine(at, MovingLine(known, along, 0.0, 0.0, error))
            for along in (Vec(1.0, 0.0), Vec(0.0, 1.0))
        ]

    def place(self, chunk: Chunk, body: BodyKinematics) -> None:
        """Add nothing."""


@dataclass(frozen=True)
class SlidingThere:
    """P: the central link slides on, or along, a known body."""

    frame: CentralFrame
    placed: PlacedBodies
    part: str
    slider: str
    size_m: float

    def _riding(self) -> RidingLine:
        return RidingLine.of(self.placed, self.slider)

    def locals(self) -> list[tuple[str, Point]]:
        return [(self.part, self._riding().rider)]

    def rows(self, chunk: Chunk) -> list[SampledRow]:
        riding = self._riding()
        at = self.frame.local(chunk, *self.locals()[0])
        kept = kept_angle(self.frame, chunk, self.part, riding, 0.0, self.size_m)
        return [kept, OnLine(at, riding.line(chunk))]

    def place(self, chunk: Chunk, body: BodyKinematics) -> None:
        riding = self._riding()
        at = self.frame.local(chunk, *self.locals()[0]).on(body)
        chunk.sliders[self.slider] = riding.displacement(sliding(riding.line(chunk), at), 0.0)


def kept_angle(
    frame: CentralFrame, chunk: Chunk, part: str, riding: RidingLine, back: float, size_m: float
) -> KeptAngle:
    """Return the row of a central link that keeps its angle to a known body: one of its bodies
    follows by ``riding``, less the angle ``back``."""
    known = chunk.bodies[riding.known]
    along = known.unit(riding.follow - back)
    own = frame.leaning(chunk, part, 0.0)
    omega, alpha, error = known.omega - own.omega, known.alpha - own.alpha, known.error
    along = along.turned(Vec(own.along.x, -own.along.y))
    if error is not None:
        e = own.error
        theta = error.theta + e.theta + riding.rounding + 4 * EPS * (1.0 + abs(back) / math.tau)
        error = AngleError(theta, error.omega + e.omega, error.alpha + e.alpha)
    return KeptAngle(along, omega, alpha, error, size_m)


@dataclass(frozen=True)
class DoublySlidingLeg:
    """PP: a body that slides on a known one, and the central link on it: that keeps its angle."""

    frame: CentralFrame
    placed: PlacedBodies
    part: str
    link: str
    outer: str
    inner: str
    size_m: float

    def _ridings(self) -> tuple[RidingLine, RidingLine]:
        """Return the leg on the known body, and the central link on the leg."""
        leg = replace(self.placed, known=frozenset({self.link}))
        return RidingLine.of(self.placed, self.outer), RidingLine.of(leg, self.inner)

    def locals(self) -> list[tuple[str, Point]]:
        return []

    def rows(self, chunk: Chunk) -> list[SampledRow]:
        outer, inner = self._ridings()
        kept = kept_angle(self.frame, chunk, self.part, outer, -inner.follow, self.size_m)
        if kept.error is not None:
            theta = kept.error.theta + inner.rounding
            kept = replace(kept, error=replace(kept.error, theta=theta))
        return [kept]

    def place(self, chunk: Chunk, body: BodyKinematics) -> None:
        """Place the leg where its line meets the one through the rider of the central link."""
        outer, inner = self._ridings()
        rider = self.frame.local(chunk, self.part, inner.rider).on(body)
        known = chunk.bodies[outer.known]
        line = outer.line(chunk)
        # The line of a leg at displacement 0, on the known body, goes through the rider when it is
        # shifted along the known line.
        chunk.bodies[self.link] = following_body(
            known, outer.follow, outer.rounding, outer.rider, line.point
        )
        guide = inner.line(chunk)
        shifted = MovingLine(guide.point, line.along, line.omega, line.alpha, line.error)
        across = MovingLine(rider, guide.along, line.omega, line.alpha, guide.error)
        crossing = prp.solve(
            shifted, across, certified=chunk.certified, stretch=chunk.stretch
        ).first
        at = riding_point(line, crossing)
        chunk.bodies[self.link] = following_body(
            known, outer.follow, outer.rounding, outer.rider, at
        )
        chunk.sliders[self.outer] = outer.displacement(crossing, 0.0)
        chunk.sliders[self.inner] = inner.displacement(sliding(inner.line(chunk), rider), 0.0)
