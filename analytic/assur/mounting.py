"""Mounting of the central link of a group: its frame, and the legs or joints that hold it."""

import math
import operator
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from analytic.assur.central_frame import CentralFrame
from analytic.assur.legs import (
    BarLeg,
    DoublySlidingLeg,
    GuidedLeg,
    LinkLeg,
    PinnedThere,
    SlidingLeg,
    SlidingThere,
    TriadLeg,
)
from analytic.assur.sampled_rows import LocalPoint, RowCircle, SampledRow
from analytic.dyads import plane
from analytic.dyads.chunk import Chunk
from analytic.dyads.plane import EPS, BodyKinematics, PointKinematics
from analytic.dyads.riding import PlacedBodies
from analytic.structure.groups import Compound, Group, JointKey, Triad, as_triad
from analytic.structure.groups import Leg as LegOfGroup
from models.errors import StructureError
from models.scene import Point, Scene, span


class Mounting:
    """Central link of a triad, or of a dyad with a compound, with its legs and joints."""

    def __init__(self, placed: PlacedBodies, group: Triad | Group) -> None:
        self.placed, self.group = placed, group
        scene, compound = placed.scene, placed.structure.compound
        own = compound if compound is not None and compound.name in group.bodies else None
        if own is not None and isinstance(group, Triad) and group.central != own.name:
            own = None  # a leg of it is driven
        central, held, joint = as_triad(group, own)
        body = central if own is None else own.base
        self.frame, self.size_m = CentralFrame(scene, body, (0.0, 0.0), own), scene.longest_m
        legs = [leg for leg in self._made(held, joint) if leg.part == body]
        points = [leg.held for leg in legs if leg.held is not None]
        origin = next(iter(scene.links[body].points.values()))
        if points:
            x, y = (math.fsum(row) / len(points) for row in zip(*points, strict=True))
            origin = x, y
        self.frame = replace(self.frame, origin=origin)
        self.size_m = _size(scene, self.frame, points)
        self.legs = self._made(held, joint)

    def _made(self, held: Sequence[LegOfGroup], joint: JointKey | None) -> list[TriadLeg]:
        legs = [self._leg(one) for one in held]
        return legs if joint is None else [*legs, self._joint(joint)]

    def rows(self, chunk: Chunk) -> list[SampledRow]:
        """Return the three rows of the central link."""
        return [row for leg in self.legs for row in leg.rows(chunk)]

    def place(self, chunk: Chunk, body: BodyKinematics) -> None:
        """Add the central link and its legs."""
        self.frame.place(chunk, body)
        for leg in self.legs:
            leg.place(chunk, body)

    def holder(self, chunk: Chunk, pin: str) -> str:
        """Return a placed body that carries a pin."""
        return next(body for body in self.placed.structure.pins[pin] if body in chunk.bodies)

    def _part(self, joint: JointKey) -> str:
        kind, name = joint
        for body in self.frame.bodies:
            if kind == "R" and body in self.placed.structure.pins[name]:
                return body
            if kind == "P" and body in self.placed.structure.prismatics[name]:
                return body
        raise AssertionError(f"{name} is no joint of {self.frame.bodies}")

    def _leg(self, leg: LegOfGroup) -> TriadLeg:
        part, outer, inner = self._part(leg.inner), leg.outer[1], leg.inner[1]
        compound = self.placed.structure.compound
        if compound is not None and leg.body == compound.name:
            return self._driven(leg, part, compound)
        given = (self.frame, self.placed, part, leg.body, outer, inner)
        if leg.kind == "RR":
            return BarLeg(*given)
        if leg.kind == "PR":
            return SlidingLeg(*given)
        if leg.kind == "RP":
            return GuidedLeg(*given)
        return DoublySlidingLeg(*given, self.size_m)

    def _driven(self, leg: LegOfGroup, part: str, compound: Compound) -> TriadLeg:
        """Return a leg that the driver moves. Raises StructureError where it slides."""
        scene = self.placed.scene
        if leg.kind != "RR":
            raise StructureError(
                f"{scene.name}: the driver is {scene.driver.joint}, in a leg of the class III "
                f"group about {self.frame.body} that slides ({leg.kind}), which has no solution "
                "here; drive another joint, or a leg with pins at both ends"
            )
        own = CentralFrame(scene, compound.base, (0.0, 0.0), compound)
        ends = (leg.body, leg.outer[1], leg.inner[1])
        return DrivenBarLeg(self.frame, self.placed, part, *ends, own)

    def _joint(self, joint: JointKey) -> TriadLeg:
        part = self._part(joint)
        if joint[0] == "R":
            return PinnedThere(self.frame, self.placed, part, joint[1])
        return SlidingThere(self.frame, self.placed, part, joint[1], self.size_m)


