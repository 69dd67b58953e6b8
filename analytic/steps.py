"""From a structural group to its closed-form step: geometry prepared once, solved per chunk.

A prismatic pair joins a guide (the body that carries the line) and a slider body (block or link).
Either of the two may be the known one, so the pair is first written as a line of the *known* body
(`RidingLine`), on which a pin of the unknown body rides at a constant offset.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Protocol

import numpy as np

from analytic.dyads import prp, rpp, rpr, rrp, rrr
from analytic.dyads.parts import Dyad, MovingLine, SlideError, Sliding, Turning
from analytic.plane import (
    EPS,
    BodyKinematics,
    PointError,
    PointKinematics,
    Real,
    Vec,
    direction,
    fixed_point,
)
from analytic.structure import Group, Structure, block_name
from models.scene import GROUND, Point, Scene


@dataclass(slots=True)
class Chunk:
    """What is known so far of a chunk of samples."""

    scene: Scene
    certified: bool
    stretch: bool
    bodies: dict[str, BodyKinematics]
    sliders: dict[str, Sliding] = field(default_factory=dict)
    sines: dict[str, Real] = field(default_factory=dict)
    shortage: dict[str, Real] = field(default_factory=dict)
    points: dict[str, PointKinematics] = field(default_factory=dict)

    def point(self, body: str, name: str) -> PointKinematics:
        """A named point by way of ``body``, worked out once."""
        if name not in self.points:
            local = local_point(self.scene, body, name)
            self.points[name] = (
                fixed_point(local) if body == GROUND else self.bodies[body].point(local)
            )
        return self.points[name]

    def keep(self, key: str, dyad: Dyad) -> None:
        """Note the conditioning of a solved dyad."""
        self.sines[key] = dyad.sine
        if dyad.short_m is not None:
            self.shortage[key] = dyad.short_m


class Step(Protocol):
    """A prepared group; ``key`` names its dyad in the motion's conditioning."""

    @property
    def key(self) -> str: ...

    def advance(self, chunk: Chunk) -> None:
        """Add the group's bodies and sliders to the chunk. Raises OpenError."""
        ...


def local_point(scene: Scene, body: str, name: str) -> Point:
    """A named point in the frame of a body; a slider block has its pin at the origin."""
    if body == GROUND:
        return scene.ground[name]
    if body in scene.links:
        return scene.links[body].points[name]
    return (0.0, 0.0)


def prepare(scene: Scene, structure: Structure) -> list[Step]:
    """The steps of all groups, in solving order."""
    known = {GROUND, scene.driver.link}
    steps = []
    for group in structure.groups:
        steps.append(_STEPS[group.kind](scene, structure, group, frozenset(known)))
        known |= {group.first, group.second}
    return steps


def _turn(angle: float, v: Point) -> Point:
    """A constant vector turned by a constant angle."""
    if angle == 0.0:
        return v
    c, s = math.cos(angle), math.sin(angle)
    return (v[0] * c - v[1] * s, v[0] * s + v[1] * c)


def _less(a: Point, b: Point) -> Point:
    return (a[0] - b[0], a[1] - b[1])


def _known_at(structure: Structure, known: frozenset[str], pin: str) -> str:
    """A known body that carries the pin."""
    return next(body for body in structure.pins[pin] if body in known)


def _turning_body(
    found: Turning, back: Vec, local: Point, anchor: PointKinematics
) -> BodyKinematics:
    """The body whose frame stands at the angle of ``found`` less that of ``back``."""
    aligned = back.x == 1.0 and back.y == 0.0
    turn = found.turn if aligned else found.turn.turned(Vec(back.x, -back.y))
    return BodyKinematics(
        local, anchor, turn, found.omega, found.alpha, found.error, None, found.length
    )


def _following_body(
    known: BodyKinematics, by: float, local: Point, anchor: PointKinematics
) -> BodyKinematics:
    """The body that keeps the angle ``by`` to a known body."""
    theta = None if known.theta is None else known.theta + by
    error = known.error
    if error is not None and by != 0.0:
        error = replace(error, theta=error.theta + 4 * EPS * (1.0 + abs(by)))
    turn = known.turn.turned(direction(by))
    return BodyKinematics(local, anchor, turn, known.omega, known.alpha, error, theta, known.length)


