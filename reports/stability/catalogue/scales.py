"""The same four-bar small and large, far from the origin, and turned."""

from __future__ import annotations

import math
from collections.abc import Callable

from analytic.check.moved_scene import moved, rotated, scaled
from models.files import load_scene
from reports.stability.case import Case, Scale, Trial

GROUP = "scale, place and direction"
SOURCE = "fourbar-lecture-1"
LONGEST_M = 0.3
TRUTH = "closed form; a mechanism does not know where it stands, nor how large it is"
EXPECTED = "the same error as a pure number"


def _sized(value: float) -> Trial:
    scene = load_scene(SOURCE)
    return Trial(scaled(scene, value / LONGEST_M))


def _offset(value: float) -> Trial:
    scene = load_scene(SOURCE)
    return Trial(moved(scene, (value * scene.longest_m, -0.7 * value * scene.longest_m)))


def _turned(value: float) -> Trial:
    return Trial(rotated(load_scene(SOURCE), math.radians(value)))


def _case(
    name: str,
    title: str,
    parameter: str,
    unit: str,
    values: tuple[float, ...],
    trial: Callable[[float], Trial],
    scale: Scale = "log",
) -> Case:
    return Case(
        name=name,
        group=GROUP,
        title=title,
        source=SOURCE,
        truth=TRUTH,
        expected=EXPECTED,
        parameter=parameter,
        unit=unit,
        values=values,
        trial=trial,
        scale=scale,
    )


SMALL, LARGE = (1.0, 0.1, 1e-2, 1e-3, 1e-4), (1.0, 10.0, 100.0, 1e3, 1e4)
FAR = (1.0, 1e3, 1e6, 1e8, 1e10)
ANGLES = (0.0, 30.0, 45.0, 90.0, 137.0, 180.0, 270.0)
CASES = (
    _case("small", "Smaller and smaller", "longest link", "m", SMALL, _sized),
    _case("large", "Larger and larger", "longest link", "m", LARGE, _sized),
    _case("far-away", "Far from the origin", "distance over the longest link", "", FAR, _offset),
    _case("turned", "The plane turned", "angle", "deg", ANGLES, _turned, "linear"),
)
