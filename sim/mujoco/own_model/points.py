"""The named points of a linkage: marks of pins that coincide on one link are one point."""

from __future__ import annotations

from collections.abc import Container, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

from models.scene import Point
from sim.mujoco.own_model.component import WORLD
from sim.mujoco.own_model.linkage import Linkage, Mark
from sim.mujoco.own_model.naming import point_of, scene_name

SAME = 1e-9
"""Marks of one link that are nearer than this, over the size of the linkage, are one point."""
ROUNDING = 1e-15
NEAR = 0.02
"""Marks of one link that are nearer, and not the same, may have been meant to be one."""


@dataclass(frozen=True)
class NamedPoint:
    """A point with its marks on the links that carry it, as the links are drawn."""

    name: str
    marks: tuple[Mark, ...]

    @cached_property
    def places(self) -> Mapping[int, complex]:
        """By link; where marks of a link coincide, the place of the first."""
        return {mark.link: mark.place for mark in reversed(self.marks)}


@dataclass(frozen=True)
class Near:
    """Two points of a link that are suspiciously near to one another, by ``distance_m``."""

    link: int
    first: str
    second: str
    distance_m: float


def points(linkage: Linkage, bodies: Container[str]) -> list[NamedPoint]:
    """All points of the linkage, in the order of the file."""
    groups: list[tuple[list[str], list[Mark]]] = []
    tolerance = SAME * size(linkage)
    for names, marks in _ties(linkage):
        same = [group for group in groups if _meet(group[1], marks, tolerance)]
        for group in same:
            groups.remove(group)
        groups.append(
            (
                [name for group in same for name in group[0]] + names,
                [mark for group in same for mark in group[1]] + marks,
            )
        )
    named: list[NamedPoint] = []
    used: set[str] = set()
    for names, marks in groups:
        wished = [point_of(name, bodies) for name in names]
        name = scene_name(min(wished, key=len), "P", used)
        used.add(name)
        named.append(NamedPoint(name, tuple(marks)))
    return named


def nearly(found: Sequence[NamedPoint], linkage: Linkage) -> Iterator[Near]:
    """Points of a link that lie near to each other, as an anchor does that missed its pin."""
    limit = NEAR * size(linkage)
    for index, one in enumerate(found):
        for other in found[index + 1 :]:
            for link in one.places.keys() & other.places.keys():
                distance = abs(one.places[link] - other.places[link])
                if distance < limit:
                    yield Near(link, one.name, other.name, distance)


def size(linkage: Linkage) -> float:
    """The largest extent of the marks of one link [m]; of all of them, where that is nothing."""
    by_link: dict[int, list[complex]] = {}
    for _, marks in _ties(linkage):
        for mark in marks:
            by_link.setdefault(mark.link, []).append(mark.place)
    moving = [_extent(places) for link, places in by_link.items() if link]
    return max(moving, default=0.0) or _extent([p for each in by_link.values() for p in each])


def _extent(places: Sequence[complex]) -> float:
    return max((abs(a - b) for a in places for b in places), default=0.0)


def _ties(linkage: Linkage) -> Iterator[tuple[list[str], list[Mark]]]:
    """The marks of every pin, of every point on a line, and one of each link that carries nothing
    but lines: a link without a point is none."""
    marked: set[int] = {WORLD}
    for pivot in linkage.pivots:
        marked.update(mark.link for mark in pivot.marks)
        yield [pivot.name], list(pivot.marks)
    for guide in linkage.guides:
        if guide.mark is not None:
            marked.add(guide.mark.link)
            yield [guide.name], [guide.mark]
    for guide in linkage.guides:
        if guide.on not in marked:
            marked.add(guide.on)
            yield [guide.name], [Mark(guide.on, guide.through)]


def _meet(first: Sequence[Mark], second: Sequence[Mark], tolerance: float) -> bool:
    return any(
        a.link == b.link and abs(a.place - b.place) <= tolerance for a in first for b in second
    )


def pair(place: complex) -> Point:
    """A place as a point of a scene; a coordinate that is rounding of the other one is 0."""
    least = ROUNDING * abs(place)
    x, y = (part if abs(part) > least else 0.0 for part in (place.real, place.imag))
    return x, y
