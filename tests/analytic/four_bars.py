"""The four-bar A B C D of any lengths."""

from __future__ import annotations

from models.files import parse_scene
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
