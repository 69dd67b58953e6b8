"""Which links of a mechanism form a group that is not solved, or none, in words."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from analytic.structure.compound import Compound
from analytic.structure.groups import JointKey, Pairs
from models.errors import few
from models.scene import GROUND

MOST_LOOKS = 200_000
"""Pairs that are looked at, over all sets of links, to name a group: about 0.2 s, however many
links there are."""
SHOWN = 8
"""Links that are named of those left over."""
SOLVED = "dyads (RRR, RRP, RPR, PRP, RPP) and triads (class III, order 3) have a solution"


def unsolved(
    compound: Compound | None,
    pins: Mapping[str, tuple[str, ...]],
    prismatics: Mapping[str, tuple[str, str]],
    bodies: tuple[str, ...],
    left: list[str],
) -> str:
    """Which of the links left over are in the way, and why; two that the driver moves are one."""
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
    return f"{few(left, SHOWN)} do not hang on the driver and the ground by dyads; check their pins"


@dataclass(frozen=True)
class LeftOver:
    """The links that could not be placed, and all pairs."""

    pins: Mapping[str, tuple[str, ...]]
    prismatics: Mapping[str, tuple[str, str]]
    left: list[str]

    def parts(self) -> list[list[str]]:
        """Apart where no pair without a known body joins them: a group is in one of these."""
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
        """The sets of links that may form a group, the smallest first."""
        parts = self.parts()
        for size in range(4, max(map(len, parts)) + 1, 2):
            for part in parts:
                yield from itertools.combinations(part, size)

    def pairs_of(self, group: set[str]) -> tuple[int, int]:
        """The pairs between members of a group, and whether it hangs on others that are left."""
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
        """Class and order, as far as four links tell them."""
        hanging = [body for body in group if outer[body]]
        if len(group) > 4:
            return f"class III or higher, order {len(hanging)}"
        if len(hanging) == 3:
            return "class III, order 3, two of whose legs slide at both ends"
        return f"class IV, order {len(hanging)}"
