r"""Assur groups: the smallest sets of links of a graph that are fixed by others, without freedom.

::

    class II, order 2       class III, order 3        class IV, order 2

      o---o---o              o---o===o---o              o---o===o
                                  \ /                      |   |
                                   o                        o===o---o
                                   |
                                   o

The class counts the corners of the largest closed contour of inner joints, the order the joints to
other links (I. I. Artobolevskii, Theory of Mechanisms).

The same links and joints fall into other groups where another joint is driven, and the class of the
mechanism is the highest of theirs (I. I. Artobolevskii, Theory of Mechanisms; problem book "Bai tap
co hoc may", chapter on schemes, mobility and Assur groups).

The Assur groups of a mechanism are those of its graph: without the ground and the driven link,
groups on placed links are taken away, the smallest first.
"""

import itertools
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Generic, TypeVar

from analytic.lectures.chains.chain import Chain
from analytic.structure.groups import Compound, Group, Pairs, Triad, decompose
from analytic.structure.mobility import Structure
from models.scene import GROUND, Scene

Name = TypeVar("Name", int, str)
"""Identity of links: numbers in a chain, names in a scene."""


@dataclass(frozen=True)
class AssurGroup(Generic[Name]):
    """Group: its ``links``, and the joints among them and to placed links."""

    links: tuple[Name, ...]
    inner: tuple[tuple[Name, Name], ...]
    outer: tuple[tuple[Name, Name], ...]

    @property
    def order(self) -> int:
        """Number of joints to placed links."""
        return len(self.outer)

    @property
    def class_number(self) -> int:
        """Class 2 for a dyad; else the corners of its largest closed contour: a link with so many
        inner joints, or a ring of links without a shorter way across (I. I. Artobolevskii)."""
        if len(self.links) == 2:
            return 2
        ends = [link for joint in self.inner for link in joint]
        own = max(ends.count(link) for link in self.links)
        return max(3, own, *self._rings())

    def _rings(self) -> Iterator[int]:
        """Yield the sizes of the closed rings of links; 0 where there is none."""
        yield 0
        for size in range(4, len(self.links) + 1):
            for some in itertools.combinations(self.links, size):
                held = [pair for pair in self.inner if set(pair) <= set(some)]
                ends = [link for pair in held for link in pair]
                is_ring = len(held) == size and all(ends.count(link) == 2 for link in some)
                # Two separate rings have as many joints, of six links or more.
                if is_ring and _is_one(some, held):
                    yield size


def _is_one(links: tuple[Name, ...], joints: Sequence[tuple[Name, Name]]) -> bool:
    """True if joints connect all the links."""
    reached = {links[0]}
    for _ in links:
        reached |= {b for joint in joints for b in joint if reached & set(joint)}
    return reached == set(links)


def groups_on(
    joints: Sequence[tuple[Name, Name]], links: Iterable[Name], placed: set[Name]
) -> Iterator[AssurGroup[Name]]:
    """Yield the groups of links on the placed ones, the smallest first."""
    left = [link for link in links if link not in placed]
    for size in range(2, len(left) + 1, 2):
        for some in itertools.combinations(left, size):
            own = set(some)
            inner = tuple(joint for joint in joints if own.issuperset(joint))
            outer = tuple(
                joint
                for joint in joints
                if len(own.intersection(joint)) == 1 and placed.intersection(joint)
            )
            if 3 * size == 2 * (len(inner) + len(outer)) and _is_one(some, inner):
                yield AssurGroup(some, inner, outer)


MOST_LEFT = 14
"""Most links that are searched for groups larger than a triad."""


@dataclass(frozen=True)
class DrivenChainJoint:
    """Joint that may drive: its ``pin`` or ``slider``, and the two bodies that it moves."""

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
    """Group in words: its ``kind`` where it has a name, its links, class and order."""

    kind: str
    links: tuple[str, ...]
    class_number: int
    order: int


@dataclass(frozen=True)
class StructureByDriver:
    """Groups in solving order with one joint driven. ``left`` are links in no group: the joint can
    not move then, or leaves them loose."""

    joint: DrivenChainJoint
    groups: tuple[ClassedGroup, ...]
    left: tuple[str, ...]
    is_own: bool

    @property
    def class_number(self) -> int | None:
        """Highest class of the groups, 1 where there is none; None where links are left."""
        if self.left:
            return None
        return max((group.class_number for group in self.groups), default=1)


