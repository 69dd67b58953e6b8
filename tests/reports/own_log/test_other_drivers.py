"""Logs of mechanisms with triads, and of those that another joint than a crank drives."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from typer.testing import Result

from analytic.kinematics import solve
from models.files import load_scene
from models.scene import Scene
from reports.describe.frame import motion_frame
from reports.describe.with_forces import with_forces
from tests.worlds.command_line import crank, flat
from tests.worlds.tiers import few, slowly


def judged(path: Path, scene: Scene, of: Scene, *options: str, kept: str = "") -> Result:
    """The motion of a scene, judged as a log of another one; of its columns those with times, and
    those whose names end so."""
    time_s = np.linspace(0.0, of.driver.law.period_s, 200)
    log, frame = path / "log.csv", motion_frame(with_forces(of, solve(of, time_s)))
    frame[[c for c in frame if c == "time_s" or c.endswith(kept)]].to_csv(log, index=False)
    return crank("judge", scene.name, log, "--target", "1e-6", *options)


@pytest.mark.parametrize(
    "kept", ["_theta_rad", slowly("", reason="a second, with the places, rates and forces of all")]
)
def test_another_assembly_of_a_triad_is_told_by_its_number(kept: str, tmp_path: Path) -> None:
    scene = load_scene("triad-platform")
    told = judged(tmp_path, scene, replace(scene, branch={"plate": 2}), kept=kept)
    assert told.exit_code == 1
    assert "the log is of another assembly at plate" in flat(told.output)
    assert "plate = 2 under [branch]" in flat(told.output)


OTHERS = ["slider-crank-by-piston", "fourbar-by-coupler", "triad-slider"]


@pytest.mark.parametrize("name", few(OTHERS, OTHERS[:1], "other joints that drive, the same log"))
def test_a_log_of_the_truth_is_within_with_its_forces(tmp_path: Path, name: str) -> None:
    scene = load_scene(name)
    told = judged(tmp_path, scene, scene, "--forces", "--require", "torque")
    assert told.exit_code == 0, told.output


@pytest.mark.parametrize("drive", ["fitted", "logged"])
def test_a_drive_is_fitted_to_cranks_alone(tmp_path: Path, drive: str) -> None:
    scene = load_scene("slider-crank-by-piston")
    told = judged(tmp_path, scene, scene, "--drive", drive)
    assert told.exit_code == 2
    assert "this scene's is slider C" in flat(told.output)
