"""Structure of a mechanism: mobility, and its driver and Assur groups in solving order.

Mobility by Kutzbach-Gruebler, W = 3 n - 2 p5 - p4, with n moving bodies (links and slider blocks),
p5 pairs of one freedom (pins, prismatic pairs) and p4 pairs of two (gears and cams; a point on a
line is a block with a pin and a prismatic pair). Source: I. I. Artobolevskii, Theory of Mechanisms;
the class II groups are those with two links and three pairs.

A link that is pinned at two or more points to bodies that move without it is redundant: it takes
2 k - 3 freedoms from the count, k its pins, and none from the mechanism, if its length fits.
"""

import itertools
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from analytic.structure.groups import (
    Bridge,
    Compound,
    Group,
    JointKey,
    Pairs,
    Part,
    Triad,
    compound_of,
    decompose,
)
from models.errors import CrankcheckError, StructureError, few
from models.scene import GROUND, Scene
from models.scene.joints import block_name, joined_at, sliding_body


@dataclass(frozen=True)
class Structure:
    """Bodies, pairs, mobility and groups of a scene.

    ``order`` holds the groups and the redundant links, each after its supports. Where the driver
    moves two moving bodies against each other, one of the groups has the two as one link of
    changing shape: the ``compound``. ``higher`` pairs, gears and cams, take one freedom each.
    """

    bodies: tuple[str, ...]
    pins: Mapping[str, tuple[str, ...]]
    prismatics: Mapping[str, tuple[str, str]]
    order: tuple[Part, ...]
    compound: Compound | None = None
    higher: int = 0

    @property
    def groups(self) -> tuple[Group, ...]:
        """The class II groups in solving order."""
        return tuple(part for part in self.order if isinstance(part, Group))

    @property
    def triads(self) -> tuple[Triad, ...]:
        """The class III groups in solving order."""
        return tuple(part for part in self.order if isinstance(part, Triad))

    @property
    def redundant(self) -> tuple[Bridge, ...]:
        """Links without which the mechanism would move the same."""
        return tuple(part for part in self.order if isinstance(part, Bridge))

    @property
    def count(self) -> int:
        """Mobility by count, W: with redundant links it is less than the real one."""
        return 3 * len(self.bodies) - 2 * self.pairs - self.higher

    @property
    def mobility(self) -> int:
        """Real mobility, without the constraints of redundant links."""
        return self.count + sum(bridge.excess for bridge in self.redundant)

    @property
    def words(self) -> str:
        """Text of the mobility, with the count where it differs."""
        if not self.redundant:
            return f"mobility {self.mobility}"
        return f"mobility {self.mobility} ({self.count} by count; redundant: {self.spare})"

    @property
    def pairs(self) -> int:
        """Number p5 of pairs of one freedom; a pin that joins k bodies is k - 1 of them."""
        return sum(len(names) - 1 for names in self.pins.values()) + len(self.prismatics)

    @property
    def spare(self) -> str:
        """Names of the redundant links."""
        return ", ".join(bridge.link for bridge in self.redundant)


def analyse(scene: Scene) -> Structure:
    """Return the mobility and Assur groups of a scene, in solving order.

    Raises
    ------
    StructureError
        Mobility other than 1; links without support, or in pairs on one pin; a group that is
        neither a dyad nor a triad (the message names its links); a driven joint that cannot move; a
        branch for a group of one assembly.
    """
    blocks = [block_name(s) for s in scene.sliders.values() if s.link is None]
    bodies = (*scene.links, *blocks)
    pins = joined_at(scene)
    prismatics = {s.name: (sliding_body(s), s.on) for s in scene.sliders.values()}
    compound = compound_of(scene)
    if compound is None:
        known = {scene.driver.base, scene.driver.link, GROUND}
        higher = [*scene.gears.values()], [*scene.cams.values()]
        order, left = decompose(bodies, frozenset(known), Pairs(pins, prismatics), *higher)
    else:
        if scene.gears or scene.cams:
            raise StructureError(
                f"{scene.name}: {scene.driver.joint} drives two moving bodies, which can not be "
                "combined with gears and cams; drive a body against the ground"
            )
        units = compound.units(bodies)
        order, left = decompose(units, frozenset({GROUND}), compound.pairs(pins, prismatics))
    count = len(scene.gears) + len(scene.cams)
    structure = Structure(bodies, pins, prismatics, order, compound, count)
    _check_driver(scene, structure)
    if left or structure.mobility != 1:
        raise StructureError(f"{scene.name}: {_fault(structure, left)}")
    _check_held(scene, structure.groups)
    _check_branches(scene, structure)
    return structure


