"""Closed-form steps of structural groups: geometry prepared once, solved per chunk."""

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Protocol

import numpy as np

from analytic.dyads import prp, riding, rpp, rpr, rrp, rrr
from analytic.dyads.chunk import Chunk, Passage
from analytic.dyads.plane import STEADY, AngleError, direction, rounding_of_angles
from analytic.dyads.riding import Bar, PlacedBodies, RidingLine, riding_point
from analytic.structure.groups import Group
from models.array import Array
from models.motion import Crossing
from models.scene import Scene
from models.scene.joints import less, sliding_body, turned


class Step(Protocol):
    """Prepared group; ``key`` names its dyad in the motion's conditioning."""

    @property
    def key(self) -> str: ...

    def advance(self, chunk: Chunk) -> None:
        """Add the group's bodies and sliders to the chunk. Raises OpenError."""


class PeriodicStep(ABC):
    """Step whose bodies may come back after more turns of the driver than those before it."""

    key: str

    @abstractmethod
    def advance(self, chunk: Chunk) -> None: ...

    @abstractmethod
    def period(self, passages: Mapping[str, Passage], base: float) -> float | None:
        """Return the driver angle after which the bodies come back [rad], a multiple of ``base``,
        that of the steps before; None where they end."""


def common_period(steps: Iterable[Step], passages: Mapping[str, Passage]) -> float:
    """Return the driver angle [rad] after which positions repeat, with the known change points."""
    period = max((passage.period for passage in passages.values()), default=math.tau)
    for step in steps:
        if isinstance(step, PeriodicStep):
            period = max(period, step.period(passages, period) or math.tau)
    return period


class FollowedStep(PeriodicStep):
    """Step of a group that has no closed form: its assembly is followed along the driver."""

    @abstractmethod
    def passed(
        self, passages: Mapping[str, Passage], low: float, high: float
    ) -> tuple[Crossing, ...]:
        """Return the group's change points that a driver passes between two angles, each once."""

    @abstractmethod
    def end_in_words(self, passages: Mapping[str, Passage], theta: float) -> str:
        """Return the text of the end beside a driver angle [rad]."""


def stretched(
    scene: Scene, steps: Sequence[Step], theta: Array, passages: Mapping[str, Passage] | None = None
) -> Chunk:
    """Return the mechanism at driver angles that may be out of reach, with open dyads in line."""
    zero = np.zeros_like(theta)
    chunk = Chunk.begin(scene, theta, zero, zero, stretch=True, passages=passages)
    with np.errstate(all="ignore"):  # parallel lines cross at infinity
        for step in steps:
            step.advance(chunk)
    return chunk


@np.errstate(all="ignore")
def uncertain_chunk(
    scene: Scene,
    steps: Sequence[Step],
    theta: Array,
    half: Array | float,
    passages: Mapping[str, Passage],
) -> Chunk:
    """Return the mechanism, stretched, at driver angles with this uncertainty [rad], the driver at
    1 rad/s and steady."""
    error = AngleError(np.broadcast_to(half, theta.shape), 0.0, 0.0)
    chunk = Chunk.begin(scene, theta, 1.0, STEADY, error, stretch=True, passages=passages)
    for step in steps:
        step.advance(chunk)
    return chunk


class RRRStep:
    """Two links between two known pins."""

    def __init__(self, placed: PlacedBodies, group: Group) -> None:
        self.key = group.branch_key
        self.bar1 = Bar(placed, group.first, group.outer1, group.inner)
        self.bar2 = Bar(placed, group.second, group.outer2, group.inner)

    def advance(self, chunk: Chunk) -> None:
        one, other = self.bar1, self.bar2
        p1, p2 = one.anchor(chunk), other.anchor(chunk)
        dyad = chunk.closed(self.key, rrr.solve, p1, p2, one.length, other.length)
        chunk.bodies[one.link] = one.body(dyad.first, p1)
        chunk.bodies[other.link] = other.body(dyad.second, p2)


class RRPStep:
    """A link from a known pin to a body that slides on, or along, a known one."""

    def __init__(self, placed: PlacedBodies, group: Group) -> None:
        self.group, self.key = group, group.branch_key
        self.bar = Bar(placed, group.first, group.outer1, group.inner)
        self.rider = placed.local(group.second, group.inner)
        self.riding = RidingLine.of(placed, group.outer2)
        self.through, self.lead = self.riding.through(self.rider)

    def advance(self, chunk: Chunk) -> None:
        g, length, side = self.group, self.bar.length, self.riding.sign
        p1, line = self.bar.anchor(chunk), self.through.line(chunk)
        dyad = chunk.closed(self.key, rrp.solve, p1, line, length, side=side)
        chunk.bodies[g.first] = self.bar.body(dyad.first, p1)
        pin = riding_point(line, dyad.second)
        chunk.bodies[g.second] = self.riding.follower(chunk, self.rider, pin)
        chunk.sliders[g.outer2] = self.through.displacement(dyad.second, self.lead)


