"""`fit`: what is printed of the lengths of a log, and its exit code."""

import json
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from analytic.gradients.dimensions import dimension
from analytic.kinematics import solve_driven
from models.files.reading import load_scene
from tests.analytic.gradients.test_length_fit import REAL, logged
from tests.worlds.command_line import crank_alone


@pytest.fixture
def log(tmp_path: Path) -> Path:
    drive, rocker = logged(REAL, "rocker", 1)
    columns = {"crank_deg": np.degrees(drive), "rocker_deg": np.degrees(rocker)}
    path = tmp_path / "log.csv"
    pd.DataFrame({"time_s": np.linspace(0.0, 2.0, drive.size), **columns}).to_csv(path, index=False)
    return path


def test_angles_give_ratios_and_a_given_length_all_of_them(log: Path, tmp_path: Path) -> None:
    ratios = crank_alone("fit", "fourbar-lecture-1", str(log))
    assert ratios.exit_code == 0
    assert "of ground" in ratios.stdout
    assert "Angles determine ratios of lengths alone: each is over ground." in ratios.stdout
    assert "residuals of 0.1" in ratios.stdout
    written = tmp_path / "real.toml"
    line = ("--given", "ground=0.6", "--json", "--write", str(written))
    document = json.loads(crank_alone("fit", "fourbar-lecture-1", str(log), *line).stdout)
    assert document["determined"] == "lengths"
    assert document["explained"]
    crank = document["dimensions"][0]
    assert crank["fitted"] == pytest.approx(200.0, abs=4.0 * crank["deviation"])
    real = dimension(load_scene(str(written)), "crank").value
    assert real == pytest.approx(crank["fitted"] * 1e-3)


def test_a_log_that_no_lengths_explain_and_less_noise_than_there_is_end_with_1(
    log: Path, tmp_path: Path
) -> None:
    quiet = crank_alone("fit", "fourbar-lecture-1", str(log), "--noise-deg", "0.05")
    assert quiet.exit_code == 1
    assert crank_alone("fit", "fourbar-lecture-1", str(log), "--noise-deg", "0.12").exit_code == 0
    drive, lever = logged(load_scene("sixbar-watt"), "lever", 1)
    other = tmp_path / "other.csv"
    pd.DataFrame({"crank_rad": drive, "rocker_rad": lever}).to_csv(other, index=False)
    answer = crank_alone("fit", "fourbar-lecture-1", str(other))
    assert answer.exit_code == 1
    assert "NOT EXPLAINED" in answer.stdout


def test_faulty_requests_end_with_2(log: Path, tmp_path: Path) -> None:
    alone = tmp_path / "alone.csv"
    pd.DataFrame({"time_s": [0.0, 0.1], "crank_rad": [0.0, 0.1]}).to_csv(alone, index=False)
    for line, words in (
        ((str(log), "--given", "ground=long"), "write a dimension and its value"),
        ((str(log), "--noise-deg", "0"), "--noise-deg: found 0"),
        ((str(log), "--given", "grund"), "did you mean ground"),
        ((str(alone),), "no angle and no place beside that of crank"),
    ):
        answer = crank_alone("fit", "fourbar-lecture-1", *line)
        assert answer.exit_code == 2
        assert words in " ".join(answer.stderr.split())


def test_an_engine_ends_where_the_reference_does(tmp_path: Path) -> None:
    theta = np.linspace(0.3, 0.3 + 0.5 * np.pi, 7)
    motion = solve_driven(REAL, theta, np.ones(1), np.zeros(1), bound=False)
    columns = {"crank_rad": theta, "rocker_rad": motion.links["rocker"].theta}
    log = tmp_path / "exact.csv"
    pd.DataFrame(columns).to_csv(log, index=False)
    line = ("--engine", "mujoco", "--profile", "tuned", "--by", "rocker")
    line += ("--steps-per-turn", "24")
    shown = crank_alone("fit", "fourbar-lecture-1", str(log), *line)
    assert shown.exit_code == 0
    assert "mujoco tuned" in shown.stdout
    document = json.loads(crank_alone("fit", "fourbar-lecture-1", str(log), *line, "--json").stdout)
    reference, engine = document["by_source"]
    for own, other in zip(reference["dimensions"], engine["dimensions"], strict=True):
        assert own["fitted"] == pytest.approx(own["scene"], rel=1e-9)
        assert 1e-8 < abs(other["fitted"] / own["fitted"] - 1.0) < 3e-2


def test_rows_of_one_step_are_fitted_as_others(tmp_path: Path) -> None:
    theta = np.linspace(0.3, 0.9, 40)  # ten rows of each step of the engine
    motion = solve_driven(REAL, theta, np.ones(1), np.zeros(1), bound=False)
    log = tmp_path / "sparse.csv"
    columns = {"crank_rad": theta, "rocker_rad": motion.links["rocker"].theta}
    pd.DataFrame(columns).to_csv(log, index=False)
    line = ("fit", "fourbar-lecture-1", str(log), "--by", "rocker", "--steps-per-turn", "24")
    answer = crank_alone(*line, "--engine", "mujoco", "--json")
    reference, own = json.loads(answer.stdout)["by_source"]
    fitted = [one["dimensions"][0]["fitted"] for one in (reference, own)]
    assert fitted[1] == pytest.approx(fitted[0], rel=0.05)
    refused = crank_alone(*line)
    assert (refused.exit_code, refused.stderr.count("name an --engine")) == (2, 1)


def test_an_engine_needs_a_driver_that_turns_one_way(tmp_path: Path) -> None:
    theta = 1.0 + 0.5 * np.sin(np.linspace(0.0, 6.0, 60))
    log = tmp_path / "swings.csv"
    pd.DataFrame({"crank_rad": theta, "rocker_rad": theta}).to_csv(log, index=False)
    answer = crank_alone("fit", "fourbar-lecture-1", str(log), "--engine", "mujoco")
    assert answer.exit_code == 2
    assert "a link as driver that turns one way" in " ".join(answer.stderr.split())
