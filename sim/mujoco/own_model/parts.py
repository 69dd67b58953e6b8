"""The links of a linkage with all that a scene says of them: names, points, masses."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from models.scene import GROUND
from sim.mujoco.own_model.closures import body_name
from sim.mujoco.own_model.component import WORLD, joint_name, rigid
from sim.mujoco.own_model.fault import ModelError
from sim.mujoco.own_model.linkage import Linkage, Mark
from sim.mujoco.own_model.matter import Matter, matter_of
from sim.mujoco.own_model.naming import scene_name
from sim.mujoco.own_model.points import NamedPoint, points

CENTRED = 1e-9
"""A centre of mass that is nearer to a point, over the size of things, is in it."""


@dataclass(frozen=True, eq=False)
class Parts:
    """By link id what it is ``called`` and its ``matter``, without the ground; all ``points``;
    which links are ``blocks``, that are a point and a mass; the ``driver``, and what its joint
    ``reads`` as it is drawn [rad]."""

    linkage: Linkage
    called: Mapping[int, str]
    points: Sequence[NamedPoint]
    matter: Mapping[int, Matter]
    blocks: Sequence[int]
    driver: int
    reads: float

    def points_of(self, link: int) -> list[NamedPoint]:
        """The points of a link; of the driven one its pivot first, which is that of its joint."""
        own = [point for point in self.points if link in point.places]
        return sorted(own, key=lambda point: WORLD not in point.places)

    def point(self, name: str) -> NamedPoint:
        """The point of that name."""
        return next(point for point in self.points if point.name == name)


def parts_of(linkage: Linkage) -> Parts:
    """The parts of a linkage.

    Raises
    ------
    ModelError
        A link that nothing but its own joint holds, named with the joint; a driven body that is
        tied to the ground.
    """
    model, joint = linkage.component.model, linkage.component.driven
    called: dict[int, str] = {WORLD: GROUND}
    for link in linkage.links:
        called[link] = scene_name(body_name(model, link), "link", called.values())
    bodies = {body_name(model, body) for body in range(model.nbody)} | {GROUND}
    driver = linkage.placements[rigid(model, int(model.jnt_bodyid[joint]))][0]
    if driver == WORLD:
        raise ModelError(
            f"joint {joint_name(model, joint)} can not turn: a weld ties its body to the ground"
        )
    found = points(linkage, bodies)
    _refuse_loose(linkage, driver, called)
    matter = {link: matter_of(linkage, link) for link in linkage.links}
    reads = float(model.qpos0[model.jnt_qposadr[joint]])
    bare = Parts(linkage, called, found, matter, (), driver, reads)
    blocks = [link for link in linkage.links if link != driver and _is_block(bare, link)]
    parts = replace(bare, blocks=blocks)
    return replace(parts, points=[*found, *_centres(parts)])


def _refuse_loose(linkage: Linkage, driver: int, called: Mapping[int, str]) -> None:
    """Refuse a link that only one pair holds: it moves as it likes."""
    held = dict.fromkeys(linkage.links, 0)
    for pivot in linkage.pivots:
        for mark in pivot.marks:
            held[mark.link] = held.get(mark.link, 0) + 1
    for guide in linkage.guides:
        for link in (guide.on, guide.rider):
            held[link] = held.get(link, 0) + 1
    loose = [link for link in linkage.links if held[link] < 2 and link != driver]
    if loose:
        bodies = {body.id: body for body in linkage.component.bodies}
        words = [
            f"{called[link]} ({', '.join(j.name for j in bodies[link].joints) or 'no joint'})"
            for link in loose
        ]
        raise ModelError(
            f"more than one freedom: one driver needs mobility 1; loose: {', '.join(words)}; close "
            "its loop with <connect>, fix it, or take it out"
        )


def _is_block(parts: Parts, link: int) -> bool:
    """Whether a sliding link is a block: one point, that holds its mass, and nothing on it."""
    guides = parts.linkage.guides
    slides = [guide for guide in guides if guide.rider == link and guide.mark is None]
    own, centre = parts.points_of(link), parts.matter[link].centre
    if len(slides) != 1 or len(own) != 1 or any(guide.on == link for guide in guides):
        return False
    place = own[0].places[link]
    return abs(place - centre) <= CENTRED * max(abs(place), abs(centre), 1e-12)


def _centres(parts: Parts) -> list[NamedPoint]:
    """The centres of mass of links that have one point alone: such a link has no length, and none
    of its places but that one would be judged."""
    taken = {point.name for point in parts.points}
    centres = []
    for link in parts.linkage.links:
        own, centre = parts.points_of(link), parts.matter[link].centre
        apart = abs(own[0].places[link] - centre) if own else 0.0
        if link not in parts.blocks and len(own) == 1 and apart > CENTRED * abs(centre):
            name = scene_name(f"{parts.called[link]}-centre", "P", taken)
            taken.add(name)
            centres.append(NamedPoint(name, (Mark(link, centre),)))
    return centres
