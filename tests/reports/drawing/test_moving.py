"""What a drawing holds: the reference, and errors small enough to be magnified."""

from __future__ import annotations

import base64
import math

import numpy as np
import pytest

from analytic.kinematics import solve
from models.array import Array
from models.files import load_scene
from models.scene import Scene
from reports.drawing.moving import displacements, drawing, instants, moving_points

SCENES = ("fourbar-lecture-1", "slider-crank-offset", "shaper", "scotch-yoke", "sixbar-stephenson")


def unpacked(packed: dict[str, object]) -> Array:
    """Rows as the page reads them."""
    whole = np.frombuffer(base64.b64decode(str(packed["base64"])), "<i2")
    rows = whole.reshape(len(np.asarray(packed["scales"])), -1).astype(np.float64)
    rows[rows == -32768] = np.nan
    return rows * np.asarray(packed["scales"])[:, None]


def traced(
    scene: Scene, time_s: Array, shift_m: float = 0.0, turn_rad: float = 0.0
) -> dict[str, Array]:
    """The trace of a run that is off the reference by a shift in x, and links by a turn."""
    motion = solve(scene, time_s, bound=False)
    found = {"time_s": time_s}
    for name, point in motion.points.items():
        found[f"x.{name}"], found[f"y.{name}"] = point.position.T
        found[f"x.{name}"] = found[f"x.{name}"] + shift_m
    for name, link in motion.links.items():
        found[f"theta.{name}"] = link.theta + turn_rad
    return found


@pytest.mark.parametrize("name", SCENES)
def test_the_reference_is_the_closed_form(name: str) -> None:
    scene = load_scene(name)
    time_s = instants(scene)
    drawn = drawing(scene, time_s)
    motion = solve(scene, time_s)
    rows = unpacked(drawn["places"])
    assert drawn["points"] == moving_points(scene)
    for i, point in enumerate(moving_points(scene)):
        exact = motion.points[point].position.T
        level = np.max(np.abs(exact)) / 32767
        np.testing.assert_allclose(rows[2 * i : 2 * i + 2], exact, atol=level)
    assert {p for link in drawn["links"] for p in link["points"]} <= {
        *drawn["points"],
        *drawn["ground"],
    }


@pytest.mark.parametrize("name", SCENES)
@pytest.mark.parametrize("shift_m", [1e-3, 1e-9])
def test_small_errors_are_kept_apart_from_large_places(name: str, shift_m: float) -> None:
    scene = load_scene(name)
    time_s = instants(scene)
    found = displacements(scene, traced(scene, time_s, shift_m, turn_rad=2e-8), time_s)
    assert found is not None
    rows = unpacked(found)
    points = len(moving_points(scene))
    np.testing.assert_allclose(rows[0 : 2 * points : 2], shift_m, rtol=1e-4)
    np.testing.assert_allclose(rows[1 : 2 * points : 2], 0.0, atol=1e-16)
    np.testing.assert_allclose(rows[2 * points :], 2e-8, rtol=1e-4)


def test_a_run_of_other_turns_is_shown_at_the_same_crank_angles() -> None:
    scene = load_scene("fourbar-lecture-1")
    period = scene.driver.law.period_s
    own = instants(scene, turns=4.0)
    trace = traced(scene, own)
    trace["x.C"] = trace["x.C"] + 1e-3 * np.sin(2 * np.pi * own / period)
    found = displacements(scene, trace, instants(scene, turns=2.0))
    assert found is not None
    row = unpacked(found)[2 * moving_points(scene).index("C")]
    wave = 1e-3 * np.sin(2 * np.pi * instants(scene) / period)
    np.testing.assert_allclose(row, wave, atol=1e-7)


def test_a_run_that_was_logged_in_part_is_drawn_in_part() -> None:
    scene = load_scene("fourbar-lecture-1")
    time_s = instants(scene)
    found = displacements(scene, traced(scene, time_s[:40], 1e-3), time_s)
    assert found is not None
    row = unpacked(found)[0]
    assert np.isfinite(row).sum() == 40


def test_a_run_that_has_come_apart_is_cut_off() -> None:
    scene = load_scene("fourbar-lecture-1")
    time_s = instants(scene)
    trace = traced(scene, time_s)
    trace["x.C"] = trace["x.C"] + np.linspace(0.0, 1e200, len(time_s))
    trace["y.C"] = np.full_like(time_s, math.nan)
    found = displacements(scene, trace, time_s)
    assert found is not None
    x, y = unpacked(found)[2 * moving_points(scene).index("C") :][:2]
    assert np.max(x) == pytest.approx(20 * scene.longest_m, rel=1e-4)
    assert np.isnan(y).all()


def test_a_trace_of_nothing_or_of_another_scene_is_not_drawn() -> None:
    scene = load_scene("fourbar-lecture-1")
    time_s = instants(scene)
    assert displacements(scene, {}, time_s) is None
    assert displacements(scene, {"time_s": time_s}, time_s) is None


def test_the_crank_starts_in_its_first_turn() -> None:
    scene = load_scene("fourbar-lecture-1")
    angles = np.asarray(drawing(scene, instants(scene, turns=3.0))["told"]["at"])
    assert angles[0] == pytest.approx(90.0)
    assert angles[-1] == pytest.approx(450.0)
