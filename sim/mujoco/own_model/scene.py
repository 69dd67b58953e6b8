"""The scene of a model that somebody else wrote: links with their points, sliders, masses."""

from __future__ import annotations

import cmath
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from models.joints import block_name
from models.laws import ConstantSpeed
from models.scene import Driver, Link, Scene, Slider
from sim.mujoco.own_model.component import WORLD, rigid
from sim.mujoco.own_model.fault import ModelError
from sim.mujoco.own_model.linkage import Guide, Linkage, Placement
from sim.mujoco.own_model.naming import scene_name
from sim.mujoco.own_model.parts import Parts, parts_of
from sim.mujoco.own_model.points import NamedPoint, pair


@dataclass(frozen=True, eq=False)
class SceneRead:
    """The scene, without a branch and at speed 1, whose driver's angle is what its joint reads;
    ``frames`` say, by link id, where the frame of each of its bodies is drawn (a link or a block),
    and ``names`` what the body is called there."""

    scene: Scene
    frames: Mapping[int, Placement]
    names: Mapping[int, str]
    parts: Parts

    @property
    def points(self) -> tuple[NamedPoint, ...]:
        """The points of the scene, as its links are drawn."""
        return tuple(self.parts.points)


def scene_of(linkage: Linkage, name: str, source: str) -> SceneRead:
    """The scene of a linkage.

    Raises
    ------
    ModelError
        As `parts_of`; links that have no length.
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
            "its links have no length: each has one point, in its centre of mass; an error is told "
            "over the longest link, so give one of them a second pin, or its mass where it is"
        )
    return SceneRead(scene, frames, names, parts)


def _link(parts: Parts, link: int, frame: Placement) -> Link:
    """A link in its own frame."""
    matter = parts.matter[link]
    return Link(
        parts.called[link],
        {point.name: pair(frame(point.places[link])) for point in parts.points_of(link)},
        matter.mass_kg,
        pair(frame(matter.centre)),
        matter.inertia_kg_m2,
    )


def _frame(parts: Parts, link: int) -> Placement:
    """The frame of a link: origin in its first point, x-axis towards its second, along its line,
    or towards its centre of mass."""
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


def _reading(parts: Parts, frame: Placement) -> Placement:
    """The frame of the driven link, turned about its origin so that its angle is what the joint
    reads: all that is told of the driver's angle is in the joint's own coordinate."""
    component = parts.linkage.component
    body = rigid(component.model, int(component.model.jnt_bodyid[component.driven]))
    turn = cmath.exp(-1j * parts.reads) / parts.linkage.placements[body][1].turn
    return Placement(turn, turn / frame.turn * frame.shift)


def _block_frame(parts: Parts, guide: Guide, slider: Slider, on: Placement) -> Placement:
    """The frame of a block: its point is its origin, and its x-axis lies along the line."""
    turn = cmath.exp(-1j * slider.direction_rad) * on.turn * guide.meets.turn
    return Placement(turn, -turn * parts.point(slider.point).places[guide.rider])


def _slider(
    parts: Parts, guide: Guide, frames: Mapping[int, Placement], sliders: Mapping[str, Slider]
) -> Slider:
    """A pair that slides."""
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
    # From the frame of the guide to that of the link.
    turn = frames[rider].turn / (guide.meets.turn * on.turn)
    return Slider(*common, link=parts.called[rider], angle_rad=-cmath.phase(turn) - direction)
