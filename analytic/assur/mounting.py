"""How the central link of a group is mounted: its frame, and the legs or joints that hold it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

from analytic.assur.central_frame import CentralFrame
from analytic.assur.driven_leg import DrivenBarLeg
from analytic.assur.legs import (
    BarLeg,
    DoublySlidingLeg,
    GuidedLeg,
    Leg,
    PinnedThere,
    SlidingLeg,
    SlidingThere,
)
from analytic.assur.sampled_rows import SampledRow
from analytic.dyads.chunk import Chunk
from analytic.dyads.plane import BodyKinematics
from analytic.dyads.riding import Placed
from analytic.structure.compound import Compound, as_triad
from analytic.structure.groups import Group, JointKey, Triad
from analytic.structure.groups import Leg as LegOfGroup
from models.errors import StructureError
from models.scene import Point, Scene, span


class Mounting:
    """The central link of a triad, or of a dyad with a compound, and what holds it."""

    def __init__(self, placed: Placed, group: Triad | Group) -> None:
        self.placed, self.group = placed, group
        scene, compound = placed.scene, placed.structure.compound
        own = compound if compound is not None and compound.name in group.bodies else None
        if own is not None and isinstance(group, Triad) and group.central != own.name:
            own = None  # a leg of it is driven
        central, held, joint = as_triad(group, own)
        body = central if own is None else own.base
        self.frame, self.size_m = CentralFrame(scene, body, (0.0, 0.0), own), scene.longest_m
        points = [
            place for leg in self._made(held, joint) for at, place in leg.locals() if at == body
        ]
        middle = _middle(points) if points else next(iter(scene.links[body].points.values()))
        self.frame = replace(self.frame, origin=middle)
        self.size_m = _size(scene, self.frame, points)
        self.legs = self._made(held, joint)

    def _made(self, held: Sequence[LegOfGroup], joint: JointKey | None) -> list[Leg]:
        legs = [self._leg(one) for one in held]
        return legs if joint is None else [*legs, self._joint(joint)]

    def rows(self, chunk: Chunk) -> list[SampledRow]:
        """The three rows of the central link."""
        return [row for leg in self.legs for row in leg.rows(chunk)]

    def place(self, chunk: Chunk, body: BodyKinematics) -> None:
        """Add the central link and all that its legs are."""
        self.frame.place(chunk, body)
        for leg in self.legs:
            leg.place(chunk, body)

    def holder(self, chunk: Chunk, pin: str) -> str:
        """A body that carries a pin, of those that stand."""
        return next(body for body in self.placed.structure.pins[pin] if body in chunk.bodies)

    def _part(self, joint: JointKey) -> str:
        """The body of the central link that has a joint."""
        kind, name = joint
        for body in self.frame.bodies:
            if kind == "R" and body in self.placed.structure.pins[name]:
                return body
            if kind == "P" and body in self.placed.structure.prismatics[name]:
                return body
        raise AssertionError(f"{name} is no joint of {self.frame.bodies}")

    def _leg(self, leg: LegOfGroup) -> Leg:
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

    def _driven(self, leg: LegOfGroup, part: str, compound: Compound) -> Leg:
        """A leg that the driver moves. Raises StructureError where it slides."""
        scene = self.placed.scene
        if leg.kind != "RR":
            raise StructureError(
                f"{scene.name}: the driver is {scene.driver.joint}, in a leg of the class III "
                f"group about {self.frame.body} that slides ({leg.kind}), which has no solution "
                "here; drive another joint, or a leg with pins at both ends"
            )
        own = CentralFrame(scene, compound.base, (0.0, 0.0), compound)
        outer, inner = leg.outer[1], leg.inner[1]
        return DrivenBarLeg(self.frame, self.placed, part, own, outer, inner)

    def _joint(self, joint: JointKey) -> Leg:
        part = self._part(joint)
        if joint[0] == "R":
            return PinnedThere(self.frame, self.placed, part, joint[1])
        return SlidingThere(self.frame, self.placed, part, joint[1], self.size_m)


def _middle(points: list[Point]) -> Point:
    return (
        math.fsum(p[0] for p in points) / len(points),
        math.fsum(p[1] for p in points) / len(points),
    )


def _size(scene: Scene, frame: CentralFrame, points: Sequence[Point]) -> float:
    """A length of the central link, or of the longest where it has none [m]."""
    spans = [span(scene.links[body].points) for body in frame.bodies if body in scene.links]
    spans += [2.0 * math.dist(frame.origin, point) for point in points]
    return max(spans, default=0.0) or scene.longest_m
