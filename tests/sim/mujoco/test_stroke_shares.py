"""Loads of one stroke in free motion: a step in which their slider turns back has its share."""

from __future__ import annotations

import numpy as np
import pytest

from analytic.free.release import release
from models.files import load_scene, parse_scene
from sim.mujoco.stroke_shares import forward_parts
from sim.run import run
from tests.worlds.tiers import slowly

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


@pytest.mark.parametrize("speed", [2.0, -2.0])
@pytest.mark.parametrize("share", [0.1, 0.5, 0.9])
def test_a_step_that_turns_back_keeps_impulse_and_lever(speed: float, share: float) -> None:
    """As Simpson's rule adds the parts up, to what is forward of 1, of time and of its square."""
    parts = np.array(forward_parts(speed, -speed / share))
    stages, weights = np.array([0.0, 0.5, 1.0]), np.array([1.0, 4.0, 1.0]) / 6.0
    for k in range(3):
        until = share ** (k + 1) / (k + 1)
        forward = until if speed > 0.0 else 1.0 / (k + 1) - until
        assert weights @ (parts * stages**k) == pytest.approx(forward, abs=1e-15)


@pytest.mark.parametrize(
    ("speed", "change", "whole"),
    [(2.0, 1.0, 1.0), (-2.0, -1.0, 0.0), (0.0, 1.0, 1.0), (0.0, -1.0, 0.0), (0.0, 0.0, 0.0)],
)
def test_a_step_that_does_not_turn_back_is_whole(speed: float, change: float, whole: float) -> None:
    assert forward_parts(speed, change) == (whole, whole, whole)


@pytest.mark.parametrize(
    "stroke", ["forward", slowly("backward", reason="the parts of a step are tested for both")]
)
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
        true = motion.at(done.motion.time_s, bound=False).links["crank"].theta
        off.append(float(np.abs(done.motion.links["crank"].theta - true).max()))
    # Where in its step each turn comes is chance, so that the order shows in the bounds alone.
    assert off[0] < 2e-5
    assert off[1] < 1.25e-6


@pytest.mark.parametrize(
    ("until_s", "within"),
    [(1.0, 5e-6), slowly(4.0, 1.5e-4, reason="its phase goes astray by and by: a second")],
)
def test_a_load_that_ends_at_a_dead_centre_costs_no_phase(until_s: float, within: float) -> None:
    """There it has no lever; with the same share in all stages of the step the error was 3e-4."""
    scene = load_scene("press-motor")
    motion = release(scene, until_s)
    start = motion.at(np.zeros(1)).state()
    steps = round(until_s / 1e-3)
    done = run(scene, start, "mujoco", dt_s=1e-3, steps=steps, every=steps, drive="free")
    true = motion.at(done.motion.time_s, bound=False).links["crank"].theta
    assert abs(done.motion.links["crank"].theta[-1] - true[-1]) < within