class RPRStep:
    """A slider body pinned to a known one, on a guide that turns about another known pin."""

    def __init__(self, placed: PlacedBodies, group: Group) -> None:
        self.key = self.slider = group.inner
        slider = placed.scene.sliders[group.inner]
        self.body, self.guide = sliding_body(slider), slider.on
        self.pin1, self.pin2 = group.outer1, group.outer2
        if group.first == self.guide:
            self.pin1, self.pin2 = self.pin2, self.pin1
        self.hold1, self.hold2 = placed.holder(self.pin1), placed.holder(self.pin2)
        self.local1 = placed.local(self.body, self.pin1)
        self.local2 = placed.local(self.guide, self.pin2)
        foot = turned(less(slider.through_m, self.local2), -slider.direction_rad)
        tip = placed.local(self.body, slider.point)
        reach = turned(less(tip, self.local1), slider.angle_rad)
        self.lead, self.offset = foot[0] - reach[0], foot[1] - reach[1]
        line, angle = slider.direction_rad, slider.angle_rad
        self.slack = riding.rounding_of((line, angle), foot, reach)
        self.back1, self.back2 = direction(-angle), direction(line)
        self.rounding1, self.rounding2 = rounding_of_angles(angle), rounding_of_angles(line)

    def advance(self, chunk: Chunk) -> None:
        p1, p2 = chunk.point(self.hold1, self.pin1), chunk.point(self.hold2, self.pin2)
        block = p1
        if p1.error is not None and self.slack:
            error = p1.error._replace(position=p1.error.position + self.slack)
            block = replace(p1, error=error)
        dyad = chunk.closed(self.key, rpr.solve, block, p2, self.offset)
        found = dyad.first
        chunk.bodies[self.body] = riding.turning_body(
            found, self.back1, self.local1, p1, self.rounding1
        )
        chunk.bodies[self.guide] = riding.turning_body(
            found, self.back2, self.local2, p2, self.rounding2
        )
        chunk.sliders[self.slider] = riding.without_lead(dyad.second, self.lead, self.slack)


class PRPStep:
    """Two bodies pinned to each other, each sliding on, or along, a known one."""

    def __init__(self, placed: PlacedBodies, group: Group) -> None:
        self.group, self.key = group, group.branch_key
        ends = ((group.first, group.outer1), (group.second, group.outer2))
        self.locals = [placed.local(body, group.inner) for body, _ in ends]
        self.ridings = [RidingLine.of(placed, slider) for _, slider in ends]
        self.through = [r.through(at) for r, at in zip(self.ridings, self.locals, strict=True)]

    def advance(self, chunk: Chunk) -> None:
        g = self.group
        lines = [through.line(chunk) for through, _ in self.through]
        dyad = prp.solve(*lines, certified=chunk.certified, stretch=chunk.stretch)
        ends = ((g.first, g.outer1, dyad.first), (g.second, g.outer2, dyad.second))
        for i, (body, slider, sliding) in enumerate(ends):
            pin = riding_point(lines[i], sliding)
            chunk.bodies[body] = self.ridings[i].follower(chunk, self.locals[i], pin)
            line, lead = self.through[i]
            chunk.sliders[slider] = line.displacement(sliding, lead)
        chunk.keep(self.key, dyad)


class RPPStep:
    """A body pinned to a known one slides on a body that slides on a known one."""

    def __init__(self, placed: PlacedBodies, group: Group) -> None:
        self.group, self.key = group, group.branch_key
        self.hold, self.local = placed.holder(group.outer1), placed.local(group.first, group.outer1)
        self.outer = RidingLine.of(placed, group.outer2)
        inner = RidingLine.of(replace(placed, known=frozenset({group.second})), group.inner)
        # Everything below is in the frame of the known body, in which both lines keep their angle.
        angles = (*self.outer.angles, *inner.angles)
        self.follow, self.rounding = self.outer.follow + inner.follow, rounding_of_angles(*angles)
        offset = turned(less(inner.base, self.outer.rider), self.outer.follow)
        arm = turned(less(self.local, inner.rider), self.follow)
        base = riding.total(self.outer.base, offset, arm)
        slack = riding.rounding_of(angles, offset, arm, onto=base)
        self.through = replace(self.outer, base=base, slack=slack)
        self.inner = inner
        self.between = direction(self.outer.follow + inner.angle - self.outer.angle)
        self.apart = rounding_of_angles(*self.outer.angles, inner.angle, self.outer.angle)

    def advance(self, chunk: Chunk) -> None:
        g = self.group
        p1 = chunk.point(self.hold, g.outer1)
        line = self.through.line(chunk)
        dyad = rpp.solve(
            p1, line, self.between, self.apart, certified=chunk.certified, stretch=chunk.stretch
        )
        known, outer = chunk.bodies[self.outer.known], self.outer
        rider = riding_point(outer.line(chunk), dyad.first)
        chunk.bodies[g.second] = outer.follower(chunk, outer.rider, rider)
        chunk.bodies[g.first] = riding.following_body(
            known, self.follow, self.rounding, self.local, p1
        )
        chunk.sliders[g.outer2] = self.outer.displacement(dyad.first, 0.0)
        chunk.sliders[g.inner] = self.inner.displacement(dyad.second, 0.0)
        chunk.keep(self.key, dyad)


DYAD_STEPS: dict[str, Callable[[PlacedBodies, Group], Step]] = {
    "RRR": RRRStep,
    "RRP": RRPStep,
    "RPR": RPRStep,
    "PRP": PRPStep,
    "RPP": RPPStep,
}
