"""Scene of a user's own model: links with their points, sliders, masses."""

import cmath
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from models.scene import GROUND, Driver, Link, Scene, Slider
from models.scene.joints import block_name
from models.scene.laws import ConstantSpeed
from sim.mujoco.own_model.driven_loop import WORLD, joint_name, rigid
from sim.mujoco.own_model.file import ModelError, body_name, scene_name
from sim.mujoco.own_model.linkage import (
    Linkage,
    ModelGuide,
    ModelMark,
    NamedPoint,
    Placement,
    pair,
    points,
)


@dataclass(frozen=True)
class Matter:
    """Mass [kg], centre of mass as the link is drawn [m], inertia about it across the plane."""

    mass_kg: float
    centre: complex
    inertia_kg_m2: float


def matter_of(linkage: Linkage, link: int) -> Matter:
    """Return the mass and inertia of all bodies of a link, as the link is drawn."""
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


CENTRED = 1e-9
"""Distance of a centre of mass from a point, over the size, below which it is in the point."""


@dataclass(frozen=True, eq=False)
class SceneParts:
    """Parts of a scene: by link id the name ``called`` and the ``matter``, without the ground; all
    ``points``; the ``blocks``, links of a point and a mass; the ``driver``, and the coordinate that
    its joint ``reads`` as drawn [rad]."""

    linkage: Linkage
    called: Mapping[int, str]
    points: Sequence[NamedPoint]
    matter: Mapping[int, Matter]
    blocks: Sequence[int]
    driver: int
    reads: float

    def points_of(self, link: int) -> list[NamedPoint]:
        """Return the points of a link; of the driven link its pivot, the joint's, first."""
        own = [point for point in self.points if link in point.places]
        return sorted(own, key=lambda point: WORLD not in point.places)


