"""A limit of the driver's angle: out to where it is no longer what is counted from, and beside the
chart of another limit."""

from __future__ import annotations

import numpy as np
import pytest

from analytic.free.doubt import _moved
from analytic.free.limit_position import REACH
from analytic.free.machine_motion import MachineMotion
from analytic.free.release import release
from models.files import parse_scene
from tests.analytic.free.mechanisms import fourbar, past_limits, released


@pytest.mark.parametrize("k", [2, 10])
def test_a_limit_reaches_as_far_as_it_says_whatever_rounding_does(k: int) -> None:
    """With these lengths the square of the root of the reach is larger than the reach. Runs are
    looked for out to there, and had no geometry at all."""
    scene = fourbar(0.2 + 0.0031 * k, 0.2, 0.25, 0.41 + 0.0017 * k, start_deg=60.0)
    motion = release(scene, 0.02)
    assert isinstance(motion, MachineMotion)
    chart = motion.history.windows[0].chart
    most = REACH * chart.limit.length_rad
    u = np.array([np.sqrt(most)])
    assert u[0] * u[0] > most
    chart.unit(u)
    time_s = np.linspace(0.0, 0.02, 5)
    assert np.allclose(
        motion.beside(motion.at(time_s)).links["rocker"].theta,
        motion.at(time_s).links["rocker"].theta,
    )


OFFSET_SLOT = """
name = "offset-slot"
source = "a test"
[ground]
points = { A = [0.0, 0.0], C = [0.12, 0.0] }
[links]
crank = { bar = ["A", "B"], length_m = 0.1 }
[links.lever]
points = { C = [0.0, 0.0] }
mass_kg = 1.0
centre_m = [0.05, 0.02]
inertia_kg_m2 = 0.01
[sliders.B]
on = "lever"
through_m = [0.0, 0.05]
mass_kg = 0.1
[driver]
link = "crank"
law = "free"
start_deg = 90.0
speed_rad_s = -6.0
duration_s = 1.0
"""


def test_a_link_whose_points_are_the_same_in_both_assemblies_tells_them_apart() -> None:
    """A lever that turns about a fixed pivot has no other named point: by points alone both of its
    assemblies were as near, and runs in the second one were held to the first."""
    motion = release(parse_scene(OFFSET_SLOT, "offset-slot"), 1.0)
    assert motion.passages
    true = motion.at(np.linspace(0.0, 1.0, 41), bound=False)
    np.testing.assert_allclose(
        motion.beside(true).links["lever"].theta, true.links["lever"].theta, atol=1e-9
    )


def test_a_state_is_the_same_in_the_chart_of_another_limit() -> None:
    """Its acceleration too, so that no difference of that goes unseen where charts change."""
    free = released(past_limits(), 0.9)
    assert isinstance(free, MachineMotion)
    history = free.history
    changes = [first for _, first, _ in history.legs()][1:]
    assert changes
    for k in changes:
        before, after = history.windows[k - 1], history.windows[k]
        share = (before.end_s - before.start_s) / before.long_s
        left = np.array(history.at(np.array([k - 1]), np.array([share])))
        entered = np.array(history.at(np.array([k]), np.zeros(1)))
        moved = _moved(before.chart, after.chart, left, entered[0])
        assert moved[:, 0] == pytest.approx(entered[:, 0], rel=1e-9)
