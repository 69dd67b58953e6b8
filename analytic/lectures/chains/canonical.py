"""Isomorphism of small graphs by a canonical labelling.

Corners are told apart by their colour and what they are joined to, again and again; where some are
still alike, each of them is tried as the first (individualisation and refinement, B. D. McKay,
Practical graph isomorphism, 1981, without its pruning: the graphs here have a dozen corners). The
labellings that give the least form are one another's by the symmetries of the graph.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

Form = tuple[tuple[int, ...], ...]
Edge = tuple[int, int]


@dataclass(frozen=True)
class Labelled:
    """The canonical ``form`` (colours, then rows of edge kinds) and all labellings that give it:
    where each corner goes. Two graphs are isomorphic where their forms are equal."""

    form: Form
    labellings: tuple[tuple[int, ...], ...]

    @property
    def orbits(self) -> list[tuple[int, ...]]:
        """The corners that symmetries carry into one another, each set by increasing number."""
        first = self.labellings[0]
        corner_at = {place: corner for corner, place in enumerate(first)}
        own = {
            corner: tuple(sorted({corner_at[way[corner]] for way in self.labellings}))
            for corner in corner_at.values()
        }
        return sorted(set(own.values()))

    @property
    def symmetries(self) -> int:
        """How many there are, the one that moves nothing with them."""
        return len(self.labellings)


def canonical(corners: int, edges: Mapping[Edge, int], colours: Sequence[int]) -> Labelled:
    """The canonical labelling of a graph with coloured corners and kinds of edges."""
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
    """The graph as it reads with its corners in an order."""
    rows = (tuple(beside[a].get(b, 0) for b in order[: k + 1]) for k, a in enumerate(order))
    return (tuple(colours[corner] for corner in order), *rows)


def _leaves(beside: list[dict[int, int]], colours: list[int]) -> Iterator[list[int]]:
    """The orders of the corners that are left where all are told apart."""
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
    """Colours that also tell the colours of what each corner is joined to, numbered from 0."""
    while True:
        told = [
            (colours[corner], sorted((kind, colours[other]) for other, kind in own.items()))
            for corner, own in enumerate(beside)
        ]
        rank: list[tuple[int, list[tuple[int, int]]]] = []
        for one in sorted(told):
            if not rank or rank[-1] != one:
                rank.append(one)
        refined = [rank.index(one) for one in told]
        if len(rank) == len(set(colours)):
            return refined
        colours = refined