def parts_of(linkage: Linkage) -> SceneParts:
    """Make the parts of a linkage.

    Raises
    ------
    ModelError
        A driven body welded to the ground.
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
    matter = {link: matter_of(linkage, link) for link in linkage.links}
    reads = float(model.qpos0[model.jnt_qposadr[joint]])
    bare = SceneParts(linkage, called, found, matter, (), driver, reads)
    blocks = [link for link in linkage.links if link != driver and _is_block(bare, link)]
    parts = replace(bare, blocks=blocks)
    return replace(parts, points=[*found, *_centres(parts)])


def _is_block(parts: SceneParts, link: int) -> bool:
    """True if a sliding link is a block: one point, with its mass, and no guide on it."""
    guides = parts.linkage.guides
    slides = [guide for guide in guides if guide.rider == link and guide.mark is None]
    own, centre = parts.points_of(link), parts.matter[link].centre
    if len(slides) != 1 or len(own) != 1 or any(guide.on == link for guide in guides):
        return False
    place = own[0].places[link]
    return abs(place - centre) <= CENTRED * max(abs(place), abs(centre), 1e-12)


def _centres(parts: SceneParts) -> list[NamedPoint]:
    """Return the centres of mass of links with a single point: such a link has no length, and no
    other of its places would be judged."""
    taken = {point.name for point in parts.points}
    centres = []
    for link in parts.linkage.links:
        own, centre = parts.points_of(link), parts.matter[link].centre
        apart = abs(own[0].places[link] - centre) if own else 0.0
        if link not in parts.blocks and len(own) == 1 and apart > CENTRED * abs(centre):
            name = scene_name(f"{parts.called[link]}-centre", "P", taken)
            taken.add(name)
            centres.append(NamedPoint(name, (ModelMark(link, centre),)))
    return centres


@dataclass(frozen=True, eq=False)
class SceneRead:
    """The scene read from a model, without a branch and at speed 1, with its joint's coordinate as
    the driver's angle; ``frames`` are, by link id, the drawn frames of its bodies (a link or a
    block), and ``names`` the names of these bodies."""

    scene: Scene
    frames: Mapping[int, Placement]
    names: Mapping[int, str]
    parts: SceneParts


def scene_of(linkage: Linkage, name: str, source: str) -> SceneRead:
    """Make the scene of a linkage.

    Raises
    ------
    ModelError
        As `parts_of`; links without length.
    """
    parts = parts_of(linkage)
    frames = {link: _frame(parts, link) for link in linkage.links}
    frames |= {WORLD: Placement(), parts.driver: _reading(parts, frames[parts.driver])}
    sliders: dict[str, Slider] = {}
    names = dict(parts.called)
    for guide in linkage.guides:
        slider = _slider(parts, guide, frames, sliders)
        sliders[slider.name] = slider
        if guide.mark is None and guide.rider in parts.blocks:
            names[guide.rider] = block_name(slider)
            frames[guide.rider] = _block_frame(parts, guide, slider, frames[guide.on])
    gravity = np.array(linkage.component.model.opt.gravity, dtype=np.float64)
    scene = Scene(
        name=name,
        source=source,
        ground={p.name: pair(p.places[WORLD]) for p in parts.points if WORLD in p.places},
        links={
            parts.called[link]: _link(parts, link, frames[link])
            for link in linkage.links
            if link not in parts.blocks
        },
        sliders=sliders,
        driver=Driver(parts.called[parts.driver], ConstantSpeed(parts.reads, 1.0)),
        gravity_m_s2=pair(linkage.component.plane.flat(gravity)),
    )
    if not scene.longest_m > 0.0:
        raise ModelError(
            "its links have no length: each has one point, in its centre of mass; errors are given "
            "over the longest link, so give one link a second pin, or the true place of its mass"
        )
    return SceneRead(scene, frames, names, parts)


def _link(parts: SceneParts, link: int, frame: Placement) -> Link:
    matter = parts.matter[link]
    return Link(
        parts.called[link],
        {point.name: pair(frame(point.places[link])) for point in parts.points_of(link)},
        matter.mass_kg,
        pair(frame(matter.centre)),
        matter.inertia_kg_m2,
    )


def _frame(parts: SceneParts, link: int) -> Placement:
    """Return the frame of a link: origin in its first point, x-axis towards its second, along its
    line, or towards its centre of mass."""
    places = [point.places[link] for point in parts.points_of(link)]
    centre = parts.matter[link].centre
    origin = places[0] if places else centre
    ahead = next((place for place in places[1:] if place != origin), None)
    along = next((guide.direction for guide in parts.linkage.guides if guide.on == link), None)
    if ahead is None and along is None and abs(centre - origin) > 0.0:
        ahead = centre
    direction = ahead - origin if ahead is not None else along if along is not None else 1.0 + 0j
    turn = abs(direction) / direction
    return Placement(turn, -turn * origin)


def _reading(parts: SceneParts, frame: Placement) -> Placement:
    """Return the frame of the driven link, turned about its origin so that its angle is the joint's
    coordinate, which alone determines the driver's angle."""
    component = parts.linkage.component
    body = rigid(component.model, int(component.model.jnt_bodyid[component.driven]))
    turn = cmath.exp(-1j * parts.reads) / parts.linkage.placements[body][1].turn
    return Placement(turn, turn / frame.turn * frame.shift)


def _block_frame(parts: SceneParts, guide: ModelGuide, slider: Slider, on: Placement) -> Placement:
    """Return the frame of a block: its point is its origin, and its x-axis lies along the line."""
    turn = cmath.exp(-1j * slider.direction_rad) * on.turn * guide.meets.turn
    point = next(point for point in parts.points if point.name == slider.point)
    return Placement(turn, -turn * point.places[guide.rider])


def _slider(
    parts: SceneParts,
    guide: ModelGuide,
    frames: Mapping[int, Placement],
    sliders: Mapping[str, Slider],
) -> Slider:
    rider, on = guide.rider, frames[guide.on]
    direction = cmath.phase(on.turn * guide.direction)
    if guide.mark is None:
        point = parts.points_of(rider)[0]
        through, wished = guide.meets(point.places[rider]), parts.called[rider]
    else:
        point = next(point for point in parts.points if guide.mark in point.marks)
        through, wished = guide.through, point.name
    unit = cmath.exp(1j * direction)
    foot = (on(through) * unit.conjugate()).imag * 1j * unit  # nearest to the origin of the guide
    name = scene_name(wished, "slider", sliders)
    common = (name, point.name, parts.called[guide.on], pair(foot), direction)
    if guide.mark is not None:
        return Slider(*common)
    if rider in parts.blocks:
        matter = parts.matter[rider]
        return Slider(*common, mass_kg=matter.mass_kg, inertia_kg_m2=matter.inertia_kg_m2)
    # From the guide's frame to the link's.
    turn = frames[rider].turn / (guide.meets.turn * on.turn)
    return Slider(*common, link=parts.called[rider], angle_rad=-cmath.phase(turn) - direction)
