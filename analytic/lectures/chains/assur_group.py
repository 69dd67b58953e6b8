"""Assur groups of a graph: the smallest sets of links that hang on what is placed, with no freedom.

::

    class II, order 2       class III, order 3        class IV, order 2

      o---o---o              o---o===o---o              o---o===o
                                  \\ /                      |   |
                                   o                        o===o---o
                                   |
                                   o

The class counts the corners of the largest closed contour of inner joints, the order the joints by
which the group hangs on others (I. I. Artobolevskii, Theory of Mechanisms).
"""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Generic, TypeVar

Name = TypeVar("Name", int, str)
"""What links are called by: numbers in a chain, names in a scene."""


@dataclass(frozen=True)
class AssurGroup(Generic[Name]):
    """A group: its ``links``, and the joints among them and to what is placed."""

    links: tuple[Name, ...]
    inner: tuple[tuple[Name, Name], ...]
    outer: tuple[tuple[Name, Name], ...]

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
        for size in range(4, len(self.links) + 1):
            for some in itertools.combinations(self.links, size):
                held = [pair for pair in self.inner if set(pair) <= set(some)]
                ends = [link for pair in held for link in pair]
                is_ring = len(held) == size and all(ends.count(link) == 2 for link in some)
                # two rings apart have as many joints, of six links or more
                if is_ring and _is_one(some, held):
                    yield size


def _is_one(links: tuple[Name, ...], joints: Sequence[tuple[Name, Name]]) -> bool:
    """Whether joints hold all the links together."""
    reached = {links[0]}
    for _ in links:
        reached |= {b for joint in joints for b in joint if reached & set(joint)}
    return reached == set(links)


def groups_on(
    joints: Sequence[tuple[Name, Name]], links: Iterable[Name], placed: set[Name]
) -> Iterator[AssurGroup[Name]]:
    """The groups of links that hang on what is placed, the smallest first."""
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