def sides_of(scene: Scene) -> list[str]:
    """Return the pins whose branch is a side, which a mirror exchanges: those of dyads of three
    pins. Raises StructureError as `analyse`."""
    return [group.branch_key for group in analyse(scene).groups if group.kind == "RRR"]


def _fault(structure: Structure, left: list[str]) -> str:
    """Return the text of the fault, where ``left`` could not be placed."""
    mobility = structure.mobility
    if mobility == 1:
        return unsolved(structure, left)
    n, p5 = len(structure.bodies), structure.pairs
    count = (
        f"mobility W = 3 n - 2 p5 - p4 = 3*{n} - 2*{p5} - {structure.higher} = {structure.count}"
    )
    if structure.redundant:
        count += f", but {mobility} where redundant links ({structure.spare}) are not counted"
    cure = "Remove a link or a pin that holds the mechanism rigid."
    if mobility > 1:
        cure = "Pin a loose link, or remove one; bodies are pinned where they name the same point."
    return f"{count}; one driver needs mobility 1. {cure}"


def _check_driver(scene: Scene, structure: Structure) -> None:
    """Refuse a driven pair whose bodies another pair joins as well."""
    driver, own = scene.driver, {scene.driver.base, scene.driver.link}
    pairs = {**structure.pins, **structure.prismatics}
    joined = [name for name, ends in pairs.items() if own <= {*ends}]
    others = [name for name in joined if name != (driver.slider or scene.driver_pivot)]
    if others:
        raise StructureError(
            f"{scene.name}: {driver.joint} cannot move: {' and '.join(sorted(own))} are joined "
            f"at {', '.join(others)} too; remove one of these joints, or drive another"
        )


def _check_held(scene: Scene, groups: tuple[Group, ...]) -> None:
    """Refuse two bodies that only one pin holds: the count assumes two."""
    for group in groups:
        if group.kind[0] == group.kind[2] == "R" and group.outer1 == group.outer2:
            raise StructureError(
                f"{scene.name}: {group.first} and {group.second} are both pinned at "
                f"{group.outer1} alone, and turn about it whatever the driver does; pin one of "
                "them at another point"
            )


def _check_branches(scene: Scene, structure: Structure) -> None:
    """Refuse a branch without a choice."""
    choices = [group.branch_key for group in structure.groups if group.assemblies == 2]
    choices += [triad.branch_key for triad in structure.triads]
    for key in scene.branch:
        if key not in choices:
            have = f"it has {', '.join(choices)}" if choices else "this scene has none"
            raise StructureError(f"{scene.name}: branch.{key} separates no assemblies; {have}")


def refuse_other_than_cranked(scene: Scene, what: str, structure: Structure | None = None) -> None:
    """Refuse a driver other than a crank at the ground, and a structure with a triad, as ``what``
    does not cover them. Raises CrankcheckError."""
    if not scene.driver.is_crank:
        raise CrankcheckError(
            f"{scene.name}: {what} needs a driver that is a link pinned to the ground, and this "
            f"scene's is {scene.driver.joint}"
        )
    refuse_higher_pairs(scene, what)
    triads = ", ".join(triad.central for triad in structure.triads) if structure else ""
    if triads:
        raise CrankcheckError(
            f"{scene.name}: {what} needs class II groups, and this scene has a group of class "
            f"III about {triads}"
        )


def refuse_elastic(scene: Scene, what: str) -> None:
    """Refuse elastic links, as ``what`` is worked out for rigid ones. Raises CrankcheckError."""
    if scene.elastic:
        raise CrankcheckError(
            f"{scene.name}: {next(iter(scene.elastic))} is elastic; {what} are those of rigid "
            "links: leave [elastic.LINK] out"
        )


