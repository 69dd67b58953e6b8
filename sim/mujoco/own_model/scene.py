"""The scene of a model that somebody else wrote: links with their points, sliders, masses."""

from __future__ import annotations

import cmath
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from models.joints import block_name
from models.laws import ConstantSpeed
from models.scene import GROUND, Driver, Link, Scene, Slider
from sim.mujoco.own_model.closures import body_name
from sim.mujoco.own_model.component import WORLD, joint_name, rigid
from sim.mujoco.own_model.fault import ModelError
from sim.mujoco.own_model.linkage import Guide, Linkage, Mark, Placement
from sim.mujoco.own_model.naming import scene_name
from sim.mujoco.own_model.points import NamedPoint, pair, points

CENTRED = 1e-9
"""A centre of mass that is nearer to a point, over the size of things, is in it."""


@dataclass(frozen=True)
class Matter:
    """Mass [kg], centre of mass as the link is drawn [m], inertia about it across the plane."""

    mass_kg: float
    centre: complex
    inertia_kg_m2: float


@dataclass(frozen=True, eq=False)
class SceneRead:
    """The scene, without a branch and at speed 1, whose driver's angle is what its joint reads;
    ``frames`` say, by link id, where the frame of
    each of its bodies is drawn (a link or a block), and ``names`` what the body is called there."""

    scene: Scene
    frames: Mapping[int, Placement]
    names: Mapping[int, str]
    points: Sequence[NamedPoint]


def scene_of(linkage: Linkage, name: str, source: str) -> SceneRead:
    """The scene of a linkage.

    Raises
    ------
    ModelError
        A link that nothing but its own joint holds, named with the joint; a driven body that is
        tied to the ground.
    """
    model = linkage.component.model
    called: dict[int, str] = {WORLD: GROUND}
    for link in linkage.links:
        called[link] = scene_name(body_name(model, link), "link", called.values())
    bodies = {body_name(model, body) for body in range(model.nbody)} | {GROUND}
    found = points(linkage, bodies, ())
    _refuse_loose(linkage, found, called)
    matter = {link: matter_of(linkage, link) for link in linkage.links}
    driver, reads = _driver(linkage)
    if driver == WORLD:
        joint = joint_name(model, linkage.component.driven)
        raise ModelError(f"joint {joint} can not turn: a weld ties its body to the ground")
    blocks = [
        link
        for link in linkage.links
        if link != driver and _is_block(linkage, link, found, matter[link])
    ]
    found += _centres(linkage, found, matter, blocks, called)
    frames = {link: _frame(linkage, link, found, matter[link]) for link in linkage.links}
    frames[WORLD] = Placement()
    frames[driver] = _reading(linkage, frames[driver], reads)
    links = {
        called[link]: Link(
            called[link],
            {p.name: pair(frames[link](p.places[link])) for p in _own(linkage, link, found)},
            matter[link].mass_kg,
            pair(frames[link](matter[link].centre)),
            matter[link].inertia_kg_m2,
        )
        for link in linkage.links
        if link not in blocks
    }
    sliders: dict[str, Slider] = {}
    names = dict(called)
    for guide in linkage.guides:
        slider = _slider(linkage, guide, found, frames, called, matter, sliders, blocks)
        sliders[slider.name] = slider
        if guide.mark is None and guide.rider in blocks:
            names[guide.rider] = block_name(slider)
            unit = cmath.exp(-1j * slider.direction_rad)
            on = frames[guide.on]
            point = next(p for p in found if p.name == slider.point).places[guide.rider]
            # A block has its point at its origin, and its x-axis along the line.
            turn = unit * on.turn
            frames[guide.rider] = Placement(turn, -turn * point)
    ground = {p.name: pair(p.places[WORLD]) for p in found if WORLD in p.places}
    gravity = linkage.component.plane.flat(np.array(model.opt.gravity, dtype=np.float64))
    scene = Scene(
        name=name,
        source=source,
        ground=ground,
        links=links,
        sliders=sliders,
        driver=Driver(called[driver], ConstantSpeed(reads, 1.0)),
        gravity_m_s2=pair(gravity),
    )
    if not scene.longest_m > 0.0:
        raise ModelError(
            "its links have no length: each has one point, in its centre of mass; an error is told "
            "over the longest link, so give one of them a second pin, or its mass where it is"
        )
    return SceneRead(scene, frames, names, found)


def matter_of(linkage: Linkage, link: int) -> Matter:
    """What the bodies of a link weigh together, as the link is drawn."""
    component = linkage.component
    model, data, plane = component.model, component.data, component.plane
    parts = []
    for body in range(1, model.nbody):
        root = rigid(model, body)
        if root == WORLD or linkage.placements.get(root, (WORLD,))[0] != link:
            continue
        centre = linkage.placements[root][1](plane.flat(data.xipos[body]))
        axes = data.ximat[body].reshape(3, 3).T @ plane.normal
        about = float(axes @ (model.body_inertia[body] * axes))
        parts.append((float(model.body_mass[body]), centre, about))
    mass = sum(part[0] for part in parts)
    centre = sum(m * c for m, c, _ in parts) / mass if mass else 0j
    inertia = sum(own + m * abs(c - centre) ** 2 for m, c, own in parts)
    return Matter(mass, centre, inertia)