def classed(part: Group | Triad) -> ClassedGroup:
    """Return a group with its class and order."""
    number = 3 if isinstance(part, Triad) else 2
    return ClassedGroup(part.kind, part.bodies, number, number)


def by_drivers(scene: Scene, structure: Structure) -> list[StructureByDriver]:
    """Return the structure for each joint that could drive, in the order of pins and sliders."""
    return [_driven(scene, structure, joint) for joint in _joints(structure)]


def _joints(structure: Structure) -> Iterator[DrivenChainJoint]:
    """Yield every pin of two bodies, every pair of a pin of more bodies, and every slider."""
    for pin, bodies in structure.pins.items():
        for base, body in itertools.combinations(bodies, 2):
            yield DrivenChainJoint(base, body, pin, None)
    for name, (body, base) in structure.prismatics.items():
        yield DrivenChainJoint(base, body, None, name)


def _driven(scene: Scene, structure: Structure, joint: DrivenChainJoint) -> StructureByDriver:
    """Return the groups with a joint driven: its two bodies are one link of changing shape."""
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
    driver = scene.driver
    is_own = joint.slider == driver.slider
    if joint.slider is None:
        is_own &= {joint.base, joint.body} == {driver.base, driver.link}
        is_own &= joint.pin == scene.driver_pivot
    return StructureByDriver(joint, tuple(groups), tuple(left), is_own)


def _ends(structure: Structure, own: Compound | None) -> list[tuple[str, str]]:
    """Return the bodies of joints; a pin of k bodies is k - 1 joints of the first with others."""
    joints = [(bodies[0], body) for bodies in structure.pins.values() for body in bodies[1:]]
    joints += structure.prismatics.values()
    if own is None:
        return joints
    units = [(own.unit(a), own.unit(b)) for a, b in joints]
    return [(a, b) for a, b in units if a != b]


def _with_larger(
    groups: list[ClassedGroup], left: list[str], ends: list[tuple[str, str]], units: set[str]
) -> tuple[list[ClassedGroup], list[str]]:
    """Return the groups, with those of higher class that the remaining links form."""
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


ROMAN = ("", "I", "II", "III", "IV", "V", "VI", "VII", "VIII", "IX", "X")


@dataclass(frozen=True)
class Mechanism:
    """Chain with its ``ground``; ``name`` is that of the inversion."""

    chain: Chain
    ground: int
    name: str

    def drivers(self) -> list[int]:
        """Return the links at the ground that may drive, one of each set of alike ones."""
        marked = self.chain.labelled(self.ground)
        alike = {link: own[0] for own in marked.orbits for link in own}
        return sorted({alike[link] for link in self.chain.neighbours[self.ground]})

    def classes(self) -> dict[int, int]:
        """Return the class of the mechanism for each driving link at the ground; of mobility 1."""
        orders = {link: assur_groups(self.chain, self.ground, link) for link in self.drivers()}
        return {link: max(one.class_number for one in order) for link, order in orders.items()}


def inversions(chain: Chain, name: str) -> list[Mechanism]:
    """Return the distinct mechanisms of a chain: a ground link from each set of alike ones."""
    grounds = sorted(
        (own[0] for own in chain.labelled().orbits), key=lambda link: _rank(chain, link)
    )
    if len(grounds) == 1:
        return [Mechanism(chain, grounds[0], name)]
    return [Mechanism(chain, ground, f"{name} {_number(k)}") for k, ground in enumerate(grounds, 1)]


def _number(k: int) -> str:
    return ROMAN[k] if k < len(ROMAN) else f"{k}"


def _rank(chain: Chain, link: int) -> tuple[object, ...]:
    """Rank binary links first, those between larger links before others: so Stephenson's are I to
    III as in the literature, with the ternary link at the ground in III, and Watt's in II."""
    beside = sorted((chain.degrees[other] for other in chain.neighbours[link]), reverse=True)
    return chain.degrees[link], [-degree for degree in beside], link


def assur_groups(chain: Chain, ground: int, driver: int) -> list[AssurGroup[int]]:
    """Return the groups in solving order, with ``driver`` moved against the ground, of mobility 1:
    without a rigid part, the remaining links then always fall into groups."""
    placed = {ground, driver}
    order: list[AssurGroup[int]] = []
    while len(placed) < chain.links:
        group = next(groups_on(chain.joints, range(chain.links), placed))
        order.append(group)
        placed.update(group.links)
    return order