def refuse_higher_pairs(scene: Scene, what: str) -> None:
    """Refuse gears and cams, as ``what`` is worked out without them. Raises CrankcheckError."""
    if higher := [*scene.gears, *scene.cams]:
        raise CrankcheckError(
            f"{scene.name}: {what} is not computed with gears or cams ({', '.join(higher)})"
        )


MOST_LOOKS = 200_000
"""Most pairs tested, over all sets of links, to name a group: about 0.2 s for any number of
links."""
SHOWN = 8
"""Number of unplaced links that are named."""
SOLVED = "dyads (RRR, RRP, RPR, PRP, RPP) and triads (class III, order 3) have a solution"


def unsolved(structure: Structure, left: list[str]) -> str:
    """Return the text on the unplaced links in the way, and the reason; two driven ones are one."""
    pins, prismatics, bodies = structure.pins, structure.prismatics, structure.bodies
    compound = structure.compound
    if compound is not None:
        pins, prismatics = compound.joined(pins), compound.sliding(prismatics)
        bodies = compound.units(bodies)
    rest = LeftOver(pins, prismatics, left)
    placed = {GROUND, *bodies} - set(left)
    outer = {body: Pairs(pins, prismatics).outer(body, placed) for body in left}
    for body in left:
        if len(outer[body]) > 1:
            names = ", ".join(name for _, name in outer[body])
            return (
                f"{body} is held by {len(outer[body])} pairs ({names}) to bodies that are placed "
                "before it, so it is rigid and another link is loose: mobility 1 is only a count"
            )
    most = MOST_LOOKS // (len(left) + len(pins) + len(prismatics))
    for group in itertools.islice(rest.sets(), most):
        size = len(group)
        inside, outside = rest.pairs_of(set(group))
        if 3 * size == 2 * (inside + sum(len(outer[body]) for body in group)) and not outside:
            return (
                f"links {few(group, SHOWN)} form an Assur group of {size} links and "
                f"{3 * size // 2} pairs ({rest.kind(group, outer)}), which is not solved here; "
                f"{SOLVED}"
            )
    return (
        f"{few(left, SHOWN)} are not joined to the driver and the ground by dyads; check their pins"
    )


@dataclass(frozen=True)
class LeftOver:
    """Links that could not be placed, and all pairs."""

    pins: Mapping[str, tuple[str, ...]]
    prismatics: Mapping[str, tuple[str, str]]
    left: list[str]

    def parts(self) -> list[list[str]]:
        """Return the links in parts that no unknown pair joins: a group is in one part."""
        unknown = set(self.left)
        part = {body: [body] for body in self.left}
        for names in (*self.pins.values(), *self.prismatics.values()):
            if not unknown.issuperset(names):
                continue
            first = part[names[0]]
            for name in names[1:]:
                other = part[name]
                if other is not first:
                    first.extend(other)
                    part.update(dict.fromkeys(other, first))
        place = {body: k for k, body in enumerate(self.left)}
        return [
            sorted(own, key=place.__getitem__) for own in {id(p): p for p in part.values()}.values()
        ]

    def sets(self) -> Iterator[tuple[str, ...]]:
        """Yield the sets of links that may form a group, the smallest first."""
        parts = self.parts()
        for size in range(4, max(map(len, parts)) + 1, 2):
            for part in parts:
                yield from itertools.combinations(part, size)

    def pairs_of(self, group: set[str]) -> tuple[int, int]:
        """Return the numbers of pairs inside a group, and to other unplaced links."""
        others = set(self.left) - group
        inside = outside = 0
        for names in self.pins.values():
            unknown = [name for name in names if name in group]
            if unknown and set(names) <= group | others:
                inside += len(unknown) - 1
        for a, b in self.prismatics.values():
            inside += {a, b} <= group
            outside += len({a, b} & group) == 1 and len({a, b} & others) == 1
        return inside, outside

    def kind(self, group: tuple[str, ...], outer: Mapping[str, list[JointKey]]) -> str:
        """Return class and order, as far as four links determine them."""
        hanging = [body for body in group if outer[body]]
        if len(group) > 4:
            return f"class III or higher, order {len(hanging)}"
        if len(hanging) == 3:
            return "class III, order 3, two of whose legs slide at both ends"
        return f"class IV, order {len(hanging)}"
