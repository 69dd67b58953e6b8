"""Errors of pymunk by the step: of pins that are closed for the arcs of their points, and of a
motor in a pin of two moving links."""

from __future__ import annotations

import math

import numpy as np
import pytest

from analytic.kinematics import solve
from models.files import load_scene
from sim.engine import Settings
from sim.run import run


def off(name: str, dt_s: float, paths: str) -> float:
    """How far pins are open, over the longest link, after the first steps of half a second."""
    scene = load_scene(name)
    start = solve(scene, np.zeros(1)).state()
    steps = round(0.5 / dt_s)
    own: Settings = {"free_paths": paths}
    done = run(scene, start, "pymunk", "tuned", dt_s=dt_s, steps=steps, drive="free", settings=own)
    assert done.status == "ok", done.reason
    return max(float(np.max(gap[8:])) for gap in done.gaps.values()) / scene.longest_m


@pytest.mark.parametrize("name", ["fourbar-swing", "slider-crank-spring"])
def test_pins_are_open_by_a_cube_of_the_step_where_chords_leave_a_square(name: str) -> None:
    arcs, chords = ([off(name, dt, paths) for dt in (2e-3, 1e-3)] for paths in ("arcs", "chords"))
    assert math.log2(arcs[0] / arcs[1]) > 2.7
    assert math.log2(chords[0] / chords[1]) == pytest.approx(2.0, abs=0.2)
    assert arcs[1] < 0.1 * chords[1]


@pytest.mark.parametrize(("profile", "order"), [("as-shipped", 1.0), ("tuned", 2.0)])
def test_a_driven_pin_of_two_moving_links_converges_as_its_profile_does(
    profile: str, order: float
) -> None:
    scene = load_scene("fourbar-by-coupler")
    start = solve(scene, np.zeros(1)).state()
    errors = []
    for steps in (720, 2880):
        dt_s = scene.driver.law.period_s / steps
        done = run(scene, start, "pymunk", profile, dt_s=dt_s, steps=2 * steps)
        assert done.status == "ok", done.reason
        true = solve(scene, done.motion.time_s, bound=False).links["rocker"].theta
        errors.append(float(np.max(np.abs(done.motion.links["rocker"].theta - true))))
    assert errors[0] < 1e-2
    assert math.log2(errors[0] / errors[-1]) / 2.0 == pytest.approx(order, abs=0.1)
