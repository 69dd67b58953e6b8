r"""Kinematic chain: links, and the joints of one freedom that hold two of them each.

::

    four links, four joints          as a graph: links are corners, joints are edges

         o=======o                        1 --- 2
        /         \                       |     |
       o===========o                      0 --- 3

Corners are distinguished by their colour and their neighbours, again and again; where some are
still alike, each of them is tried as the first (individualisation and refinement, B. D. McKay,
Practical graph isomorphism, 1981, without its pruning: the graphs here have a dozen corners).
Symmetries of the graph relate the labellings that give the least form.
"""

from __future__ import annotations

import itertools
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

Form = tuple[tuple[int, ...], ...]
Edge = tuple[int, int]


@dataclass(frozen=True)
class Labelled:
    """Canonical ``form`` (colours, then rows of edge kinds) and all labellings that give it: the
    new place of each corner. Two graphs are isomorphic where their forms are equal."""

    form: Form
    labellings: tuple[tuple[int, ...], ...]

    @property
    def orbits(self) -> list[tuple[int, ...]]:
        """Corners that symmetries carry into one another, each set by increasing number."""
        first = self.labellings[0]
        corner_at = {place: corner for corner, place in enumerate(first)}
        own = {
            corner: tuple(sorted({corner_at[way[corner]] for way in self.labellings}))
            for corner in corner_at.values()
        }
        return sorted(set(own.values()))


def canonical(corners: int, edges: Mapping[Edge, int], colours: Sequence[int]) -> Labelled:
    """Return the canonical labelling of a graph with coloured corners and kinds of edges."""
    beside: list[dict[int, int]] = [{} for _ in range(corners)]
    for (a, b), kind in edges.items():
        beside[a][b] = beside[b][a] = kind
    best: Form | None = None
    ways: list[tuple[int, ...]] = []
    for order in _leaves(beside, list(colours)):
        form = _form(beside, colours, order)
        if best is None or form < best:
            best, ways = form, []
        if form == best:
            place = {corner: k for k, corner in enumerate(order)}
            ways.append(tuple(place[corner] for corner in range(corners)))
    return Labelled(best or (), tuple(ways))


def _form(beside: list[dict[int, int]], colours: Sequence[int], order: list[int]) -> Form:
    """Return the form of the graph with its corners in an order."""
    rows = (tuple(beside[a].get(b, 0) for b in order[: k + 1]) for k, a in enumerate(order))
    return (tuple(colours[corner] for corner in order), *rows)


def _leaves(beside: list[dict[int, int]], colours: list[int]) -> Iterator[list[int]]:
    """Yield the orders of the corners that remain where all are distinguished."""
    refined = _refined(beside, colours)
    alike: dict[int, list[int]] = {}
    for corner, colour in enumerate(refined):
        alike.setdefault(colour, []).append(corner)
    many = [colour for colour, own in alike.items() if len(own) > 1]
    if not many:
        yield sorted(range(len(refined)), key=refined.__getitem__)
        return
    for corner in alike[min(many)]:
        first = [2 * colour for colour in refined]
        first[corner] -= 1
        yield from _leaves(beside, first)


def _refined(beside: list[dict[int, int]], colours: list[int]) -> list[int]:
    """Refine colours by those of each corner's neighbours, numbered from 0."""
    while True:
        told = [
            (colours[corner], sorted((kind, colours[other]) for other, kind in own.items()))
            for corner, own in enumerate(beside)
        ]
        rank = [one for one, _ in itertools.groupby(sorted(told))]
        refined = [rank.index(one) for one in told]
        if len(rank) == len(set(colours)):
            return refined
        colours = refined


Joint = tuple[int, int]
"""Two links of a joint, the lower number first."""
NAMES_OF_LINKS = {2: "binary", 3: "ternary", 4: "quaternary", 5: "quinary", 6: "senary"}


