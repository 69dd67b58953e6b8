"""From rigid bodies, joints and closures to the links of a planar linkage and its pairs.

Everything lies in one plane, as the model is drawn: a point of a body is where it is drawn. Bodies
that a weld ties are one link, in the pose that the weld asks for::

    rocker --hinge-- half of the coupler ==weld== other half --hinge-- crank

Pairs of a body against its parent: a hinge is a pin, a slide a prismatic pair, slide and hinge a
point of the body on a line of the parent, hinge and slide a line of the body over a point of the
parent; two slides and a hinge are no pair at all.
"""

from __future__ import annotations

import cmath
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from sim.mujoco.own_model.closures import Closure, body_name
from sim.mujoco.own_model.component import PARALLEL_DEG, WORLD, Component, RigidBody
from sim.mujoco.own_model.fault import ModelError

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
    """Where a rigid body is drawn, and where it stands in its link: z becomes turn z + shift."""

    turn: complex = 1.0 + 0.0j
    shift: complex = 0.0j

    def __call__(self, place: complex) -> complex:
        return self.turn * place + self.shift

    @property
    def inverse(self) -> Placement:
        """The way back."""
        return Placement(1.0 / self.turn, -self.shift / self.turn)

    def after(self, first: Placement) -> Placement:
        """This one of what ``first`` gives."""
        return Placement(self.turn * first.turn, self(first.shift))


@dataclass(frozen=True)
class Mark:
    """A place on a link, as the link is drawn."""

    link: int
    place: complex


@dataclass(frozen=True)
class Pivot:
    """A pin between two links: each has its own copy."""

    name: str
    marks: tuple[Mark, Mark]


@dataclass(frozen=True)
class Guide:
    """``rider`` slides along ``direction`` of link ``on``: the whole link, or, where ``mark`` says
    so, one point of it, through ``through`` on the link ``on``. Where the whole link slides
    ``meets`` says where its places are on the link ``on``, as the pair is drawn."""

    name: str
    on: int
    rider: int
    direction: complex
    through: complex
    mark: Mark | None = None
    meets: Placement = Placement()


@dataclass(frozen=True, eq=False)
class Linkage:
    """Links by the id of their first rigid body, 0 the ground; ``placements`` by rigid body."""

    component: Component
    placements: Mapping[int, tuple[int, Placement]]
    pivots: tuple[Pivot, ...]
    guides: tuple[Guide, ...]

    @property
    def links(self) -> tuple[int, ...]:
        """The moving links, in the order of the file."""
        return tuple(sorted({link for link, _ in self.placements.values()} - {WORLD}))

    def mark(self, body: int, place: complex) -> Mark:
        """A place that is drawn on a rigid body, on its link."""
        link, placement = self.placements[body]
        return Mark(link, placement(place))


def linkage(component: Component) -> Linkage:
    """The linkage of a component.

    Raises
    ------
    ModelError
        Two joints on a body that are no pair of a linkage; a weld that tilts bodies out of the
        plane.
    """
    bare = Linkage(component, _welded(component), (), ())
    pairs = [pair for body in component.bodies for pair in _pairs(bare, body)]
    pivots = [pair for pair in pairs if isinstance(pair, Pivot)]
    guides = [pair for pair in pairs if isinstance(pair, Guide)]
    for each in component.closures:
        if each.kind == "connect":
            ends = [
                bare.mark(component.rigid(body), component.plane.flat(anchor))
                for body, anchor in zip(each.bodies, each.anchors, strict=True)
            ]
            pivots.append(Pivot(each.name, (ends[0], ends[1])))
    return Linkage(component, bare.placements, tuple(pivots), tuple(guides))


def _welded(component: Component) -> dict[int, tuple[int, Placement]]:
    """Link and placement of every rigid body, by following the welds from the first of each."""
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


def _placement(component: Component, weld: Closure) -> Placement:
    """Where the second body of a weld stands when it holds, from where it is drawn."""
    drawn = component.data.xmat[weld.bodies[1]].reshape(3, 3)
    turn, tilt_deg = component.plane.turned(weld.rotation @ drawn.T)
    if tilt_deg > PARALLEL_DEG:
        names = " and ".join(body_name(component.model, body) for body in weld.bodies)
        raise ModelError(f"weld {weld.name}: it tilts {names} {tilt_deg:.3g} deg out of the plane")
    first, second = (component.plane.flat(anchor) for anchor in weld.anchors)
    unit = cmath.exp(1j * turn)
    return Placement(unit, first - unit * second)


def _pairs(bare: Linkage, body: RigidBody) -> Iterator[Pivot | Guide]:
    """What ties a body to its parent."""
    kinds = " ".join(joint.kind for joint in body.joints)
    kind = PAIRS.get(kinds)
    if kind is None:
        raise ModelError(
            f"body {body.name}: its joints are {kinds}; a linkage has a hinge, a slide, or one of "
            "each; give what lies between two joints a body of its own"
        )
    if kind == "none":
        return
    hinge = next((joint for joint in body.joints if joint.kind == "hinge"), None)
    slide = next((joint for joint in body.joints if joint.kind == "slide"), None)
    own = bare.placements[body.id][0]
    on_parent = bare.placements[body.parent]
    if hinge is not None and slide is None:
        marks = bare.mark(body.parent, hinge.anchor), bare.mark(body.id, hinge.anchor)
        yield Pivot(hinge.name, marks)
    elif slide is not None and hinge is None:
        link, placement = on_parent
        direction = placement.turn * slide.direction
        yield Guide(
            slide.name,
            link,
            own,
            direction,
            placement(slide.anchor),
            meets=placement.after(bare.placements[body.id][1].inverse),
        )
    elif slide is not None and hinge is not None:
        upper, lower = (body.parent, body.id) if kind == "point on line" else (body.id, body.parent)
        link, placement = bare.placements[upper]
        mark = bare.mark(lower, hinge.anchor)
        direction = placement.turn * slide.direction * (1 if upper == body.parent else -1)
        yield Guide(hinge.name, link, mark.link, direction, placement(hinge.anchor), mark)
