"""From a structural group to its closed-form step: geometry prepared once, solved per chunk."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Protocol

import numpy as np

from analytic.dyads import prp, rpp, rpr, rrp, rrr
from analytic.dyads.chunk import Chunk, Passage
from analytic.dyads.parts import Sliding, Turning
from analytic.dyads.plane import Vec, direction
from analytic.dyads.redundant import BridgeStep
from analytic.dyads.riding import (
    RidingLine,
    following_body,
    known_at,
    riding_point,
    rounding_of,
    total,
    turning_body,
    without_lead,
)
from analytic.structure.groups import Bridge, Group
from analytic.structure.mobility import Structure, sliding_body
from models.array import Array
from models.joints import less, local_point, turned
from models.scene import GROUND, Scene


class Step(Protocol):
    """A prepared group; ``key`` names its dyad in the motion's conditioning."""

    @property
    def key(self) -> str: ...

    def advance(self, chunk: Chunk) -> None:
        """Add the group's bodies and sliders to the chunk. Raises OpenError."""
        ...


def prepare(scene: Scene, structure: Structure) -> list[Step]:
    """The steps of all groups, in solving order."""
    known = {GROUND, scene.driver.link}
    steps: list[Step] = []
    for part in structure.order:
        if isinstance(part, Bridge):
            steps.append(BridgeStep(scene, structure, part, frozenset(known)))
        else:
            steps.append(_STEPS[part.kind](scene, structure, part, frozenset(known)))
        known.update(part.bodies)
    return steps


def stretched(
    scene: Scene,
    steps: Sequence[Step],
    theta: Array,
    passages: Mapping[str, Passage] | None = None,
) -> Chunk:
    """The mechanism at driver angles that may be out of reach, its open dyads stretched in line."""
    zero = np.zeros_like(theta)
    chunk = Chunk.begin(scene, theta, zero, zero, stretch=True, passages=passages)
    with np.errstate(all="ignore"):  # parallel lines cross at infinity
        for step in steps:
            step.advance(chunk)
    return chunk


class RRRStep:
    """Two links between two known pins."""

    def __init__(
        self, scene: Scene, structure: Structure, group: Group, known: frozenset[str]
    ) -> None:
        self.group, self.key = group, group.branch_key
        self.hold1 = known_at(structure, known, group.outer1)
        self.hold2 = known_at(structure, known, group.outer2)
        self.local1 = local_point(scene, group.first, group.outer1)
        self.local2 = local_point(scene, group.second, group.outer2)
        span1 = less(local_point(scene, group.first, group.inner), self.local1)
        span2 = less(local_point(scene, group.second, group.inner), self.local2)
        self.l1, self.l2 = math.hypot(*span1), math.hypot(*span2)
        self.back1 = Vec(span1[0] / self.l1, span1[1] / self.l1)
        self.back2 = Vec(span2[0] / self.l2, span2[1] / self.l2)
        self.branch = scene.branch.get(self.key, 1)

    def advance(self, chunk: Chunk) -> None:
        g = self.group
        p1, p2 = chunk.point(self.hold1, g.outer1), chunk.point(self.hold2, g.outer2)
        branch, stretch = chunk.assembly(self.key, self.branch)
        found = rrr.solve(
            p1, p2, self.l1, self.l2, branch, certified=chunk.certified, stretch=stretch
        )
        dyad = chunk.keep(self.key, found)
        assert isinstance(dyad.first, Turning)
        assert isinstance(dyad.second, Turning)
        chunk.bodies[g.first] = turning_body(dyad.first, self.back1, self.local1, p1)
        chunk.bodies[g.second] = turning_body(dyad.second, self.back2, self.local2, p2)


class RRPStep:
    """A link from a known pin to a body that slides on, or along, a known one."""

    def __init__(
        self, scene: Scene, structure: Structure, group: Group, known: frozenset[str]
    ) -> None:
        self.group, self.key = group, group.branch_key
        self.hold = known_at(structure, known, group.outer1)
        self.local = local_point(scene, group.first, group.outer1)
        self.inner = local_point(scene, group.first, group.inner)
        span = less(self.inner, self.local)
        self.length = math.hypot(*span)
        self.back = Vec(span[0] / self.length, span[1] / self.length)
        self.rider = local_point(scene, group.second, group.inner)
        self.riding = RidingLine.of(scene, group.outer2, known)
        self.through, self.lead = self.riding.through(self.rider)
        self.branch = scene.branch.get(self.key, 1) * self.riding.sign

    def advance(self, chunk: Chunk) -> None:
        g = self.group
        p1, line = chunk.point(self.hold, g.outer1), self.through.line(chunk)
        branch, stretch = chunk.assembly(self.key, self.branch)
        found = rrp.solve(p1, line, self.length, branch, certified=chunk.certified, stretch=stretch)
        dyad = chunk.keep(self.key, found)
        assert isinstance(dyad.first, Turning)
        assert isinstance(dyad.second, Sliding)
        chunk.bodies[g.first] = turning_body(dyad.first, self.back, self.local, p1)
        pin = riding_point(line, dyad.second)
        known = chunk.bodies[self.riding.known]
        chunk.bodies[g.second] = following_body(known, self.riding.follow, self.rider, pin)
        chunk.sliders[g.outer2] = self.through.displacement(dyad.second, self.lead)


