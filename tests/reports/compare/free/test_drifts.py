"""Drifts of an energy and of an angular momentum, and the course of a free run in a store."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from analytic.kinematics import solve_driven
from models.files import load_scene, parse_scene
from models.scene import Scene
from reports.compare.free.energy_drift import drift, window_means, window_s
from reports.compare.free.momentum_drift import kept_about, momentum
from reports.store.reader import read_store
from tests.worlds.free_store import LASTS_S


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


def test_a_free_run_is_kept_from_its_start_to_its_end(free_store: Path) -> None:
    stored = read_store(free_store)
    for row in stored.cells.itertuples():
        trace = stored.trace(str(row.key))
        assert trace["time_s"][0] == 0.0
        assert trace["time_s"][-1] == pytest.approx(LASTS_S)
        assert {len(each) for each in trace.values()} == {len(trace["time_s"])}
        judged = np.max(np.abs(trace["phase"] / trace["growth"]))
        assert judged == pytest.approx(row.phase_pure, rel=0.05)
        assert trace["energy"][0] == 0.0


def test_means_over_windows_begin_and_end_with_those_of_the_drift() -> None:
    scene, time_s = load_scene("fourbar-swing"), np.linspace(0.0, 10.0, 1001)
    series = 0.1 * time_s + np.sin(7.0 * time_s)
    means = window_means(scene, time_s, series)
    known = means[np.isfinite(means)]
    over_s = window_s(scene, 10.0)
    assert known[-1] - known[0] == pytest.approx(drift(series, time_s, over_s), abs=0.02)
    assert np.isnan(means[0])
    assert np.isnan(means[-1])
