"""Links of a planar linkage and its pairs, from rigid bodies, joints and closures.

Everything lies in one plane, as the model is drawn: so do the points of bodies. Welded bodies are
one link, in the pose of the weld::

    rocker --hinge-- half of the coupler ==weld== other half --hinge-- crank

Pairs of a body against its parent: a hinge is a pin, a slide a prismatic pair, slide and hinge a
point of the body on a line of the parent, hinge and slide a line of the body over a point of the
parent; two slides and a hinge are no pair at all.
"""

from __future__ import annotations

import cmath
from collections.abc import Container, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

from models.scene import Point
from sim.mujoco.own_model.component import PARALLEL_DEG, Component, RigidBody
from sim.mujoco.own_model.driven_loop import WORLD
from sim.mujoco.own_model.file import ModelClosure, ModelError, body_name, point_of, scene_name

PAIRS = {
    "hinge": "pin",
    "slide": "prism",
    "slide hinge": "point on line",
    "hinge slide": "line over point",
    "slide slide hinge": "none",
    "hinge slide slide": "none",
    "slide hinge slide": "none",
}


@dataclass(frozen=True)
class Placement:
    """Placement of a drawn rigid body in its link: z becomes turn z + shift."""

    turn: complex = 1.0 + 0.0j
    shift: complex = 0.0j

    def __call__(self, place: complex) -> complex:
        return self.turn * place + self.shift

    @property
    def inverse(self) -> Placement:
        """Inverse placement."""
        return Placement(1.0 / self.turn, -self.shift / self.turn)

    def after(self, first: Placement) -> Placement:
        """Return this placement after ``first``."""
        return Placement(self.turn * first.turn, self(first.shift))


@dataclass(frozen=True)
class ModelMark:
    """A place on a link, as the link is drawn."""

    link: int
    place: complex


@dataclass(frozen=True)
class Pivot:
    """A pin between two links: each has its own copy."""

    name: str
    marks: tuple[ModelMark, ModelMark]


@dataclass(frozen=True)
class ModelGuide:
    """Slide of ``rider`` along ``direction`` of link ``on``: of the whole link, or of its one point
    ``mark``, through ``through`` on the link ``on``. For a whole link ``meets`` maps its places to
    the link ``on``, in the pair as drawn."""

    name: str
    on: int
    rider: int
    direction: complex
    through: complex
    mark: ModelMark | None = None
    meets: Placement = Placement()


@dataclass(frozen=True, eq=False)
class Linkage:
    """Links by the id of their first rigid body, 0 the ground; ``placements`` by rigid body."""

    component: Component
    placements: Mapping[int, tuple[int, Placement]]
    pivots: tuple[Pivot, ...]
    guides: tuple[ModelGuide, ...]

    @property
    def links(self) -> tuple[int, ...]:
        """Moving links, in the order of the file."""
        return tuple(sorted({link for link, _ in self.placements.values()} - {WORLD}))

    def mark(self, body: int, place: complex) -> ModelMark:
        """Return a place that is drawn on a rigid body, on its link."""
        link, placement = self.placements[body]
        return ModelMark(link, placement(place))


def linkage(component: Component) -> Linkage:
    """Make the linkage of a component.

    Raises
    ------
    ModelError
        Two joints on a body that are no pair of a linkage; a weld that tilts bodies out of the
        plane.
    """
    bare = Linkage(component, _welded(component), (), ())
    pairs = [pair for body in component.bodies for pair in _pairs(bare, body)]
    pivots = [pair for pair in pairs if isinstance(pair, Pivot)]
    guides = [pair for pair in pairs if isinstance(pair, ModelGuide)]
    for each in component.closures:
        if each.kind == "connect":
            ends = [
                bare.mark(component.rigid(body), component.plane.flat(anchor))
                for body, anchor in zip(each.bodies, each.anchors, strict=True)
            ]
            pivots.append(Pivot(each.name, (ends[0], ends[1])))
    return Linkage(component, bare.placements, tuple(pivots), tuple(guides))


def _welded(component: Component) -> dict[int, tuple[int, Placement]]:
    """Return link and placement of every rigid body, along the welds from the first of each."""
    welds = [each for each in component.closures if each.kind == "weld"]
    placed: dict[int, tuple[int, Placement]] = {}
    for start in (WORLD, *(body.id for body in component.bodies)):
        waiting = [(start, Placement())] if start not in placed else []
        while waiting:
            body, placement = waiting.pop()
            if body in placed:
                continue
            placed[body] = (start, placement)
            for weld in welds:
                ends = [component.rigid(end) for end in weld.bodies]
                if body in ends and ends[0] != ends[1]:
                    second = _placement(component, weld)
                    if body == ends[1]:
                        second = second.inverse
                    waiting.append(
                        (ends[1] if body == ends[0] else ends[0], placement.after(second))
                    )
    return placed


