"""Faults of what the engine is given: another mechanism than the scene, itself sound."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

from models.laws import ConstantSpeed, Law
from models.moved_scene import scaled
from models.scene import Link, Scene
from reports.selftest.fault import FOURBAR, SLIDER, Fault, in_scene


def long_coupler(scene: Scene, share: float) -> Scene:
    """The link that is pinned to the driver."""
    name = list(scene.links)[1]
    return _with_link(scene, _scaled(scene.links[name], 1.0 + share))


def _scaled(link: Link, factor: float) -> Link:
    points = {name: (factor * x, factor * y) for name, (x, y) in link.points.items()}
    return replace(link, points=points)


def _with_link(scene: Scene, link: Link) -> Scene:
    return replace(scene, links={**scene.links, link.name: link})


def _moved_pin(scene: Scene, share: float) -> Scene:
    """The last pin of the ground, or the line of the slider."""
    off = share * scene.longest_m
    if scene.sliders:
        (slider,) = scene.sliders.values()
        x, y = slider.through_m
        return replace(scene, sliders={slider.name: replace(slider, through_m=(x, y + off))})
    name, (x, y) = list(scene.ground.items())[-1]
    return replace(scene, ground={**scene.ground, name: (x + off, y)})


def _turned_line(scene: Scene, angle_rad: float) -> Scene:
    (slider,) = scene.sliders.values()
    aside = replace(slider, direction_rad=slider.direction_rad + angle_rad)
    return replace(scene, sliders={slider.name: aside})


def _larger(scene: Scene, share: float) -> Scene:
    """Every length: the angles stay what they are."""
    return scaled(scene, 1.0 + share)


def _swapped(scene: Scene, swap: float) -> Scene:
    """The last two links have each other's length."""
    inner, outer = list(scene.links.values())[-2:]
    factor = _length(outer) / _length(inner) if swap else 1.0
    scene = _with_link(scene, _scaled(inner, factor))
    return _with_link(scene, _scaled(outer, 1.0 / factor))


def _length(link: Link) -> float:
    (x, y) = list(link.points.values())[-1]
    return float((x * x + y * y) ** 0.5)


def _driven(scene: Scene, law: Law) -> Scene:
    return replace(scene, driver=replace(scene.driver, law=law))


def _sped_up(scene: Scene, factor: float) -> Law:
    law = scene.driver.law
    assert isinstance(law, ConstantSpeed)
    return replace(law, speed_rad_s=law.speed_rad_s * factor)


def _faster(scene: Scene, share: float) -> Scene:
    return _driven(scene, _sped_up(scene, 1.0 + share))


def _ahead(scene: Scene, angle_rad: float) -> Scene:
    return _driven(scene, scene.driver.law.turned(angle_rad))


def _backwards(scene: Scene, swap: float) -> Scene:
    return _driven(scene, _sped_up(scene, -1.0 if swap else 1.0))


def other_branch(scene: Scene, swap: float) -> Scene:
    sign = -1 if swap else 1
    return replace(scene, branch={name: sign * way for name, way in scene.branch.items()})


_fault = partial(Fault, "scene")
FAULTS = (
    _fault("link-too-long", "a link is too long", "CC103", in_scene(long_coupler), 1e-3, "of it"),
    _fault(
        "pin-moved",
        "a pin or a slider's line is elsewhere",
        "CC110",
        in_scene(_moved_pin),
        1e-4,
        "L",
        finer=True,
    ),
    _fault(
        "line-turned",
        "the slider's line points elsewhere",
        "CC104",
        in_scene(_turned_line),
        1e-3,
        "rad",
        scenes=(SLIDER,),
    ),
    _fault(
        "other-scale", "right shape, every length scaled", "CC113", in_scene(_larger), 1e-3, "of it"
    ),
    _fault(
        "lengths-swapped",
        "two links have each other's length",
        "CC103",
        in_scene(_swapped),
        scenes=(FOURBAR,),
    ),
    _fault("wrong-branch", "the other of the two assemblies", "CC103", in_scene(other_branch)),
    _fault("speed-off", "the crank turns too fast", "CC102", in_scene(_faster), 1e-5, "w"),
    _fault(
        "start-off", "the crank starts at another angle", "CC102", in_scene(_ahead), 1e-6, "rad"
    ),
    _fault("turns-backwards", "the crank turns clockwise", "CC102", in_scene(_backwards)),
)
