"""How the structure of a mechanism changes with the joint that drives it.

The same links and joints fall into other groups where another joint is driven, and the class of the
mechanism is the highest of theirs (I. I. Artobolevskii, Theory of Mechanisms; problem book "Bai tap
co hoc may", chapter on schemes, mobility and Assur groups).
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import dataclass

from analytic.lectures.chains.assur_group import AssurGroup, groups_on
from analytic.structure.groups import Compound, Group, Pairs, Triad, decompose
from analytic.structure.mobility import Structure
from models.scene import GROUND, Scene

MOST_LEFT = 14
"""Links that are searched for groups larger than a triad."""


@dataclass(frozen=True)
class DrivenJoint:
    """A joint that may drive: its ``pin`` or ``slider``, and the two bodies that it moves against
    each other."""

    base: str
    body: str
    pin: str | None
    slider: str | None

    @property
    def words(self) -> str:
        joint = f"pin {self.pin}" if self.slider is None else f"slider {self.slider}"
        return f"{joint} of {self.base} and {self.body}"


@dataclass(frozen=True)
class ClassedGroup:
    """A group in words: its ``kind`` where it has a name, its links, class and order."""

    kind: str
    links: tuple[str, ...]
    class_number: int
    order: int


@dataclass(frozen=True)
class StructureByDriver:
    """The groups in solving order with one joint driven.

    ``left`` are links that fall into none: the joint can not move then, or leaves them loose.
    """

    joint: DrivenJoint
    groups: tuple[ClassedGroup, ...]
    left: tuple[str, ...]
    is_own: bool

    @property
    def class_number(self) -> int | None:
        """The highest class of the groups, 1 where there is none; None where links are left."""
        if self.left:
            return None
        return max((group.class_number for group in self.groups), default=1)


def classed(part: Group | Triad) -> ClassedGroup:
    """A group with its class and order."""
    if isinstance(part, Triad):
        return ClassedGroup(part.kind, part.bodies, 3, 3)
    return ClassedGroup(part.kind, part.bodies, 2, 2)


def by_drivers(scene: Scene, structure: Structure) -> list[StructureByDriver]:
    """The structure for each joint that could drive, in the order of pins and sliders."""
    return [_driven(scene, structure, joint) for joint in _joints(structure)]


def _joints(structure: Structure) -> Iterator[DrivenJoint]:
    """Every pin of two bodies, and every slider; of a pin that more bodies share, every pair."""
    for pin, bodies in structure.pins.items():
        for base, body in itertools.combinations(bodies, 2):
            yield DrivenJoint(base, body, pin, None)
    for name, (body, base) in structure.prismatics.items():
        yield DrivenJoint(base, body, None, name)


def _driven(scene: Scene, structure: Structure, joint: DrivenJoint) -> StructureByDriver:
    """The groups with a joint driven: its two bodies are one link of changing shape."""
    own = Compound(f"{joint.base} + {joint.body}", joint.base, joint.body, joint.pin, joint.slider)
    if GROUND in (joint.base, joint.body):
        units, known = structure.bodies, {GROUND, joint.base, joint.body}
        pairs = Pairs(structure.pins, structure.prismatics)
        ends = _ends(structure, None)
    else:
        units, known = own.units(structure.bodies), {GROUND}
        pairs = own.pairs(structure.pins, structure.prismatics)
        ends = _ends(structure, own)
    order, left = decompose(units, frozenset(known), pairs)
    groups = [classed(part) for part in order if isinstance(part, Group | Triad)]
    groups, left = _with_larger(groups, left, ends, set(units) | known)
    is_own = joint.slider == scene.driver.slider and (
        joint.slider is not None
        or (
            {joint.base, joint.body} == {scene.driver.base, scene.driver.link}
            and joint.pin == scene.driver_pivot
        )
    )
    return StructureByDriver(joint, tuple(groups), tuple(left), is_own)


def _ends(structure: Structure, own: Compound | None) -> list[tuple[str, str]]:
    """The bodies of each joint; a pin of k bodies is k - 1 joints of the first with the others."""
    joints = [(bodies[0], body) for bodies in structure.pins.values() for body in bodies[1:]]
    joints += structure.prismatics.values()
    if own is None:
        return joints
    units = [(own.unit(a), own.unit(b)) for a, b in joints]
    return [(a, b) for a, b in units if a != b]


def _with_larger(
    groups: list[ClassedGroup], left: list[str], ends: list[tuple[str, str]], units: set[str]
) -> tuple[list[ClassedGroup], list[str]]:
    """The groups, with those of higher class that the links left over form."""
    while left and len(left) <= MOST_LEFT:
        placed = units - set(left)
        held = [sum(body in ab and bool(placed & set(ab)) for ab in ends) for body in left]
        found: AssurGroup[str] | None = None
        if max(held) < 2:  # a link that is held twice is rigid, and another one loose
            found = next(groups_on(ends, left, placed), None)
        if found is None:
            break
        groups = [*groups, ClassedGroup("", found.links, found.class_number, found.order)]
        left = [body for body in left if body not in found.links]
    return groups, left
