"""Faults of another mechanism than the scene, itself sound; and of right numbers in a wrong place
of the log: of another body, axis or unit."""

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from models.array import Array
from models.motion import PointMotion
from models.scene import Link, Scene, laws
from models.scene.moved import scaled, with_link
from reports.selftest import fault
from reports.selftest.free_changes import long_by, of_coupler, scaled_points
from reports.selftest.log_faults import every_series, last, moved, with_points
from sim.engine import Run


def _moved_pin(scene: Scene, share: float) -> Scene:
    """Move the last pin of the ground, or the line of the slider."""
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


def _swapped(scene: Scene, swap: float) -> Scene:
    """Exchange the lengths of the last two links."""
    inner, outer = list(scene.links.values())[-2:]
    factor = _length(outer) / _length(inner) if swap else 1.0
    scene = with_link(scene, inner.name, points=scaled_points(inner, factor))
    return with_link(scene, outer.name, points=scaled_points(outer, 1.0 / factor))


def _length(link: Link) -> float:
    (x, y) = list(link.points.values())[-1]
    return float((x * x + y * y) ** 0.5)


def _sped_up(scene: Scene, factor: float) -> Scene:
    law = scene.driver.law
    assert isinstance(law, laws.ConstantSpeed)
    other = replace(law, speed_rad_s=law.speed_rad_s * factor)
    return replace(scene, driver=replace(scene.driver, law=other))


def _ahead(scene: Scene, angle_rad: float) -> Scene:
    law = scene.driver.law.turned(angle_rad)
    return replace(scene, driver=replace(scene.driver, law=law))


def _other_branch(scene: Scene, swap: float) -> Scene:
    sign = -1 if swap else 1
    return replace(scene, branch={name: sign * way for name, way in scene.branch.items()})


_scene = partial(fault.Fault, "scene")
MECHANISM = (
    _scene("link-too-long", "a link is too long", "CC103", fault.in_scene(of_coupler(long_by)),
           1e-3, "of it"),
    _scene("pin-moved", "a pin or a slider's line is elsewhere", "CC110",
           fault.in_scene(_moved_pin), 1e-4, "L", finer=True),
    _scene("line-turned", "the slider's line points elsewhere", "CC104",
           fault.in_scene(_turned_line), 1e-3, "rad", scenes=(fault.SLIDER,)),
    _scene("other-scale", "right shape, every length scaled", "CC113",
           fault.in_scene(lambda scene, share: scaled(scene, 1.0 + share)), 1e-3, "of it"),
    _scene("lengths-swapped", "two links have each other's length", "CC103",
           fault.in_scene(_swapped), scenes=(fault.FOURBAR,)),
    _scene("wrong-branch", "the other of the two assemblies", "CC103",
           fault.in_scene(_other_branch)),
    _scene("speed-off", "the crank turns too fast", "CC102",
           fault.in_scene(lambda scene, share: _sped_up(scene, 1.0 + share)), 1e-5, "w"),
    _scene("start-off", "the crank starts at another angle", "CC102", fault.in_scene(_ahead),
           1e-6, "rad"),
    _scene("turns-backwards", "the crank turns clockwise", "CC102",
           fault.in_scene(lambda scene, swap: _sped_up(scene, -1.0 if swap else 1.0))),
)  # fmt: skip


def _links_swapped(_scene: Scene, done: Run) -> Run:
    motion = moved(done)
    one, two = list(motion.links)[-2:]
    links = {**motion.links, one: motion.links[two], two: motion.links[one]}
    return replace(done, motion=replace(motion, links=links))


def _points(change: Callable[[Array], Array]) -> fault.Plant:
    """Change positions, velocities and accelerations of all points, or leave them for size 0."""
    return fault.switched(lambda _, done: with_points(done, change))


def _centre_logged(scene: Scene, done: Run) -> Run:
    """Log the centre of gravity of the last link in the place of the pin at its end."""
    motion = moved(done)
    link = scene.links[last(scene)]
    first, end = (motion.points[name] for name in list(link.points)[:2])
    middle = PointMotion(
        *((a + b) / 2 for a, b in zip(vars(first).values(), vars(end).values(), strict=True))
    )
    points = {**motion.points, list(link.points)[1]: middle}
    return replace(done, motion=replace(motion, points=points))


def _displaced(scene: Scene, done: Run, share: float) -> Run:
    motion = moved(done)
    ((name, slider),) = motion.sliders.items()
    off = replace(slider, displacement=slider.displacement + share * scene.longest_m)
    return replace(done, motion=replace(motion, sliders={name: off}))


@fault.planting
def _other_midway(size: float, *args: Any, **options: Any) -> Run:
    """Take the second half of the log from a run of the other assembly."""
    one, two = (fault.in_scene(_other_branch)(each)(*args, **options) for each in (0.0, size))
    half = len(moved(one).time_s) // 2
    pairs = {id(a): b for a, b in zip(_series(one), _series(two), strict=True)}
    return every_series(one, lambda a: np.concatenate([a[:half], pairs[id(a)][half:]]))


def _series(done: Run) -> list[Array]:
    """Return every logged series, in the order of the log."""
    motion = moved(done)
    bodies = [*motion.links.values(), *motion.points.values(), *motion.sliders.values()]
    return [series for body in bodies for series in vars(body).values()] + list(done.gaps.values())


_misplaced = partial(fault.Fault, "misplaced")
MISPLACED = (
    _misplaced("columns-swapped", "two links in each other's place", "CC103",
               fault.switched(_links_swapped), scenes=(fault.FOURBAR,)),
    _misplaced("xy-swapped", "x and y in each other's place", "CC113",
               _points(lambda series: series[:, ::-1])),
    _misplaced("y-down", "mirrored plane: y counted downwards", "CC113",
               _points(lambda series: series * np.array([1.0, -1.0]))),
    _misplaced("millimetres", "points in mm", "CC113", _points(lambda series: 1000.0 * series)),
    _misplaced("centre-logged", "a centre of gravity in a pin's place", "CC113",
               fault.switched(_centre_logged)),
    _misplaced("origin-off", "a displacement from another origin", "CC104",
               fault.in_log(_displaced), 1e-3, "L", scenes=(fault.SLIDER,)),
    _misplaced("branch-midway", "the other assembly from mid-turn on", "CC101", _other_midway,
               says=("left its branch",)),
)  # fmt: skip
