"""Legs of a triad and joints of a link to known bodies: their rows and positions.

Each makes its rows at the samples of a chunk, and, when the central link is placed, adds its own
link and sliders to the chunk.
"""

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass, replace

import numpy as np

from analytic.assur.central_frame import CentralFrame
from analytic.assur.sampled_rows import (
    KeptAngle,
    LocalPoint,
    OnLine,
    RowCircle,
    SampledRow,
    Through,
)
from analytic.dyads import prp
from analytic.dyads.chunk import Chunk
from analytic.dyads.parts import MovingLine, SlideError, Sliding, Turning
from analytic.dyads.plane import EPS, EXACT_ANGLE, AngleError, BodyKinematics, PointKinematics, Vec
from analytic.dyads.riding import Bar, PlacedBodies, RidingLine, riding_point
from models.scene import Point


@dataclass(frozen=True)
class TriadLeg(ABC):
    """Leg or joint that holds the body ``part`` of the central link by one row or two."""

    frame: CentralFrame
    placed: PlacedBodies
    part: str

    @abstractmethod
    def rows(self, chunk: Chunk) -> list[SampledRow]:
        """Return its rows while the central link is unknown."""

    @abstractmethod
    def place(self, chunk: Chunk, body: BodyKinematics) -> None:
        """Add its own link and sliders; ``body`` is the central link by its anchor."""

    @property
    def held(self) -> Point | None:
        """Point of the part that it holds; None where it holds an angle alone."""
        return None

    def end(self, chunk: Chunk) -> LocalPoint:
        """Return that point in the frame of the central link."""
        assert self.held is not None
        return self.frame.local(chunk, self.part, self.held)

    def known_pin(self, chunk: Chunk, pin: str) -> PointKinematics:
        """Return the motion of a pin of a known body."""
        return chunk.point(self.placed.holder(pin), pin)


@dataclass(frozen=True)
class LinkLeg(TriadLeg):
    """Leg by its link, its pair to a known body and that to the central link."""

    link: str
    outer: str
    inner: str

    @property
    def held(self) -> Point | None:
        return self.placed.local(self.part, self.inner)


@dataclass(frozen=True)
class BarLeg(LinkLeg):
    """RR: a link between a known pin and one of the central link."""

    @property
    def _bar(self) -> Bar:
        return Bar(self.placed, self.link, self.outer, self.inner)

    def rows(self, chunk: Chunk) -> list[SampledRow]:
        bar = self._bar
        return [RowCircle(self.end(chunk), bar.anchor(chunk), bar.length)]

    def place(self, chunk: Chunk, body: BodyKinematics) -> None:
        bar = self._bar
        far, near = self.end(chunk).on(body), bar.anchor(chunk)
        chunk.bodies[self.link] = bar.body(spanning(near, far, bar.length), near)


def spanning(near: PointKinematics, far: PointKinematics, length: float) -> Turning:
    """Return a vector of constant length between two points, as a rotation."""
    span, drift, pull = far.p - near.p, far.v - near.v, far.a - near.a
    square = 1.0 / (length * length)
    omega, alpha = span.cross(drift) * square, span.cross(pull) * square
    error = None
    if near.error is not None and far.error is not None:
        pairs = zip(near.error, far.error, strict=True)
        place, loose, shove = ((one + other) / length for one, other in pairs)
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
class SlidingLeg(LinkLeg):
    """PR: a body that slides on, or along, a known one, pinned to the central link."""

    def _riding(self) -> tuple[RidingLine, RidingLine, float, Point]:
        riding = RidingLine.of(self.placed, self.outer)
        own = self.placed.local(self.link, self.inner)
        return riding, *riding.through(own), own

    def rows(self, chunk: Chunk) -> list[SampledRow]:
        return [OnLine(self.end(chunk), self._riding()[1].line(chunk))]

    def place(self, chunk: Chunk, body: BodyKinematics) -> None:
        riding, through, lead, own = self._riding()
        pin = self.end(chunk).on(body)
        chunk.bodies[self.link] = riding.follower(chunk, own, pin)
        chunk.sliders[self.outer] = through.displacement(sliding(through.line(chunk), pin), lead)


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
class GuidedLeg(LinkLeg):
    """RP: a body pinned to a known one that slides on, or along, the central link."""

    def _riding(self) -> tuple[RidingLine, RidingLine, float, Point]:
        central = replace(self.placed, known=frozenset({self.part}))
        riding, own = RidingLine.of(central, self.inner), self.placed.local(self.link, self.outer)
        return riding, *riding.through(own), own

    @property
    def held(self) -> Point | None:
        return self._riding()[1].base

    def _row(self, chunk: Chunk) -> Through:
        through, at = self._riding()[1], self.end(chunk)
        lean = self.frame.leaning(chunk, self.part, through.angle)
        if through.slack:
            error = at.error._replace(position=at.error.position + through.slack)
            at = replace(at, error=error)
        pin = self.known_pin(chunk, self.outer)
        return Through(at, lean.along, pin, (lean.omega, lean.alpha), lean.error)

    def rows(self, chunk: Chunk) -> list[SampledRow]:
        return [self._row(chunk)]

    def place(self, chunk: Chunk, body: BodyKinematics) -> None:
        riding, through, lead, own = self._riding()
        pin, line = self.known_pin(chunk, self.outer), self._row(chunk).line(body)
        chunk.bodies[self.link] = riding.follower(chunk, own, pin)
        chunk.sliders[self.inner] = through.displacement(sliding(line, pin), lead)


