"""Scenes of free motion for the tests."""

from __future__ import annotations

import pickle
from dataclasses import replace
from functools import cache

from analytic.free.free_motion import FreeMotion
from analytic.free.release import release
from models.files import parse_scene
from models.scene import Scene, as_bytes

FOURBAR = """
name = "{name}"
source = "test"
gravity_m_s2 = [0.0, -9.81]
[ground]
points = {{ A = [0.0, 0.0], D = [{d}, 0.0] }}
[links]
crank = {{ bar = ["A", "B"], length_m = {a} }}
coupler = {{ bar = ["B", "C"], length_m = {b} }}
rocker = {{ bar = ["D", "C"], length_m = {c} }}
[driver]
link = "crank"
law = "free"
start_deg = {start_deg}
speed_rad_s = {speed_rad_s}
duration_s = 10.0
[branch]
C = {branch}
"""
SLIDER_CRANK = """
name = "slider-crank"
source = "test"
gravity_m_s2 = [0.0, -9.81]
[ground]
points = {{ A = [0.0, 0.0] }}
[links]
crank = {{ bar = ["A", "B"], length_m = {r} }}
rod = {{ bar = ["B", "C"], length_m = {l} }}
[sliders]
C = {{ point = "C", on = "ground", through_m = [0.0, {offset}], direction_deg = 0, mass_kg = 1 }}
[driver]
link = "crank"
law = "free"
start_deg = {start_deg}
speed_rad_s = {speed_rad_s}
duration_s = 10.0
"""


def released(scene: Scene, until_s: float) -> FreeMotion:
    """Its free motion, integrated once for all tests."""
    return _released(as_bytes(scene), until_s)


@cache
def _released(pickled: bytes, until_s: float) -> FreeMotion:
    return release(pickle.loads(pickled), until_s)


def fourbar(
    a: float = 0.1,
    b: float = 0.25,
    c: float = 0.2,
    d: float = 0.3,
    *,
    start_deg: float = 0.0,
    speed_rad_s: float = 0.0,
    branch: int = 1,
) -> Scene:
    """A four-bar of rods; by default the lecture's, let go from rest a right angle above the
    bottom."""
    text = FOURBAR.format(
        name="fourbar", a=a, b=b, c=c, d=d,
        start_deg=start_deg, speed_rad_s=speed_rad_s, branch=branch,
    )  # fmt: skip
    return parse_scene(text, "fourbar")


def past_limits(**start: float) -> Scene:
    """No link of it turns fully: the driver swings between two limits."""
    return fourbar(0.2, 0.2, 0.25, 0.4, **{"start_deg": 60.0, **start})  # type: ignore[arg-type]


def slider_crank(
    r: float = 0.1,
    l: float = 0.3,  # noqa: E741
    offset: float = 0.02,
    *,
    start_deg: float = -70.0,
    speed_rad_s: float = 0.0,
) -> Scene:
    text = SLIDER_CRANK.format(
        r=r, l=l, offset=offset, start_deg=start_deg, speed_rad_s=speed_rad_s
    )
    return parse_scene(text, "slider-crank")


def weightless(scene: Scene) -> Scene:
    return replace(scene, gravity_m_s2=(0.0, 0.0))