@dataclass(frozen=True)
class RidingLine:
    """A prismatic pair as a line of its known body.

    The line goes through ``base`` at ``angle`` in the known body's frame; the slider's
    displacement is ``sign`` times the coordinate on this line. The unknown body keeps the angle
    ``follow`` to the known one, and its point ``rider`` (in its own frame) is the one on the line.
    """

    known: str
    base: Point
    angle: float
    sign: int
    follow: float
    rider: Point

    @staticmethod
    def of(scene: Scene, name: str, known: frozenset[str]) -> RidingLine:
        """The pair of slider ``name``, of which one body is known."""
        slider = scene.sliders[name]
        body = block_name(slider)
        pin = local_point(scene, body, slider.point)
        if slider.on in known:
            follow = slider.direction_rad + slider.angle_rad
            return RidingLine(slider.on, slider.through_m, slider.direction_rad, 1, follow, pin)
        follow = -slider.direction_rad - slider.angle_rad
        return RidingLine(body, pin, -slider.angle_rad, -1, follow, slider.through_m)

    def through(self, local: Point) -> tuple[RidingLine, float]:
        """The parallel line of another point of the unknown body, and that point's lead on it."""
        lead, aside = _turn(self.follow - self.angle, _less(local, self.rider))
        shift = _turn(self.angle, (0.0, aside))
        base = (self.base[0] + shift[0], self.base[1] + shift[1])
        return replace(self, base=base, rider=local), lead

    def line(self, chunk: Chunk) -> MovingLine:
        """The line in motion."""
        body = chunk.bodies[self.known]
        along = body.unit(self.angle)
        error = body.error
        if error is not None:
            error = replace(error, theta=error.theta + 4 * EPS)
        return MovingLine(body.point(self.base), along, body.omega, body.alpha, error)

    def displacement(self, found: Sliding, lead: float) -> Sliding:
        """The slider's own displacement from the coordinate of a point that leads it."""
        s = (found.s - lead) * self.sign if lead or self.sign < 0 else found.s
        speed = found.speed * self.sign if self.sign < 0 else found.speed
        acceleration = found.acceleration * self.sign if self.sign < 0 else found.acceleration
        error = found.error
        if error is not None and lead:
            rounding = 4 * EPS * (abs(lead) + np.abs(found.s))
            error = SlideError(error.displacement + rounding, error.speed, error.acceleration)
        return Sliding(s, speed, acceleration, error)


def _riding_point(line: MovingLine, found: Sliding) -> PointKinematics:
    """The motion of the point that slides on a moving line."""
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
        place + e.displacement + 6 * EPS * sizes[0],
        drift + e.speed + np.abs(speed) * line.error.theta + 6 * EPS * (sizes[1] + np.abs(speed)),
        shove
        + e.acceleration
        + np.abs(found.acceleration) * line.error.theta
        + 8 * EPS * (sizes[2] + np.abs(found.acceleration)),
    )
    return PointKinematics(p, v, a, error)


class RRRStep:
    """Two links between two known pins."""

    def __init__(
        self, scene: Scene, structure: Structure, group: Group, known: frozenset[str]
    ) -> None:
        self.group, self.key = group, group.branch_key
        self.hold1 = _known_at(structure, known, group.outer1)
        self.hold2 = _known_at(structure, known, group.outer2)
        self.local1 = local_point(scene, group.first, group.outer1)
        self.local2 = local_point(scene, group.second, group.outer2)
        span1 = _less(local_point(scene, group.first, group.inner), self.local1)
        span2 = _less(local_point(scene, group.second, group.inner), self.local2)
        self.l1, self.l2 = math.hypot(*span1), math.hypot(*span2)
        self.back1 = Vec(span1[0] / self.l1, span1[1] / self.l1)
        self.back2 = Vec(span2[0] / self.l2, span2[1] / self.l2)
        self.branch = scene.branch.get(self.key, 1)

    def advance(self, chunk: Chunk) -> None:
        g = self.group
        p1, p2 = chunk.point(self.hold1, g.outer1), chunk.point(self.hold2, g.outer2)
        dyad = rrr.solve(
            p1, p2, self.l1, self.l2, self.branch, certified=chunk.certified, stretch=chunk.stretch
        )
        assert isinstance(dyad.first, Turning)
        assert isinstance(dyad.second, Turning)
        chunk.bodies[g.first] = _turning_body(dyad.first, self.back1, self.local1, p1)
        chunk.bodies[g.second] = _turning_body(dyad.second, self.back2, self.local2, p2)
        chunk.keep(self.key, dyad)


