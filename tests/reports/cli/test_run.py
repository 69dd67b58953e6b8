"""`crankcheck run`, the log of a run in a file or in short on the terminal, and `recipe`."""

from __future__ import annotations

import re
import shlex
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from analytic.kinematics import solve
from models.files import load_scene
from models.scene_text import scene_text
from sim.run import run
from tests.worlds.command_line import crank, refused

READERS = {".csv": pd.read_csv, ".parquet": pd.read_parquet, ".xlsx": pd.read_excel}
COARSE = ["--steps-per-turn", "90", "--turns", "1"]


@pytest.mark.parametrize("ending", READERS)
def test_the_log_holds_every_digit_of_the_run(tmp_path: Path, ending: str) -> None:
    path = tmp_path / f"log{ending}"
    result = crank("run", "slotted-lever", "--engine", "pymunk", *COARSE, "-o", str(path))
    assert result.exit_code == 0, result.output
    frame = READERS[ending](path)
    scene = load_scene("slotted-lever")
    state = solve(scene, np.zeros(1)).state()
    done = run(scene, state, "pymunk", dt_s=scene.driver.law.period_s / 90, steps=90)
    assert done.motion is not None
    for name, series in {
        "time_s": done.motion.time_s,
        "velocity_time_s": done.velocity_time_s,
        "lever_theta_rad": done.motion.links["lever"].theta,
        "E_vy_m_s": done.motion.points["E"].velocity[:, 1],
        "B_slider_displacement_m": done.motion.sliders["B"].displacement,
        "B_gap_m": done.gaps["B"],
    }.items():
        np.testing.assert_array_equal(frame[name], series, err_msg=name)
    assert not [name for name in frame if "alpha" in name]


def test_what_it_tells_to_do_next_judges_the_log(tmp_path: Path) -> None:
    path = tmp_path / "my log.csv"
    result = crank("run", "fourbar-lecture-1", *COARSE, "--every", "2", "-o", str(path))
    assert result.output.startswith(f"{path}: 46 samples of fourbar-lecture-1 in mujoco ")
    assert "ended ok at t = 0.628319 s; pins open by at most " in result.output
    (command,) = re.findall(r"next: crankcheck (.*)", result.output)
    judged = crank(*shlex.split(command))
    assert judged.exit_code == 0
    assert "WITHIN TOLERANCE" in judged.output


def test_what_is_let_go_has_its_length_in_seconds_and_is_judged(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    told = crank("run", "fourbar-swing", "--duration", "0.2", "-o", str(path))
    (command,) = re.findall(r"next: crankcheck (.*)", told.output)
    judged = crank(*shlex.split(command))
    assert judged.exit_code == 0, judged.output
    assert "WITHIN TOLERANCE" in judged.output
    shown = crank("run", "slider-crank-central", "--drive", "free", "--duration", "0.2")
    assert "dt 0.001 s, 200 steps, 0.2 s" in shown.output
    assert "turn" not in shown.output


def test_the_log_of_a_driven_scene_that_was_let_go_is_judged_as_such(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    free = ["--drive", "free", "--duration", "0.2"]
    told = crank("run", "slider-crank-central", *free, "-o", str(path))
    (command,) = re.findall(r"next: crankcheck (.*)", told.output)
    assert command.endswith("--free")
    assert crank(*shlex.split(command)).exit_code == 0


def test_without_a_file_it_shows_some_samples_and_what_came_of_the_run() -> None:
    result = crank("run", "shaper", *COARSE, "--profile", "as-shipped")
    assert result.exit_code == 0
    assert "shaper: mujoco" in result.output
    assert "13 of 91 logged samples" in result.output
    assert "ended ok at t = 0.628319 s" in result.output


def test_a_run_that_came_apart_is_written_as_far_as_it_went(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("sim.run.RUNAWAY", 0.5)
    path = tmp_path / "log.csv"
    result = crank("run", "fourbar-lecture-1", *COARSE, "-o", str(path))
    assert result.exit_code == 1
    assert "ended diverged at t = " in result.output
    assert 1 <= len(pd.read_csv(path)) < 91


def test_what_an_engine_can_not_hold_is_told_and_nothing_written(tmp_path: Path) -> None:
    fourbar = load_scene("fourbar-lecture-1")
    links = {
        name: replace(link, mass_kg=0.0, inertia_kg_m2=0.0) for name, link in fourbar.links.items()
    }
    scene, log = tmp_path / "bare.toml", tmp_path / "log.csv"
    scene.write_text(scene_text(replace(fourbar, links=links)), encoding="utf-8")
    result = crank("run", str(scene), *COARSE, "-o", str(log))
    assert result.exit_code == 2
    assert "fourbar-lecture-1, mujoco: unsupported: " in result.output
    assert not log.exists()


def test_a_log_of_the_start_alone_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    result = crank("run", "fourbar-lecture-1", *COARSE, "--every", "91", "-o", str(path))
    refused(result, "--every 91: the run of fourbar-lecture-1 has 90 steps")
    assert not path.exists()
    result = crank("run", "fourbar-lecture-1", *COARSE, "--every", "90", "-o", str(path))
    assert result.exit_code == 0


def test_the_program_of_a_recipe_is_shown_or_written(tmp_path: Path) -> None:
    shown = crank("recipe", "forces", "--engine", "mujoco")
    assert shown.exit_code == 0
    compile(shown.stdout, "shown", "exec")
    path = tmp_path / "forces.py"
    told = crank("recipe", "forces", "--engine", "mujoco", "-o", path)
    assert told.exit_code == 0
    assert path.read_text(encoding="utf-8") == shown.stdout
