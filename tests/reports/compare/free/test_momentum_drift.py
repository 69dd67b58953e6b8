"""The angular momentum of what is pinned at one point, and when it is kept."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from analytic.kinematics import solve_driven
from models.files import load_scene, parse_scene
from models.scene import Scene
from reports.compare.free.momentum_drift import kept_about, momentum

BAR = """
name = "bar"
source = "ours"
[ground]
points = { A = [0.1, 0.2] }
[links.rod]
bar = ["A", "B"]
length_m = 0.3
mass_kg = 2.0
[driver]
link = "rod"
law = "free"
start_deg = 20.0
speed_rad_s = 3.0
duration_s = 1.0
"""


@pytest.fixture(scope="module")
def rod() -> Scene:
    return parse_scene(BAR, "here")


def test_a_rod_has_that_of_its_inertia_about_its_pin(rod: Scene) -> None:
    time_s = np.linspace(0.0, 1.0, 5)
    motion = solve_driven(rod, 0.3 + 3.0 * time_s, np.full(5, 3.0), np.zeros(5), time_s)
    assert momentum(rod, motion, time_s, "A") == pytest.approx(2.0 * 0.3**2 / 3.0 * 3.0)
    late = momentum(rod, motion, time_s + 1e-4, "A")  # to the second order of the delay
    assert late == pytest.approx(0.18, rel=1e-6)


def test_it_is_kept_only_where_nothing_else_acts_from_outside(rod: Scene) -> None:
    assert kept_about(rod) == "A"
    assert kept_about(replace(rod, gravity_m_s2=(0.0, -9.81))) is None
    four = load_scene("fourbar-lecture-1")
    assert kept_about(four) is None
    assert not any(four.gravity_m_s2)
