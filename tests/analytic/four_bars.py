"""The four-bar A B C D of any lengths, and random ones."""

import math
from collections.abc import Iterator

import numpy as np

from analytic.mechanism.fourbar import FourBar
from models.files.reading import parse_scene
from models.scene import Scene

TEXT = """
name = "four-bar"
source = "test"
ground.points = {{ A = [0.0, 0.0], D = [{ground!r}, 0.0] }}
links.crank = {{ bar = ["A", "B"], length_m = {crank!r} }}
links.coupler = {{ bar = ["B", "C"], length_m = {coupler!r} }}
links.rocker = {{ bar = ["D", "C"], length_m = {rocker!r} }}
driver = {{ {driver}, speed_rad_s = {speed!r}, start_deg = {start_deg!r} }}
branch.C = {branch}
"""


def fourbar(
    crank: float, coupler: float, rocker: float, ground: float, branch: int = 1, *,
    driver: str = 'link = "crank"', start_deg: float = 0.0, speed: float = 1.0,
) -> Scene:  # fmt: skip
    return parse_scene(TEXT.format(**locals()), "test")


def rocker_limits_rad(a: float, b: float, c: float, d: float) -> tuple[float, float]:
    """The rocker's angles against DA with crank and coupler in line, by the law of cosines."""
    near, far = (math.acos((c**2 + d**2 - x**2) / (2.0 * c * d)) for x in (b - a, b + a))
    return near, far


def time_ratio(a: float, b: float, c: float, d: float) -> float:
    """Slower over quicker stroke of a crank-rocker, by the crank's angles at these limits."""
    over, along = (math.acos((d**2 + x**2 - c**2) / (2.0 * d * x)) for x in (b - a, b + a))
    return (math.pi + abs(over - along)) / (math.pi - abs(over - along))


def random_bars(seed: int, count: int, margin_m: float) -> Iterator[FourBar]:
    """Those of so many draws that can be assembled and are no nearer to a change point."""
    for lengths in np.random.default_rng(seed).uniform(0.2, 1.0, (count, 4)).tolist():
        if 2.0 * max(lengths) <= sum(lengths) and abs(FourBar(*lengths).excess_m) >= margin_m:
            yield FourBar(*lengths)