@dataclass(frozen=True)
class PinnedThere(TriadLeg):
    """R: the central link is pinned to a known body."""

    pin: str

    @property
    def held(self) -> Point | None:
        return self.placed.local(self.part, self.pin)

    def rows(self, chunk: Chunk) -> list[SampledRow]:
        at, known = self.end(chunk), self.known_pin(chunk, self.pin)
        error = EXACT_ANGLE if chunk.certified else None
        return [
            OnLine(at, MovingLine(known, along, 0.0, 0.0, error))
            for along in (Vec(1.0, 0.0), Vec(0.0, 1.0))
        ]

    def place(self, chunk: Chunk, body: BodyKinematics) -> None:
        """Add nothing."""


@dataclass(frozen=True)
class SlidingThere(TriadLeg):
    """P: the central link slides on, or along, a known body."""

    slider: str
    size_m: float

    @property
    def _riding(self) -> RidingLine:
        return RidingLine.of(self.placed, self.slider)

    @property
    def held(self) -> Point | None:
        return self._riding.rider

    def rows(self, chunk: Chunk) -> list[SampledRow]:
        riding, at = self._riding, self.end(chunk)
        return [kept_angle(self, chunk, riding, 0.0, self.size_m), OnLine(at, riding.line(chunk))]

    def place(self, chunk: Chunk, body: BodyKinematics) -> None:
        riding, at = self._riding, self.end(chunk).on(body)
        chunk.sliders[self.slider] = riding.displacement(sliding(riding.line(chunk), at), 0.0)


def kept_angle(
    leg: TriadLeg, chunk: Chunk, riding: RidingLine, back: float, size_m: float
) -> KeptAngle:
    """Return the row of a central link that keeps its angle to a known body: the part that a leg
    holds follows by ``riding``, less the angle ``back``."""
    known = chunk.bodies[riding.known]
    along = known.unit(riding.follow - back)
    own = leg.frame.leaning(chunk, leg.part, 0.0)
    omega, alpha, error = known.omega - own.omega, known.alpha - own.alpha, known.error
    along = along.turned(Vec(own.along.x, -own.along.y))
    if error is not None:
        e = own.error
        theta = error.theta + e.theta + riding.rounding + 4 * EPS * (1.0 + abs(back) / math.tau)
        error = AngleError(theta, error.omega + e.omega, error.alpha + e.alpha)
    return KeptAngle(along, omega, alpha, error, size_m)


@dataclass(frozen=True)
class DoublySlidingLeg(LinkLeg):
    """PP: a body that slides on a known one, and the central link on it: that keeps its angle."""

    size_m: float

    def _ridings(self) -> tuple[RidingLine, RidingLine]:
        """Return the leg on the known body, and the central link on the leg."""
        leg = replace(self.placed, known=frozenset({self.link}))
        return RidingLine.of(self.placed, self.outer), RidingLine.of(leg, self.inner)

    @property
    def held(self) -> Point | None:
        return None

    def rows(self, chunk: Chunk) -> list[SampledRow]:
        outer, inner = self._ridings()
        kept = kept_angle(self, chunk, outer, -inner.follow, self.size_m)
        if kept.error is not None:
            theta = kept.error.theta + inner.rounding
            kept = replace(kept, error=kept.error._replace(theta=theta))
        return [kept]

    def place(self, chunk: Chunk, body: BodyKinematics) -> None:
        """Place the leg where its line meets the one through the rider of the central link."""
        outer, inner = self._ridings()
        rider = self.frame.local(chunk, self.part, inner.rider).on(body)
        line = outer.line(chunk)
        # The line of a leg at displacement 0, on the known body, goes through the rider when it is
        # shifted along the known line.
        chunk.bodies[self.link] = outer.follower(chunk, outer.rider, line.point)
        guide = inner.line(chunk)
        shifted = MovingLine(guide.point, line.along, line.omega, line.alpha, line.error)
        across = MovingLine(rider, guide.along, line.omega, line.alpha, guide.error)
        crossing = prp.solve(
            shifted, across, certified=chunk.certified, stretch=chunk.stretch
        ).first
        at = riding_point(line, crossing)
        chunk.bodies[self.link] = outer.follower(chunk, outer.rider, at)
        chunk.sliders[self.outer] = outer.displacement(crossing, 0.0)
        chunk.sliders[self.inner] = inner.displacement(sliding(inner.line(chunk), rider), 0.0)
