"""Structure of a mechanism: mobility, and its driver and Assur groups in solving order.

Mobility by Kutzbach-Gruebler, W = 3 n - 2 p5 - p4, with n moving bodies (links and slider blocks),
p5 pairs of one freedom (pins, prismatic pairs) and p4 pairs of two (none: a point on a line is a
block with a pin and a prismatic pair). Source: I. I. Artobolevskii, Theory of Mechanisms; the
class II groups are those with two links and three pairs.

A link that is pinned at two or more points to bodies that move without it is redundant: it takes
2 k - 3 freedoms from the count, k its pins, and none from the mechanism, if its length fits.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from analytic.structure.compound import Compound, compound_of
from analytic.structure.groups import Bridge, Group, Pairs, Part, Triad, decompose
from analytic.structure.unsolved import unsolved
from models.errors import StructureError
from models.joints import block_name, joined_at, sliding_body
from models.scene import GROUND, Scene


@dataclass(frozen=True)
class Structure:
    """Bodies, pairs, mobility and groups of a scene.

    ``order`` holds the groups and the redundant links, each after what it hangs on. Where the
    driver moves two moving bodies against each other, one of the groups has the two as one link of
    changing shape: the ``compound``.
    """

    bodies: tuple[str, ...]
    pins: Mapping[str, tuple[str, ...]]
    prismatics: Mapping[str, tuple[str, str]]
    order: tuple[Part, ...]
    compound: Compound | None = None

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
        """The links that the mechanism would move the same without."""
        return tuple(part for part in self.order if isinstance(part, Bridge))

    @property
    def count(self) -> int:
        """The mobility by count, W: with redundant links it is less than the real one."""
        return 3 * len(self.bodies) - 2 * self.pairs

    @property
    def mobility(self) -> int:
        """The real mobility, that of the mechanism without what its redundant links add."""
        return self.count + sum(bridge.excess for bridge in self.redundant)

    @property
    def words(self) -> str:
        """The mobility for people, and what the count makes of it where that is something else."""
        if not self.redundant:
            return f"mobility {self.mobility}"
        return f"mobility {self.mobility} ({self.count} by count; redundant: {self.spare})"

    @property
    def pairs(self) -> int:
        """p5: the number of pairs of one freedom; a pin that joins k bodies is k - 1 of them."""
        return sum(len(names) - 1 for names in self.pins.values()) + len(self.prismatics)

    @property
    def spare(self) -> str:
        """The names of the redundant links."""
        return ", ".join(bridge.link for bridge in self.redundant)


def analyse(scene: Scene) -> Structure:
    """Mobility and Assur groups of a scene, in solving order.

    Raises
    ------
    StructureError
        Mobility other than 1; links that hang on nothing, or in pairs on one pin; a group that is
        neither a dyad nor a triad (the message names its links); a driven joint that cannot move; a
        branch for something that has one assembly only.
    """
    blocks = [block_name(s) for s in scene.sliders.values() if s.link is None]
    bodies = (*scene.links, *blocks)
    pins = joined_at(scene)
    prismatics = {s.name: (sliding_body(s), s.on) for s in scene.sliders.values()}
    compound = compound_of(scene)
    if compound is None:
        known = {scene.driver.base, scene.driver.link, GROUND}
        order, left = decompose(bodies, frozenset(known), Pairs(pins, prismatics))
    else:
        units = compound.units(bodies)
        order, left = decompose(units, frozenset({GROUND}), compound.pairs(pins, prismatics))
    structure = Structure(bodies, pins, prismatics, order, compound)
    _check_driver(scene, pins, prismatics)
    if left or structure.mobility != 1:
        raise StructureError(f"{scene.name}: {_fault(structure, left)}")
    _check_held(scene, structure.groups)
    _check_branches(scene, structure)
    return structure


def sides_of(scene: Scene) -> list[str]:
    """The pins whose branch is a side, which a mirror exchanges: those of dyads of three pins.
    Raises StructureError as `analyse`."""
    return [group.branch_key for group in analyse(scene).groups if group.kind == "RRR"]


def _fault(structure: Structure, left: list[str]) -> str:
    """Why this is no mechanism of dyads with one driver: ``left`` could not be placed."""
    mobility = structure.mobility
    if mobility == 1:
        return unsolved(
            structure.compound, structure.pins, structure.prismatics, structure.bodies, left
        )
    n, p5 = len(structure.bodies), structure.pairs
    count = f"mobility W = 3 n - 2 p5 - p4 = 3*{n} - 2*{p5} - 0 = {structure.count}"
    if structure.redundant:
        count += f", but {mobility} where redundant links ({structure.spare}) are not counted"
    cure = "Remove a link or a pin that holds the mechanism rigid."
    if mobility > 1:
        cure = "Pin a loose link, or remove one; bodies are pinned where they name the same point."
    return f"{count}; one driver needs mobility 1. {cure}"


def _check_driver(
    scene: Scene, pins: Mapping[str, tuple[str, ...]], prismatics: Mapping[str, tuple[str, str]]
) -> None:
    """Refuse a driven pair whose bodies another pair joins as well."""
    driver, own = scene.driver, {scene.driver.base, scene.driver.link}
    joined = [name for name, ends in {**pins, **prismatics}.items() if own <= {*ends}]
    others = [name for name in joined if name != (driver.slider or scene.driver_pivot)]
    if others:
        raise StructureError(
            f"{scene.name}: {driver.joint} cannot move: {' and '.join(sorted(own))} are joined at "
            f"{', '.join(others)} too; take one of these joints out, or drive another"
        )


def _check_held(scene: Scene, groups: tuple[Group, ...]) -> None:
    """Refuse two bodies that only one pin holds: the count takes them for held at two."""
    for group in groups:
        if group.kind[0] == group.kind[2] == "R" and group.outer1 == group.outer2:
            raise StructureError(
                f"{scene.name}: {group.first} and {group.second} both hang on pin {group.outer1}, "
                "and turn about it whatever the driver does; pin one of them at another point"
            )


def _check_branches(scene: Scene, structure: Structure) -> None:
    """Refuse a branch that chooses nothing."""
    choices = [group.branch_key for group in structure.groups if group.assemblies == 2]
    choices += [triad.branch_key for triad in structure.triads]
    for key in scene.branch:
        if key not in choices:
            have = f"it has {', '.join(choices)}" if choices else "this scene has none"
            raise StructureError(
                f"{scene.name}: branch.{key} chooses between no two assemblies; {have}"
            )
