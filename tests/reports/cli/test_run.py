"""`crankcheck run`, the log of a run in a file or in short on the terminal, and `recipe`."""

import re
import shlex
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from analytic.kinematics import solve
from models.files.assemble import scene_text
from models.files.reading import load_scene
from sim.run import run
from tests.worlds.command_line import crank, refused, told
from tests.worlds.loading import massless

COARSE = "--steps-per-turn 90 --turns 1"
ONCE = f"run fourbar-lecture-1 {COARSE}"


def test_the_log_holds_every_digit_of_the_run(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    told(f"run slotted-lever --engine pymunk {COARSE} -o", path)
    frame = pd.read_csv(path)
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


def judged(output: str) -> str:
    """What comes of the command that a run tells to do next: its log is within."""
    (command,) = re.findall(r"next: crankcheck (.*)", output)
    result = crank(*shlex.split(command))
    assert result.exit_code == 0, result.output
    assert "WITHIN TOLERANCE" in result.output
    return str(command)


def test_what_it_tells_to_do_next_judges_the_log(tmp_path: Path) -> None:
    path = tmp_path / "my log.csv"
    output = told(f"{ONCE} --every 2 -o", path)
    assert output.startswith(f"{path}: 46 samples of fourbar-lecture-1 in mujoco ")
    assert "ended ok at t = 0.628319 s; pins open by at most " in output
    judged(output)


def test_what_is_let_go_has_its_length_in_seconds_and_is_judged_as_such(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    judged(told("run fourbar-swing --duration 0.2 -o", path))
    free = "run slider-crank-central --drive free --duration 0.2"
    assert judged(told(f"{free} -o", path)).endswith("--free")
    shown = told(free)
    assert "dt 0.001 s, 200 steps, 0.2 s" in shown
    assert "turn" not in shown


def test_a_run_that_came_apart_is_written_as_far_as_it_went(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("sim.run.RUNAWAY", 0.5)
    path = tmp_path / "log.csv"
    assert "ended diverged at t = " in told(f"{ONCE} -o", path, code=1)
    assert 1 <= len(pd.read_csv(path)) < 91


def test_what_an_engine_can_not_hold_is_told_and_nothing_written(tmp_path: Path) -> None:
    scene, log = tmp_path / "bare.toml", tmp_path / "log.csv"
    scene.write_text(scene_text(massless(load_scene("fourbar-lecture-1"))), encoding="utf-8")
    output = told(f"run {COARSE}", scene, "-o", log, code=2)
    assert "fourbar-lecture-1, mujoco: unsupported: " in output
    assert not log.exists()


def test_a_log_of_the_start_alone_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    result = crank(*ONCE.split(), "--every", "91", "-o", path)
    refused(result, "--every 91: the run of fourbar-lecture-1 has 90 steps")
    assert not path.exists()
    told(f"{ONCE} --every 90 -o", path)


def test_the_program_of_a_recipe_is_shown_or_written(tmp_path: Path) -> None:
    shown = told("recipe forces --engine mujoco")
    compile(shown, "shown", "exec")
    path = tmp_path / "forces.py"
    told("recipe forces --engine mujoco -o", path)
    assert path.read_text(encoding="utf-8") == shown