class RRPStep:
    """A link from a known pin to a body that slides on, or along, a known one."""

    def __init__(
        self, scene: Scene, structure: Structure, group: Group, known: frozenset[str]
    ) -> None:
        self.group, self.key = group, group.branch_key
        self.hold = _known_at(structure, known, group.outer1)
        self.local = local_point(scene, group.first, group.outer1)
        self.inner = local_point(scene, group.first, group.inner)
        span = _less(self.inner, self.local)
        self.length = math.hypot(*span)
        self.back = Vec(span[0] / self.length, span[1] / self.length)
        self.rider = local_point(scene, group.second, group.inner)
        self.riding = RidingLine.of(scene, group.outer2, known)
        self.through, self.lead = self.riding.through(self.rider)
        self.branch = scene.branch.get(self.key, 1) * self.riding.sign

    def advance(self, chunk: Chunk) -> None:
        g = self.group
        p1, line = chunk.point(self.hold, g.outer1), self.through.line(chunk)
        dyad = rrp.solve(
            p1, line, self.length, self.branch, certified=chunk.certified, stretch=chunk.stretch
        )
        assert isinstance(dyad.first, Turning)
        assert isinstance(dyad.second, Sliding)
        chunk.bodies[g.first] = _turning_body(dyad.first, self.back, self.local, p1)
        pin = _riding_point(line, dyad.second)
        known = chunk.bodies[self.riding.known]
        chunk.bodies[g.second] = _following_body(known, self.riding.follow, self.rider, pin)
        chunk.sliders[g.outer2] = self.riding.displacement(dyad.second, self.lead)
        chunk.keep(self.key, dyad)


class RPRStep:
    """A slider body pinned to a known one, on a guide that turns about another known pin."""

    def __init__(
        self, scene: Scene, structure: Structure, group: Group, known: frozenset[str]
    ) -> None:
        self.key = self.slider = group.inner
        slider = scene.sliders[group.inner]
        self.body, self.guide = block_name(slider), slider.on
        self.pin1, self.pin2 = group.outer1, group.outer2
        if group.first == self.guide:
            self.pin1, self.pin2 = self.pin2, self.pin1
        self.hold1 = _known_at(structure, known, self.pin1)
        self.hold2 = _known_at(structure, known, self.pin2)
        self.local1 = local_point(scene, self.body, self.pin1)
        self.local2 = local_point(scene, self.guide, self.pin2)
        foot = _turn(-slider.direction_rad, _less(slider.through_m, self.local2))
        tip = local_point(scene, self.body, slider.point)
        reach = _turn(slider.angle_rad, _less(tip, self.local1))
        self.lead, self.offset = foot[0] - reach[0], foot[1] - reach[1]
        self.back1, self.back2 = direction(-slider.angle_rad), direction(slider.direction_rad)
        self.branch = scene.branch.get(self.key, 1)

    def advance(self, chunk: Chunk) -> None:
        p1, p2 = chunk.point(self.hold1, self.pin1), chunk.point(self.hold2, self.pin2)
        dyad = rpr.solve(
            p1, p2, self.offset, self.branch, certified=chunk.certified, stretch=chunk.stretch
        )
        assert isinstance(dyad.first, Turning)
        assert isinstance(dyad.second, Sliding)
        chunk.bodies[self.body] = _turning_body(dyad.first, self.back1, self.local1, p1)
        chunk.bodies[self.guide] = _turning_body(dyad.first, self.back2, self.local2, p2)
        found = dyad.second
        error = found.error
        if error is not None and self.lead:
            rounding = 4 * EPS * (abs(self.lead) + np.abs(found.s))
            error = replace(error, displacement=error.displacement + rounding)
        chunk.sliders[self.slider] = replace(found, s=found.s - self.lead, error=error)
        chunk.keep(self.key, dyad)


