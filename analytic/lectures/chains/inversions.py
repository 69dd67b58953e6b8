"""Inversions: the mechanisms that a chain gives, one link after another being the ground.

The Assur groups of a mechanism are those of its graph: without the ground and the driven link,
groups that hang on what is placed are taken away, the smallest first.
"""

from __future__ import annotations

from dataclasses import dataclass

from analytic.lectures.chains.assur_group import AssurGroup, groups_on
from analytic.lectures.chains.chain import Chain

ROMAN = ("", "I", "II", "III", "IV", "V", "VI", "VII", "VIII", "IX", "X")


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
    return [Mechanism(chain, ground, f"{name} {_number(k)}") for k, ground in enumerate(grounds, 1)]


def _number(k: int) -> str:
    return ROMAN[k] if k < len(ROMAN) else f"{k}"


def _rank(chain: Chain, link: int) -> tuple[object, ...]:
    """Binary links first, those between larger links before others: so Stephenson's are I to III
    as the field has them, with the ternary link at the ground in III, and Watt's in II."""
    beside = sorted((chain.degrees[other] for other in chain.neighbours[link]), reverse=True)
    return chain.degrees[link], [-degree for degree in beside], link


def assur_groups(chain: Chain, ground: int, driver: int) -> list[AssurGroup[int]]:
    """The groups in solving order, with ``driver`` moved against the ground, of mobility 1: with no
    rigid part, what is left then always falls into groups."""
    placed = {ground, driver}
    order: list[AssurGroup[int]] = []
    while len(placed) < chain.links:
        group = next(groups_on(chain.joints, range(chain.links), placed))
        order.append(group)
        placed.update(group.links)
    return order


def mechanism_class(chain: Chain, ground: int, driver: int) -> int:
    """The highest class of its groups."""
    return max(group.class_number for group in assur_groups(chain, ground, driver))
