"""The last turn of a run, with what it was off by."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from models.scene import Scene
from reports.compare.beside import Beside, Truth
from reports.compare.compare import compare
from reports.compare.last_turn import trace
from sim.engine import Poses, Run

Disturbed = Callable[..., Run]


def off_by(link: str, angle_rad: float) -> Callable[[Poses], Poses]:
    def disturb(poses: Poses) -> Poses:
        moved = replace(poses.bodies[link], theta=poses.bodies[link].theta + angle_rad)
        return replace(poses, bodies={**poses.bodies, link: moved})

    return disturb


@pytest.mark.parametrize("steps", [720, 1440])
def test_it_is_the_last_turn_at_equal_parts(
    fourbar: Scene, disturbed: Disturbed, steps: int
) -> None:
    found = trace(Truth(fourbar, bound=False), disturbed(fourbar, steps=steps))
    assert found["time_s"].size == 91
    turns = np.diff(found["driver_rad"]) * 90 / math.tau
    np.testing.assert_allclose(turns, 1.0, rtol=1e-12)
    assert found["time_s"][-1] == pytest.approx(steps / 720 * fourbar.driver.law.period_s)


def test_an_error_keeps_its_sign(fourbar: Scene, disturbed: Disturbed) -> None:
    found = trace(Truth(fourbar, bound=False), disturbed(fourbar, off_by("rocker", -1e-3)))
    np.testing.assert_allclose(found["angle.rocker"], -1e-3, rtol=1e-6)
    np.testing.assert_allclose(found["angle.coupler"], 0.0, atol=1e-12)
    np.testing.assert_allclose(found["drive"], 0.0, atol=1e-12)


def test_a_late_crank_is_drive_and_not_geometry(fourbar: Scene, disturbed: Disturbed) -> None:
    found = trace(Truth(fourbar, bound=False), disturbed(fourbar, off_by("crank", 1e-3)))
    np.testing.assert_allclose(found["drive"], 1e-3, rtol=1e-9)
    assert np.max(np.abs(found["angle.rocker"])) < 1e-12
    assert np.max(np.abs(found["geometric.angle.rocker"])) > 1e-4


def test_its_largest_errors_are_no_larger_than_those_of_the_whole_run(
    fourbar: Scene, disturbed: Disturbed
) -> None:
    run = disturbed(fourbar, off_by("rocker", 2e-3))
    errors = compare(Beside.of(Truth(fourbar), run))
    worst = errors.worst("gap")
    assert 0.0 < np.max(trace(Truth(fourbar, bound=False), run)["gap"]) <= worst.maximum


def test_a_run_cut_short_gives_what_there_is(fourbar: Scene, disturbed: Disturbed) -> None:
    found = trace(Truth(fourbar, bound=False), disturbed(fourbar, steps=100))
    assert 10 <= found["time_s"].size <= 14
    assert found["time_s"][0] == 0.0


def test_a_run_that_logged_nothing_gives_nothing(fourbar: Scene, disturbed: Disturbed) -> None:
    assert trace(Truth(fourbar, bound=False), replace(disturbed(fourbar), motion=None)) == {}