class PRPStep:
    """Two bodies pinned to each other, each sliding on, or along, a known one."""

    def __init__(
        self, scene: Scene, structure: Structure, group: Group, known: frozenset[str]
    ) -> None:
        self.group, self.key = group, group.branch_key
        ends = ((group.first, group.outer1), (group.second, group.outer2))
        self.locals = [local_point(scene, body, group.inner) for body, _ in ends]
        self.ridings = [RidingLine.of(scene, slider, known) for _, slider in ends]
        self.through = [r.through(at) for r, at in zip(self.ridings, self.locals, strict=True)]

    def advance(self, chunk: Chunk) -> None:
        g = self.group
        lines = [through.line(chunk) for through, _ in self.through]
        dyad = prp.solve(*lines, certified=chunk.certified, stretch=chunk.stretch)
        ends = ((g.first, g.outer1, dyad.first), (g.second, g.outer2, dyad.second))
        for i, (body, slider, found) in enumerate(ends):
            assert isinstance(found, Sliding)
            riding, pin = self.ridings[i], _riding_point(lines[i], found)
            known = chunk.bodies[riding.known]
            chunk.bodies[body] = _following_body(known, riding.follow, self.locals[i], pin)
            chunk.sliders[slider] = riding.displacement(found, self.through[i][1])
        chunk.keep(self.key, dyad)


class RPPStep:
    """A body pinned to a known one slides on a body that slides on a known one."""

    def __init__(
        self, scene: Scene, structure: Structure, group: Group, known: frozenset[str]
    ) -> None:
        self.group, self.key = group, group.branch_key
        self.hold = _known_at(structure, known, group.outer1)
        self.local = local_point(scene, group.first, group.outer1)
        self.outer = RidingLine.of(scene, group.outer2, known)
        inner = RidingLine.of(scene, group.inner, frozenset({group.second}))
        # Everything below is in the frame of the known body, in which both lines keep their angle.
        self.follow = self.outer.follow + inner.follow
        offset = _turn(self.outer.follow, _less(inner.base, self.outer.rider))
        arm = _turn(self.follow, _less(self.local, inner.rider))
        base = self.outer.base
        self.base = (base[0] + offset[0] + arm[0], base[1] + offset[1] + arm[1])
        self.inner = inner
        self.between = direction(self.outer.follow + inner.angle - self.outer.angle)

    def advance(self, chunk: Chunk) -> None:
        g = self.group
        p1 = chunk.point(self.hold, g.outer1)
        line = replace(self.outer, base=self.base).line(chunk)
        dyad = rpp.solve(p1, line, self.between, certified=chunk.certified, stretch=chunk.stretch)
        assert isinstance(dyad.first, Sliding)
        assert isinstance(dyad.second, Sliding)
        known = chunk.bodies[self.outer.known]
        rider = _riding_point(self.outer.line(chunk), dyad.first)
        chunk.bodies[g.second] = _following_body(known, self.outer.follow, self.outer.rider, rider)
        chunk.bodies[g.first] = _following_body(known, self.follow, self.local, p1)
        chunk.sliders[g.outer2] = self.outer.displacement(dyad.first, 0.0)
        chunk.sliders[g.inner] = self.inner.displacement(dyad.second, 0.0)
        chunk.keep(self.key, dyad)


_STEPS: dict[str, Callable[[Scene, Structure, Group, frozenset[str]], Step]] = {
    "RRR": RRRStep,
    "RRP": RRPStep,
    "RPR": RPRStep,
    "PRP": PRPStep,
    "RPP": RPPStep,
}