def _own(linkage: Linkage, link: int, found: Sequence[NamedPoint]) -> list[NamedPoint]:
    """The points of a link; of the driven one its pivot first, which is that of its joint."""
    own = [point for point in found if link in point.places]
    return sorted(own, key=lambda point: WORLD not in point.places)


def _refuse_loose(linkage: Linkage, found: Sequence[NamedPoint], called: Mapping[int, str]) -> None:
    """Refuse a link that only one pair holds: it moves as it likes."""
    held = dict.fromkeys(linkage.links, 0)
    for pivot in linkage.pivots:
        for mark in pivot.marks:
            held[mark.link] = held.get(mark.link, 0) + 1
    for guide in linkage.guides:
        for link in (guide.on, guide.rider):
            held[link] = held.get(link, 0) + 1
    driver, _ = _driver(linkage)
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


def _driver(linkage: Linkage) -> tuple[int, float]:
    """The driven link, and what its joint reads as it is drawn [rad]."""
    model, joint = linkage.component.model, linkage.component.driven
    body = rigid(model, int(model.jnt_bodyid[joint]))
    return linkage.placements[body][0], float(model.qpos0[model.jnt_qposadr[joint]])


def _reading(linkage: Linkage, frame: Placement, reads: float) -> Placement:
    """The frame of the driven link, turned about its origin so that its angle is what the joint
    reads: all that is told of the driver's angle is in the joint's own coordinate."""
    model, joint = linkage.component.model, linkage.component.driven
    own = linkage.placements[rigid(model, int(model.jnt_bodyid[joint]))][1]
    turn = cmath.exp(-1j * reads) / own.turn
    return Placement(turn, turn / frame.turn * frame.shift)


def _is_block(linkage: Linkage, link: int, found: Sequence[NamedPoint], matter: Matter) -> bool:
    """Whether a sliding link is a block: one point, that holds its mass, and nothing on it."""
    slides = [g for g in linkage.guides if g.rider == link and g.mark is None]
    guides = [g for g in linkage.guides if g.on == link]
    own = [point for point in found if link in point.places]
    if len(slides) != 1 or guides or len(own) != 1:
        return False
    size = max(abs(own[0].places[link]), abs(matter.centre), 1e-12)
    return abs(own[0].places[link] - matter.centre) <= CENTRED * size


def _centres(
    linkage: Linkage,
    found: Sequence[NamedPoint],
    matter: Mapping[int, Matter],
    blocks: Sequence[int],
    called: Mapping[int, str],
) -> list[NamedPoint]:
    """The centres of mass of links that have one point alone: such a link has no length, and none
    of its places but that one would be judged."""
    named = {point.name for point in found}
    centres = []
    for link in linkage.links:
        own = [point for point in found if link in point.places]
        apart = abs(own[0].places[link] - matter[link].centre) if own else 0.0
        if link not in blocks and len(own) == 1 and apart > CENTRED * abs(matter[link].centre):
            name = scene_name(f"{called[link]}-centre", "P", named)
            named.add(name)
            centres.append(NamedPoint(name, (Mark(link, matter[link].centre),)))
    return centres


def _frame(linkage: Linkage, link: int, found: Sequence[NamedPoint], matter: Matter) -> Placement:
    """The frame of a link: origin in its first point, x-axis towards its second, along its line,
    or towards its centre of mass."""
    places = [point.places[link] for point in _own(linkage, link, found)]
    origin = places[0] if places else matter.centre
    ahead = next((place for place in places[1:] if place != origin), None)
    along = next((guide.direction for guide in linkage.guides if guide.on == link), None)
    if ahead is None and along is None and abs(matter.centre - origin) > 0.0:
        ahead = matter.centre
    direction = ahead - origin if ahead is not None else along if along is not None else 1.0 + 0j
    turn = abs(direction) / direction
    return Placement(turn, -turn * origin)


def _slider(
    linkage: Linkage,
    guide: Guide,
    found: Sequence[NamedPoint],
    frames: Mapping[int, Placement],
    called: Mapping[int, str],
    matter: Mapping[int, Matter],
    sliders: Mapping[str, Slider],
    blocks: Sequence[int],
) -> Slider:
    """A pair that slides."""
    rider, on = guide.rider, frames[guide.on]
    direction = cmath.phase(on.turn * guide.direction)
    if guide.mark is None:
        own = [point for point in found if rider in point.places]
        point, through = own[0], own[0].places[rider]
        name = scene_name(called[rider], "slider", sliders)
    else:
        point = next(point for point in found if guide.mark in point.marks)
        through = guide.through
        name = scene_name(point.name, "slider", sliders)
    unit = cmath.exp(1j * direction)
    place = on(through)
    foot = place - (place * unit.conjugate()).real * unit  # nearest to the origin of the guide
    common = (name, point.name, called[guide.on], pair(foot), direction)
    if guide.mark is not None:
        return Slider(*common)
    if rider in blocks:
        return Slider(
            *common, mass_kg=matter[rider].mass_kg, inertia_kg_m2=matter[rider].inertia_kg_m2
        )
    turn = (
        frames[rider].turn * guide.lean / on.turn
    )  # from the frame of the guide to that of the link
    return Slider(*common, link=called[rider], angle_rad=-cmath.phase(turn) - direction)