def _placement(component: Component, weld: ModelClosure) -> Placement:
    """Return the placement of a weld's second body when it holds, from its drawn pose."""
    drawn = component.data.xmat[weld.bodies[1]].reshape(3, 3)
    turn, tilt_deg = component.plane.turned(weld.rotation @ drawn.T)
    if tilt_deg > PARALLEL_DEG:
        names = " and ".join(body_name(component.model, body) for body in weld.bodies)
        raise ModelError(f"weld {weld.name}: it tilts {names} {tilt_deg:.3g} deg out of the plane")
    first, second = (component.plane.flat(anchor) for anchor in weld.anchors)
    unit = cmath.exp(1j * turn)
    return Placement(unit, first - unit * second)


def _pairs(bare: Linkage, body: RigidBody) -> Iterator[Pivot | ModelGuide]:
    kinds = " ".join(joint.kind for joint in body.joints)
    kind = PAIRS.get(kinds)
    if kind is None:
        raise ModelError(
            f"body {body.name}: its joints are {kinds}; a linkage has a hinge, a slide, or one of "
            "each; give what lies between two joints a body of its own"
        )
    if kind == "none":
        return
    joints = {joint.kind: joint for joint in body.joints}
    if kind == "pin":
        hinge = joints["hinge"]
        marks = bare.mark(body.parent, hinge.anchor), bare.mark(body.id, hinge.anchor)
        yield Pivot(hinge.name, marks)
    elif kind == "prism":
        slide, (link, placement) = joints["slide"], bare.placements[body.parent]
        own, drawn = bare.placements[body.id]
        direction, through = placement.turn * slide.direction, placement(slide.anchor)
        meets = placement.after(drawn.inverse)
        yield ModelGuide(slide.name, link, own, direction, through, meets=meets)
    else:
        hinge, slide = joints["hinge"], joints["slide"]
        upper, lower = (body.parent, body.id) if kind == "point on line" else (body.id, body.parent)
        link, placement = bare.placements[upper]
        mark = bare.mark(lower, hinge.anchor)
        direction = placement.turn * slide.direction * (1 if upper == body.parent else -1)
        yield ModelGuide(hinge.name, link, mark.link, direction, placement(hinge.anchor), mark)


SAME = 1e-9
"""Largest distance, over the size of the linkage, between marks of one link that are one point."""
ROUNDING = 1e-15
NEAR = 0.02
"""Distance, over the size, between marks of one link that may have been meant to be one point."""


@dataclass(frozen=True)
class NamedPoint:
    """A point with its marks on the links that carry it, as the links are drawn."""

    name: str
    marks: tuple[ModelMark, ...]

    @cached_property
    def places(self) -> Mapping[int, complex]:
        """Places by link; where marks of a link coincide, the place of the first."""
        return {mark.link: mark.place for mark in reversed(self.marks)}


def points(linkage: Linkage, bodies: Container[str]) -> list[NamedPoint]:
    """Return all points of the linkage, in the order of the file."""
    groups: list[tuple[list[str], list[ModelMark]]] = []
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


def nearly(found: Sequence[NamedPoint], linkage: Linkage) -> Iterator[tuple[int, str]]:
    """Yield links with two points suspiciously near, such as an anchor beside its pin, in words."""
    limit = NEAR * size(linkage)
    for index, one in enumerate(found):
        for other in found[index + 1 :]:
            for link in one.places.keys() & other.places.keys():
                distance = abs(one.places[link] - other.places[link])
                if distance < limit:
                    yield link, f"{one.name} and {other.name} are {distance:.3g} m apart"


def size(linkage: Linkage) -> float:
    """Return the largest extent of the marks of one link [m]; if that is 0, of all marks."""
    by_link: dict[int, list[complex]] = {}
    for _, marks in _ties(linkage):
        for mark in marks:
            by_link.setdefault(mark.link, []).append(mark.place)
    moving = [_extent(places) for link, places in by_link.items() if link]
    return max(moving, default=0.0) or _extent([p for each in by_link.values() for p in each])


def _extent(places: Sequence[complex]) -> float:
    return max((abs(a - b) for a in places for b in places), default=0.0)


def _ties(linkage: Linkage) -> Iterator[tuple[list[str], list[ModelMark]]]:
    """Yield the marks of every pin, of every point on a line, and one of each link with nothing but
    lines: a link needs a point."""
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
            yield [guide.name], [ModelMark(guide.on, guide.through)]


def _meet(first: Sequence[ModelMark], second: Sequence[ModelMark], tolerance: float) -> bool:
    return any(
        a.link == b.link and abs(a.place - b.place) <= tolerance for a in first for b in second
    )


def pair(place: complex) -> Point:
    """Return a place as a point of a scene; a coordinate that is rounding of the other is 0."""
    least = ROUNDING * abs(place)
    x, y = (part if abs(part) > least else 0.0 for part in (place.real, place.imag))
    return x, y
