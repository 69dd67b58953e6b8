"""Dead points: where a driver can not go on, or an output turns back, and which links are in line.

Where the driver stops, the two assemblies of a dyad meet: two links in line (RRR), a rod square to
its slider's line (RRP), or a guide square to the line to its pin (RPR). Where a link that is pinned
to the ground turns back, it could not drive the mechanism there: the dead points of that input.

Source: R. L. Norton, Design of Machinery, section 4.10 (limit positions, toggle).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from analytic.circuits.circuits import Circuits
from analytic.circuits.rotatability import Rotation
from analytic.prepared import prepared
from analytic.structure.mobility import analyse
from models.errors import StructureError
from models.scene import GROUND, Scene

IN_LINE = 1e-5
"""Sine of an angle between links that are in line: a limit is found to a root of rounding."""


@dataclass(frozen=True)
class DeadPoint:
    """A dead point of an ``input`` link: the driver's angle [rad] and what is in line there."""

    input: str
    driver_rad: float
    where: str


def dead_points(circuits: Circuits, rotations: Sequence[Rotation]) -> list[DeadPoint]:
    """Those of the driver, at the ends of the branch that the scene is on, and those of the links
    that are pinned to the ground, at the ends of their swing."""
    scene, (_, arc) = circuits.signed.scene, circuits.own
    found = []
    for end in (arc.low, arc.high):
        if end is not None:
            where = at_limit(scene, end.dyad)
            found.append(DeadPoint(scene.driver.link, end.angle_rad, where))
    limits = {point.driver_rad for point in found}
    for one in rotations:
        grounded = scene.links[one.link].points.keys() & scene.ground.keys()
        if one.against != GROUND or one.word != "swings" or one.link == scene.driver.link:
            continue
        if grounded:
            found += [
                DeadPoint(one.link, at, _in_line(circuits, at))
                for at in (one.low_at_rad, one.high_at_rad)
                if all(abs(math.remainder(at - limit, math.tau)) > IN_LINE for limit in limits)
            ]
    return found


def at_limit(scene: Scene, key: str) -> str:
    """What is in line where two assemblies of a group meet, by the group's branch."""
    structure = analyse(scene)
    for triad in structure.triads:
        if triad.branch_key == key:
            legs = ", ".join(leg.body for leg in triad.legs)
            return f"the lines of {legs} through one point, or parallel"
    group = next(g for g in structure.groups if g.branch_key == key)
    if group.kind == "RRR":
        return f"{group.first} and {group.second} in line"
    if group.kind == "RRP":
        return f"{group.first} square to the line of {group.outer2}"
    if group.kind == "RPR":
        return f"line of {group.inner} square to the line from its pin to the guide's"
    raise StructureError(f"{scene.name}: {group.kind} has no limit position")


def _in_line(circuits: Circuits, theta: float) -> str:
    """Which two links that share a pin are in line: the lines between pins of each to the next."""
    scene = circuits.signed.scene
    chunk = prepared(scene).stretched(np.array([theta]))
    found = []
    for group in analyse(scene).groups:
        for end in (group.outer1, group.outer2):
            before = [link for link in scene.pins.get(end, ()) if link in scene.links]
            for one in before:
                for other in {group.first, group.second} & set(before) - {one}:
                    ends = (scene.driver_pivot if one == scene.driver.link else "", group.inner)
                    if not ends[0] or ends[1] not in scene.links[other].points:
                        continue
                    pin = chunk.point(one, end).p
                    first = chunk.point(one, ends[0]).p - pin
                    second = chunk.point(other, ends[1]).p - pin
                    across = first.x * second.y - first.y * second.x
                    size = np.hypot(first.x, first.y) * np.hypot(second.x, second.y)
                    if np.all(np.abs(across) < IN_LINE * size):
                        found.append(f"{one} and {other} in line")
    return ", ".join(dict.fromkeys(found)) or "no two links from the driver's pin on in line"