def _size(scene: Scene, frame: CentralFrame, points: Sequence[Point]) -> float:
    """Return a length of the central link, or of the longest where it has none [m]."""
    spans = [span(scene.links[body].points) for body in frame.bodies if body in scene.links]
    spans += [2.0 * math.dist(frame.origin, point) for point in points]
    return max(spans, default=0.0) or scene.longest_m


@dataclass(frozen=True)
class DrivenBarLeg(LinkLeg):
    """RR: ``own`` is the frame of the leg's two bodies.

    ::

          o---[cylinder]==[rod]---o       between a pin to a known body and one to the central link
    """

    own: CentralFrame

    def _pin(self, chunk: Chunk, pin: str) -> LocalPoint:
        """Return a pin in the frame of the leg."""
        body = next(b for b in self.own.bodies if b in self.placed.structure.pins[pin])
        return self.own.local(chunk, body, self.placed.local(body, pin))

    def span(self, chunk: Chunk) -> LocalPoint:
        """Return the vector from the outer pin to the inner one, in the frame of the leg."""
        near, far = self._pin(chunk, self.outer), self._pin(chunk, self.inner)
        error = plane.PointError(*map(operator.add, near.error, far.error))
        return LocalPoint(far.p - near.p, far.v - near.v, far.a - near.a, error, True)

    def rows(self, chunk: Chunk) -> list[SampledRow]:
        d = self.span(chunk)
        length = d.p.norm()
        rate = d.p.dot(d.v) / length
        across = d.v.square() - rate * rate
        second = (d.p.dot(d.a) + across) / length
        e, speed = d.error, d.v.norm()
        off = (
            e.position + 2 * EPS * length,
            e.velocity + 2.0 * speed * e.position / length + 4 * EPS * speed,
            e.acceleration
            + 2.0 * d.a.norm() * e.position / length
            + (4.0 * speed * e.velocity + 4.0 * speed * speed * e.position / length) / length
            + 8 * EPS * (d.a.norm() + speed * speed / length),
        )
        near = self.known_pin(chunk, self.outer)
        return [RowCircle(self.end(chunk), near, length, rate, second, off)]

    def place(self, chunk: Chunk, body: BodyKinematics) -> None:
        near, far = self.known_pin(chunk, self.outer), self.end(chunk).on(body)
        leg = _turned(near, far, self.span(chunk))
        anchor = _origin(leg, self._pin(chunk, self.outer), near)
        self.own.place(chunk, replace(leg, anchor=anchor))


def _turned(near: PointKinematics, far: PointKinematics, d: LocalPoint) -> BodyKinematics:
    """Return the frame in which the way between two points is ``d``, with its origin at rest."""
    still = plane.fixed_point((0.0, 0.0))
    span, drift, pull = far.p - near.p, far.v - near.v, far.a - near.a
    square = 1.0 / d.p.square()
    turn = span.turned(plane.Vec(d.p.x, -d.p.y)) * square
    turn = turn * (1.0 / turn.norm())
    own = drift - d.v.turned(turn)
    omega = span.cross(own) * square
    rest = pull - d.a.turned(turn) - d.v.turned(turn).perp(2.0 * omega)
    alpha = span.cross(rest) * square
    if near.error is None or far.error is None:
        return BodyKinematics((0.0, 0.0), still, turn, omega, alpha, None)
    length = d.p.norm()
    e, f, g = near.error, far.error, d.error
    lean = (e.position + f.position + g.position) / length + 4 * EPS
    theta = np.where(lean < 0.5, 1.2 * lean, np.pi)
    slip, speed = d.v.norm() / length, own.norm() / length
    w = (e.velocity + f.velocity + g.velocity) / length + slip * theta
    w = w * (1.0 + lean) + 2.0 * (lean + 4 * EPS) * speed
    shift = d.a.norm() / length
    a = (e.acceleration + f.acceleration + g.acceleration) / length + shift * theta
    a = a + 2.0 * (slip * w + np.abs(omega) * (g.velocity / length + slip * theta))
    a = a * (1.0 + lean) + 2.0 * (lean + 6 * EPS) * rest.norm() / length
    error = plane.AngleError(theta, w, a)
    return BodyKinematics((0.0, 0.0), still, turn, omega, alpha, error)


def _origin(frame: BodyKinematics, local: LocalPoint, at: PointKinematics) -> PointKinematics:
    """Return the origin of a frame from the known place of a point that may move in it."""
    way = replace(local, moves=True).on(frame)
    bounds = None
    if at.error is not None and way.error is not None:
        levels = zip(at.error, way.error, (at.p, at.v, at.a), strict=True)
        bounds = plane.PointError(*(e + f + EPS * known.norm() for e, f, known in levels))
    return PointKinematics(at.p - way.p, at.v - way.v, at.a - way.a, bounds)
