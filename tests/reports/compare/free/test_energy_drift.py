"""The drift of an energy: what comes and goes with the motion is none of it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from models.files import load_scene
from reports.compare.free.energy_drift import drift, window_s


def test_a_loss_that_goes_on_is_the_drift_and_an_offset_that_swings_is_none() -> None:
    time_s = np.linspace(0.0, 10.0, 10_001)
    swinging = 1e-3 * np.sin(2.0 * np.pi * time_s) ** 2
    losing = -1e-5 * time_s
    assert abs(drift(swinging, time_s, 1.0)) < 1e-8
    assert drift(swinging + losing, time_s, 1.0) == pytest.approx(-9e-5, rel=1e-2)


def test_a_window_is_a_tenth_of_the_run_or_a_swing_of_the_longest_link() -> None:
    scene = load_scene("fourbar-swing")
    assert window_s(scene, 100.0) == 10.0
    assert window_s(scene, 4.0) == pytest.approx(2.0 * np.pi * np.sqrt(0.25 / 9.81))
    assert window_s(scene, 0.5) == 0.25
    assert window_s(replace(scene, gravity_m_s2=(0.0, 0.0)), 4.0) == 0.4
