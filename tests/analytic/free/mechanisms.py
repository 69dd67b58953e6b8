"""Scenes of free motion for the tests, each integrated once."""

import pickle
from functools import cache

from analytic.free.free_motion import FreeMotion
from analytic.free.release import release
from models.scene import Scene, as_bytes
from tests.analytic.multibody.scenes import scene


def released(mechanism: Scene, until_s: float) -> FreeMotion:
    """Its free motion, integrated once for all tests."""
    return _released(as_bytes(mechanism), until_s)


@cache
def _released(pickled: bytes, until_s: float) -> FreeMotion:
    return release(pickle.loads(pickled), until_s)


def _driver(start_deg: float = 0.0, speed_rad_s: float = 0.0) -> str:
    start = f"start_deg = {start_deg}, speed_rad_s = {speed_rad_s}"
    return f'driver = {{ link = "crank", law = "free", {start}, duration_s = 10.0 }}'


def fourbar(
    a: float = 0.1, b: float = 0.25, c: float = 0.2, d: float = 0.3, branch: int = 1, **start: float
) -> Scene:
    """A four-bar of rods; by default the lecture's, released from rest a right angle above the
    bottom."""
    return scene(f"""
ground = {{ points = {{ A = [0.0, 0.0], D = [{d}, 0.0] }} }}
{_driver(**start)}
branch = {{ C = {branch} }}
[links]
crank = {{ bar = ["A", "B"], length_m = {a} }}
coupler = {{ bar = ["B", "C"], length_m = {b} }}
rocker = {{ bar = ["D", "C"], length_m = {c} }}
""")


def past_limits(**start: float) -> Scene:
    """No link of it turns fully: the driver swings between two limits."""
    return fourbar(0.2, 0.2, 0.25, 0.4, **{"start_deg": 60.0, **start})


def slider_crank(r: float = 0.1, rod: float = 0.3, offset: float = 0.02, **start: float) -> Scene:
    return scene(f"""
ground = {{ points = {{ A = [0.0, 0.0] }} }}
{_driver(**{"start_deg": -70.0, **start})}
sliders = {{ C = {{ on = "ground", through_m = [0.0, {offset}], mass_kg = 1 }} }}
[links]
crank = {{ bar = ["A", "B"], length_m = {r} }}
rod = {{ bar = ["B", "C"], length_m = {rod} }}
""")
