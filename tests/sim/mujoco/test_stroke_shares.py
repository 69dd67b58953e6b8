"""Loads of one stroke in free motion: a step in which their slider turns back has its share."""

from __future__ import annotations

import numpy as np
import pytest

from analytic.free.release import release
from models.files import parse_scene
from sim.mujoco.stroke_shares import forward_share
from sim.run import run

TURNING = """
name = "turning"
source = "a test"
[ground]
points = { A = [0.0, 0.0] }
[links]
crank = { bar = ["A", "B"], length_m = 0.1 }
rod = { bar = ["B", "C"], length_m = 0.3 }
[sliders]
C = { on = "ground", mass_kg = 1.0 }
[driver]
link = "crank"
law = "free"
start_deg = -90.0
speed_rad_s = 2.0
duration_s = 0.8
[springs.back]
slider = "C"
rate_n_m = 200.0
free_m = 0.28
[loads.cut]
block = "C"
direction_deg = 180.0
stroke = "STROKE"
slider = "C"
force_n = 1.0
"""
LONG_S = 0.8


@pytest.mark.parametrize(
    ("speed", "change", "share"),
    [
        (2.0, 1.0, 1.0),
        (2.0, -8.0, 0.25),
        (-2.0, 8.0, 0.75),
        (-2.0, -1.0, 0.0),
        (0.0, 1.0, 1.0),
        (0.0, -1.0, 0.0),
        (0.0, 0.0, 0.0),
    ],
)
def test_a_step_that_turns_back_is_forward_until_its_speed_is_gone(
    speed: float, change: float, share: float
) -> None:
    assert forward_share(speed, change) == share


@pytest.mark.parametrize("stroke", ["forward", "backward"])
def test_steps_keep_their_order_where_a_slider_turns_back(stroke: str) -> None:
    """Three times in 0.8 s; with stages that looked at their own speed the error was 2e-4 rad at
    1e-3 s, and of first order."""
    scene = parse_scene(TURNING.replace("STROKE", stroke), "turning")
    motion = release(scene, LONG_S)
    start = motion.at(np.zeros(1)).state()
    off = []
    for dt_s in (2e-3, 5e-4):
        steps = round(LONG_S / dt_s)
        done = run(scene, start, "mujoco", dt_s=dt_s, steps=steps, drive="free")
        assert done.motion is not None
        true = motion.at(done.motion.time_s, bound=False).links["crank"].theta
        off.append(float(np.abs(done.motion.links["crank"].theta - true).max()))
    # Where in its step each turn comes is chance, so that the order shows in the bounds alone.
    assert off[0] < 2e-5
    assert off[1] < 1.25e-6
