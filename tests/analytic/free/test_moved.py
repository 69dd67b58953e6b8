"""A mechanism that is let go turned, moved, mirrored, larger or faster moves as it did before."""

from __future__ import annotations

import math
from functools import cache

import numpy as np
import pytest

from analytic.free.free_motion import FreeMotion
from analytic.free.release import release
from models.files import load_scene, parse_scene
from models.scene import Scene
from tests.worlds.let_go import EVERYTHING
from tests.worlds.other_way import MOVES, faster
from tests.worlds.tiers import slowly

SAMPLES = 25
ALLOWED = 1e-9
"""Times the sensitivity, of a turn, of the longest link, and of their rates: each scene is
integrated by itself, with roundings of its own."""
SCENES: dict[str, tuple[Scene, float, float]] = {
    "everything that acts": (parse_scene(EVERYTHING, "everything"), 0.3, 0.8),
    "swing": (load_scene("fourbar-swing"), 0.5, 1.0),
    "limits": (load_scene("fourbar-double-rocker-swing"), 0.45, 1.0),
}
"""Let go for a short and for a longer time [s]."""


CHANGES = MOVES | {"faster": faster(5.0)}


@cache
def let_go(name: str, until_s: float) -> FreeMotion:
    """The motion that every change of a scene is held to."""
    return release(SCENES[name][0], until_s)


@pytest.mark.parametrize(
    ("name", "change", "until_s"),
    [
        *(
            (name, change, short_s)
            for name, (_, short_s, _) in SCENES.items()
            for change in (CHANGES if name == "everything that acts" else ["mirrored"])
        ),
        *(
            slowly(name, change, long_s, reason="roundings that grow with time")
            for name, (_, _, long_s) in SCENES.items()
            for change in CHANGES
        ),
    ],
)
def test_the_free_motion_of_the_moved_scene_is_the_moved_motion(
    name: str, change: str, until_s: float
) -> None:
    scene, by = SCENES[name][0], CHANGES[change]
    own, other = let_go(name, until_s), release(by.of(scene), until_s / by.fast)
    time_s = np.linspace(0.0, until_s, SAMPLES)
    old, new = own.at(time_s, bound=False), other.at(time_s / by.fast, bound=False)
    off = ALLOWED * own.sensitivity(time_s)
    fastest = max(1.0, own.peak_speed_rad_s)
    for link, was in old.links.items():
        now = new.links[link]
        apart = now.theta - by.side * was.theta - by.turn_rad
        assert np.all(np.abs(apart - math.tau * np.round(apart[0] / math.tau)) <= off)
        assert np.all(np.abs(now.omega / by.fast - by.side * was.omega) <= 10.0 * fastest * off)
    for point, place in old.points.items():
        wanted = by.grow * by.turned(place.position) + by.shift_m
        assert np.all(
            np.hypot(*(new.points[point].position - wanted).T)
            <= off * (by.grow * scene.longest_m + np.hypot(*by.shift_m))
        )
    energy, again = own.energy(time_s), other.energy(time_s / by.fast)
    gain = by.grow**3 * by.fast**2  # masses grow with lengths, and speeds too
    largest = float(np.max(energy.kinetic))
    assert np.all(np.abs(again.kinetic / gain - energy.kinetic) <= 10.0 * largest * off)
    assert np.all(np.abs(again.work / gain - energy.work) <= 10.0 * largest * off)