@dataclass(frozen=True)
class Chain:
    """Links, ``links`` in number from 0 on, and their simple ``joints``, two links in each.
    ``sliders`` holds the joints that are prismatic; the others are pins."""

    links: int
    joints: tuple[Joint, ...]
    sliders: frozenset[Joint] = frozenset()

    @staticmethod
    def of(links: int, joints: Iterable[Joint], sliders: Iterable[Joint] = ()) -> Chain:
        """Make the chain of these joints, in order."""
        return Chain(links, tuple(sorted(map(_sorted, joints))), frozenset(map(_sorted, sliders)))

    @property
    def mobility(self) -> int:
        """Mobility W = 3 (n - 1) - 2 p of its links against one of them."""
        return mobility_by_count(self.links, len(self.joints))

    @property
    def loops(self) -> int:
        """Number of independent loops."""
        return len(self.joints) - self.links + 1

    @cached_property
    def degrees(self) -> tuple[int, ...]:
        """Number of joints of each link."""
        count = Counter(link for joint in self.joints for link in joint)
        return tuple(count[link] for link in range(self.links))

    @property
    def assortment(self) -> tuple[int, ...]:
        """Numbers of binary, ternary, ... links."""
        count = Counter(self.degrees)
        return tuple(count[k] for k in range(2, max(count, default=2) + 1))

    @cached_property
    def neighbours(self) -> tuple[frozenset[int], ...]:
        """Links that share a joint with each."""
        beside: list[set[int]] = [set() for _ in range(self.links)]
        for a, b in self.joints:
            beside[a].add(b)
            beside[b].add(a)
        return tuple(map(frozenset, beside))

    def joints_of(self, link: int) -> list[Joint]:
        """Return the joints of a link."""
        return [joint for joint in self.joints if link in joint]

    def labelled(self, ground: int | None = None) -> Labelled:
        """Return the canonical labelling, with a link marked as the ground or with none."""
        marks = [int(link == ground) for link in range(self.links)]
        kinds = {joint: 2 if joint in self.sliders else 1 for joint in self.joints}
        return canonical(self.links, kinds, marks)

    def relabelled(self) -> Chain:
        """Return the chain with its links in canonical order: isomorphic chains become equal."""
        place = self.labelled().labellings[0]
        moved = ([(place[a], place[b]) for a, b in own] for own in (self.joints, self.sliders))
        return Chain.of(self.links, *moved)


def mobility_by_count(links: int, joints: int) -> int:
    """Return W = 3 (n - 1) - 2 p of a planar chain against a link (Kutzbach and Gruebler)."""
    return 3 * (links - 1) - 2 * joints


def joints_for(links: int, mobility: int) -> int | None:
    """Return the number of joints of one freedom for a mobility; None where none is whole."""
    twice = 3 * (links - 1) - mobility
    return twice // 2 if twice >= 0 and twice % 2 == 0 else None


def assortments(links: int, mobility: int) -> list[tuple[int, ...]]:
    """Return the possible numbers of binary, ternary, ... links: all that the counts allow.

    They are the solutions of sum n_k = n and sum k n_k = 2 p in whole numbers, with no link of
    more joints than loops and one (J. Uicker, G. Pennock, J. Shigley, Theory of Machines and
    Mechanisms, chapter 1).
    """
    joints = joints_for(links, mobility)
    if joints is None or joints < links:
        return []
    most = joints - links + 2
    return sorted(_split(links, 2 * joints, most), key=lambda one: (len(one), one[::-1]))


def _split(links: int, ends: int, most: int) -> list[tuple[int, ...]]:
    """Return counts of links with 2 to ``most`` joints that have so many ``ends`` of joints."""
    if most == 2:
        return [(links,)] if 2 * links == ends else []
    ways: list[tuple[int, ...]] = []
    for count in range(min(links, (ends - 2 * links) // (most - 2)) + 1):
        ways += (
            (*rest, *[0] * (most - 2 - len(rest)), count) if count else rest
            for rest in _split(links - count, ends - most * count, most - 1)
        )
    return ways


def assortment_in_words(counts: tuple[int, ...]) -> str:
    """Return the counts in words: 4 binary, 2 ternary."""
    names = [NAMES_OF_LINKS.get(k, f"{k}-joint") for k in range(2, len(counts) + 2)]
    return ", ".join(f"{count} {name}" for count, name in zip(counts, names, strict=True) if count)


def has_rigid_part(chain: Chain) -> bool:
    """True if some of its links, but not all, have by count no freedom among themselves."""
    mask = [sum(1 << other for other in beside) for beside in chain.neighbours]
    inside = [0] * (1 << chain.links)  # joints among the links of each set
    for part in range(1, (1 << chain.links) - 1):
        low = (part & -part).bit_length() - 1
        rest = part & (part - 1)
        inside[part] = inside[rest] + (mask[low] & rest).bit_count()
        if part.bit_count() > 1 and mobility_by_count(part.bit_count(), inside[part]) <= 0:
            return True
    return False


def _sorted(joint: Joint) -> Joint:
    return (joint[0], joint[1]) if joint[0] < joint[1] else (joint[1], joint[0])
