"""A flywheel that was worked out does in an engine what it was worked out for."""

import math

import numpy as np
import pytest

from analytic.lectures.regulation.flywheel import wanted_flywheel
from analytic.lectures.regulation.steady_cycle import cycle_scene
from analytic.lectures.regulation.turning_machine import TurningMachine
from models.files.reading import load_scene
from tests.worlds.runs import ran


def test_an_engine_runs_the_cycle_that_the_flywheel_is_for() -> None:
    """The drive a constant torque, two cycles: nothing settles, so that the second is as the
    first. Some 2 s, as loads that hang on the angle are asked for at every stage of a step."""
    cycle = wanted_flywheel(TurningMachine.of(load_scene("engine-four-stroke")), 0.02).cycle
    scene = cycle_scene(cycle, 2.05)
    link = ran(scene, "mujoco", per_turn=1400, drive="free").motion.links[scene.driver.link]
    turned, whole = np.abs(link.theta - link.theta[0]), cycle.machine.cycle_rad
    assert math.floor(turned[-1] / whole) == 2
    for k in range(2):
        inside = (turned >= k * whole) & (turned <= (k + 1) * whole)
        speed, theta = np.abs(link.omega[inside]), link.theta[inside]
        high, low = speed.max(), speed.min()
        assert 2.0 * (high - low) / (high + low) == pytest.approx(0.02, rel=0.01)
        for at, u in ((speed.argmax(), cycle.fastest), (speed.argmin(), cycle.slowest)):
            off = math.remainder(theta[at] - cycle.driver_rad(u), whole)
            assert abs(math.degrees(off)) < 0.5
