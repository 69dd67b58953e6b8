"""Inversions: the mechanisms that a chain gives, one link after another being the ground.

The Assur groups of a mechanism are those of its graph: without the ground and the driven link,
groups that hang on what is placed are taken away, the smallest first.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import dataclass

from analytic.chains.chain import Chain, Joint

ROMAN = ("", "I", "II", "III", "IV", "V", "VI", "VII", "VIII", "IX", "X")


@dataclass(frozen=True)
class AssurGroup:
    """A group: its ``links``, and the joints among them and to what is placed."""

    links: tuple[int, ...]
    inner: tuple[Joint, ...]
    outer: tuple[Joint, ...]

    @property
    def order(self) -> int:
        """The joints by which it hangs on what is placed."""
        return len(self.outer)

    @property
    def class_number(self) -> int:
        """2 of a dyad; else the corners of its largest closed contour: a link with so many inner
        joints, or a ring of links without a shorter way across (I. I. Artobolevskii)."""
        if len(self.links) == 2:
            return 2
        ends = [link for joint in self.inner for link in joint]
        own = max(ends.count(link) for link in self.links)
        return max(3, own, *self._rings())

    def _rings(self) -> Iterator[int]:
        """The sizes of the closed rings of links; 0 where there is none."""
        yield 0
        inner = set(self.inner)
        for size in range(4, len(self.links) + 1):
            for some in itertools.combinations(self.links, size):
                held = [pair for pair in itertools.combinations(sorted(some), 2) if pair in inner]
                ends = [link for pair in held for link in pair]
                is_ring = len(held) == size and all(ends.count(link) == 2 for link in some)
                # two rings apart have as many joints, of six links or more
                if is_ring and _is_one(some, held):
                    yield size


def _is_one(links: tuple[int, ...], joints: list[Joint]) -> bool:
    """Whether joints hold all the links together."""
    reached = {links[0]}
    for _ in links:
        reached |= {b for joint in joints for b in joint if reached & set(joint)}
    return reached == set(links)


@dataclass(frozen=True)
class Mechanism:
    """A chain with its ``ground``; ``name`` is that of the inversion."""

    chain: Chain
    ground: int
    name: str

    def drivers(self) -> list[int]:
        """The links at the ground that may drive, of alike ones one."""
        marked = self.chain.labelled(self.ground)
        alike = {link: own[0] for own in marked.orbits for link in own}
        return sorted({alike[link] for link in self.chain.neighbours[self.ground]})

    def classes(self) -> dict[int, int]:
        """The class of the mechanism for each driving link at the ground; of mobility 1."""
        return {link: mechanism_class(self.chain, self.ground, link) for link in self.drivers()}


def inversions(chain: Chain, name: str) -> list[Mechanism]:
    """The distinct mechanisms of a chain: a ground link from each set of alike ones."""
    grounds = sorted(
        (own[0] for own in chain.labelled().orbits), key=lambda link: _rank(chain, link)
    )
    if len(grounds) == 1:
        return [Mechanism(chain, grounds[0], name)]
    return [
        Mechanism(chain, ground, f"{name} {_number(k)}") for k, ground in enumerate(grounds, 1)
    ]


def _number(k: int) -> str:
    return ROMAN[k] if k < len(ROMAN) else f"{k}"


def _rank(chain: Chain, link: int) -> tuple[object, ...]:
    """Binary links first, those between larger links before others: so Stephenson's are I to III
    as the field has them, with the ternary link at the ground in III, and Watt's in II."""
    beside = sorted((chain.degrees[other] for other in chain.neighbours[link]), reverse=True)
    return chain.degrees[link], [-degree for degree in beside], link


def assur_groups(chain: Chain, ground: int, driver: int) -> list[AssurGroup]:
    """The groups in solving order, with ``driver`` moved against the ground, of mobility 1: with no
    rigid part, what is left then always falls into groups."""
    placed, order = {ground, driver}, []
    while len(placed) < chain.links:
        group = next(_groups_on(chain, placed))
        order.append(group)
        placed.update(group.links)
    return order


def _groups_on(chain: Chain, placed: set[int]) -> Iterator[AssurGroup]:
    """The groups that hang on what is placed, the smallest first."""
    left = [link for link in range(chain.links) if link not in placed]
    for size in range(2, len(left) + 1, 2):
        for some in itertools.combinations(left, size):
            own = set(some)
            inner = tuple(joint for joint in chain.joints if own.issuperset(joint))
            outer = tuple(
                joint
                for joint in chain.joints
                if len(own.intersection(joint)) == 1 and placed.intersection(joint)
            )
            if 3 * size == 2 * (len(inner) + len(outer)):
                yield AssurGroup(some, inner, outer)


def mechanism_class(chain: Chain, ground: int, driver: int) -> int:
    """The highest class of its groups."""
    return max(group.class_number for group in assur_groups(chain, ground, driver))
