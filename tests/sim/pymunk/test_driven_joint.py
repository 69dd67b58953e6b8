"""A motor in a pin of two moving links: it keeps to its law, and the joints stay together."""

from __future__ import annotations

import math

import numpy as np
import pytest

from analytic.kinematics import solve
from models.files import load_scene
from sim.run import run


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
