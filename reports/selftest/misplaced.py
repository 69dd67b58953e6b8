"""Faults of a log whose numbers are right, elsewhere: of another body, axis or unit."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from models.array import Array
from models.motion import PointMotion
from models.scene import Scene
from reports.judge.cell import CellRunner
from reports.selftest.fault import FOURBAR, SLIDER, Fault, Plant, in_log, in_scene, switched
from reports.selftest.logs import every_series, last, moved, with_points
from reports.selftest.mechanism import other_branch
from sim.engine import Run


def _links_swapped(_scene: Scene, done: Run) -> Run:
    """The columns of the last two links."""
    motion = moved(done)
    one, two = list(motion.links)[-2:]
    links = {**motion.links, one: motion.links[two], two: motion.links[one]}
    return replace(done, motion=replace(motion, links=links))


def _points(change: Callable[[Array], Array]) -> Plant:
    """The positions, velocities and accelerations of all points are changed, or are not."""
    return switched(lambda _, done: with_points(done, change))


def _exchanged(series: Array) -> Array:
    return np.asarray(series[:, ::-1])


def _y_down(series: Array) -> Array:
    return np.asarray(series * np.array([1.0, -1.0]))


def _in_mm(series: Array) -> Array:
    return 1000.0 * series


def _centre_logged(scene: Scene, done: Run) -> Run:
    """The centre of gravity of the last link in the place of the pin at its end."""
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


def _other_midway(size: float) -> CellRunner:
    """The second half of the log is that of the other assembly, from a run of it."""

    def runner(scene: Scene, *args: Any, **options: Any) -> Run:
        one = in_scene(other_branch)(0.0)(scene, *args, **options)
        two = in_scene(other_branch)(size)(scene, *args, **options)
        half = len(moved(one).time_s) // 2
        pairs = {id(a): b for a, b in zip(_series(one), _series(two), strict=True)}
        return every_series(one, lambda a: np.concatenate([a[:half], pairs[id(a)][half:]]))

    return runner


def _series(done: Run) -> list[Array]:
    """Every logged series, in the order of the log."""
    motion = moved(done)
    bodies = [*motion.links.values(), *motion.points.values(), *motion.sliders.values()]
    return [series for body in bodies for series in vars(body).values()] + list(done.gaps.values())


_fault = partial(Fault, "misplaced")
FAULTS = (
    _fault(
        "columns-swapped",
        "two links in each other's place",
        "CC103",
        switched(_links_swapped),
        scenes=(FOURBAR,),
    ),
    _fault("xy-swapped", "x and y in each other's place", "CC113", _points(_exchanged)),
    _fault("y-down", "mirrored plane: y counted downwards", "CC113", _points(_y_down)),
    _fault("millimetres", "points in mm", "CC113", _points(_in_mm)),
    _fault(
        "centre-logged", "a centre of gravity in a pin's place", "CC113", switched(_centre_logged)
    ),
    _fault(
        "origin-off",
        "a displacement from another origin",
        "CC104",
        in_log(_displaced),
        1e-3,
        "L",
        scenes=(SLIDER,),
    ),
    _fault(
        "branch-midway",
        "the other assembly from mid-turn on",
        "CC101",
        _other_midway,
        says=("left its branch",),
    ),
)