class RPRStep:
    """A slider body pinned to a known one, on a guide that turns about another known pin."""

    def __init__(
        self, scene: Scene, structure: Structure, group: Group, known: frozenset[str]
    ) -> None:
        self.key = self.slider = group.inner
        slider = scene.sliders[group.inner]
        self.body, self.guide = sliding_body(slider), slider.on
        self.pin1, self.pin2 = group.outer1, group.outer2
        if group.first == self.guide:
            self.pin1, self.pin2 = self.pin2, self.pin1
        self.hold1 = known_at(structure, known, self.pin1)
        self.hold2 = known_at(structure, known, self.pin2)
        self.local1 = local_point(scene, self.body, self.pin1)
        self.local2 = local_point(scene, self.guide, self.pin2)
        foot = turned(less(slider.through_m, self.local2), -slider.direction_rad)
        tip = local_point(scene, self.body, slider.point)
        reach = turned(less(tip, self.local1), slider.angle_rad)
        self.lead, self.offset = foot[0] - reach[0], foot[1] - reach[1]
        self.slack = rounding_of(abs(slider.direction_rad) + abs(slider.angle_rad), foot, reach)
        self.back1, self.back2 = direction(-slider.angle_rad), direction(slider.direction_rad)
        self.branch = scene.branch.get(self.key, 1)

    def advance(self, chunk: Chunk) -> None:
        p1, p2 = chunk.point(self.hold1, self.pin1), chunk.point(self.hold2, self.pin2)
        block = p1
        if p1.error is not None and self.slack:
            error = replace(p1.error, position=p1.error.position + self.slack)
            block = replace(p1, error=error)
        branch, stretch = chunk.assembly(self.key, self.branch)
        found = rpr.solve(
            block, p2, self.offset, branch, certified=chunk.certified, stretch=stretch
        )
        dyad = chunk.keep(self.key, found)
        assert isinstance(dyad.first, Turning)
        assert isinstance(dyad.second, Sliding)
        chunk.bodies[self.body] = turning_body(dyad.first, self.back1, self.local1, p1)
        chunk.bodies[self.guide] = turning_body(dyad.first, self.back2, self.local2, p2)
        chunk.sliders[self.slider] = without_lead(dyad.second, self.lead, self.slack)


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
            riding, pin = self.ridings[i], riding_point(lines[i], found)
            known = chunk.bodies[riding.known]
            chunk.bodies[body] = following_body(known, riding.follow, self.locals[i], pin)
            line, lead = self.through[i]
            chunk.sliders[slider] = line.displacement(found, lead)
        chunk.keep(self.key, dyad)


class RPPStep:
    """A body pinned to a known one slides on a body that slides on a known one."""

    def __init__(
        self, scene: Scene, structure: Structure, group: Group, known: frozenset[str]
    ) -> None:
        self.group, self.key = group, group.branch_key
        self.hold = known_at(structure, known, group.outer1)
        self.local = local_point(scene, group.first, group.outer1)
        self.outer = RidingLine.of(scene, group.outer2, known)
        inner = RidingLine.of(scene, group.inner, frozenset({group.second}))
        # Everything below is in the frame of the known body, in which both lines keep their angle.
        self.follow = self.outer.follow + inner.follow
        offset = turned(less(inner.base, self.outer.rider), self.outer.follow)
        arm = turned(less(self.local, inner.rider), self.follow)
        base = total(self.outer.base, offset, arm)
        slack = rounding_of(abs(self.outer.follow) + abs(self.follow), offset, arm, onto=base)
        self.through = replace(self.outer, base=base, slack=slack)
        self.inner = inner
        self.between = direction(self.outer.follow + inner.angle - self.outer.angle)

    def advance(self, chunk: Chunk) -> None:
        g = self.group
        p1 = chunk.point(self.hold, g.outer1)
        line = self.through.line(chunk)
        dyad = rpp.solve(p1, line, self.between, certified=chunk.certified, stretch=chunk.stretch)
        assert isinstance(dyad.first, Sliding)
        assert isinstance(dyad.second, Sliding)
        known = chunk.bodies[self.outer.known]
        rider = riding_point(self.outer.line(chunk), dyad.first)
        chunk.bodies[g.second] = following_body(known, self.outer.follow, self.outer.rider, rider)
        chunk.bodies[g.first] = following_body(known, self.follow, self.local, p1)
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
