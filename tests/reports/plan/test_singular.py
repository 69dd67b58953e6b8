"""Positions in which the motion is not determined are named, before any engine runs."""

from dataclasses import replace
from pathlib import Path

import pytest

from analytic.kinematics import reach
from models.errors import CrankcheckError
from models.files.reading import load_scene
from models.scene.laws import Oscillating
from reports.plan.singular import passage_note, refuse_singular
from tests.worlds.command_line import crank, edited, refused

RHOMBUS = (r"length_m = 0\.\d+", "length_m = 0.3")
NEARLY = (r"(crank = .*length_m = )0\.3", r"\g<1>0.2999999999999")
"""Not in a change point, and too near to one for any rates in double precision."""


@pytest.mark.parametrize("start", ["90.0", "90.137"])
def test_verify_refuses_a_run_through_a_singular_position_also_between_two_samples(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, start: str
) -> None:
    monkeypatch.setattr("reports.requests.verify.check_all", None)  # no engine may run
    turned = ("start_deg = 90.0", f"start_deg = {start}")
    path = edited(tmp_path, "fourbar-lecture-1", RHOMBUS, NEARLY, turned)
    words = ("fourbar-lecture-1", "driver 360 deg", "dyad of C", "not determined", "choose")
    refused(crank("verify", path, "--steps-per-turn", "360"), *words)


def test_a_run_that_ends_before_the_singular_position_or_passes_by_may_go(tmp_path: Path) -> None:
    scene = load_scene(edited(tmp_path, "fourbar-lecture-1", RHOMBUS, NEARLY))
    period = scene.driver.law.period_s
    refuse_singular(scene, 0.74 * period)
    with pytest.raises(CrankcheckError, match="driver 360 deg"):
        refuse_singular(scene, 0.76 * period)
    near = load_scene(
        edited(tmp_path, "slider-crank-excel-210", ("length_m = 2.1", "length_m = 2.0000001"))
    )
    refuse_singular(near, near.driver.law.period_s)


def test_a_swing_through_a_singular_position_or_to_a_limit_is_refused(tmp_path: Path) -> None:
    """The lines of the two blocks are parallel at 90 deg: the crossing runs to infinity."""
    scene = load_scene(
        edited(tmp_path, "tangent", ("amplitude_deg = 40.0", "amplitude_deg = 100.0"))
    )
    with pytest.raises(CrankcheckError, match="90 deg the dyad of P"):
        refuse_singular(scene, scene.driver.law.period_s)
    rocker = load_scene("fourbar-double-rocker")
    low, high = reach(rocker)[-1]
    swing = Oscillating(0.5 * (low + high), 0.5 * (high - low), 1.0)
    with pytest.raises(CrankcheckError, match="dyad of C is singular"):
        refuse_singular(replace(rocker, driver=replace(rocker.driver, law=swing)), swing.period_s)


def test_a_note_tells_only_what_is_passed_and_verify_has_it_once_and_runs(tmp_path: Path) -> None:
    path = edited(tmp_path, "fourbar-lecture-1", RHOMBUS)
    scene = load_scene(path)  # starts at 90 deg
    period = scene.driver.law.period_s
    assert passage_note(scene, 0.24 * period) == ""
    assert "of C at driver 180 deg;" in passage_note(scene, 0.26 * period)
    note = passage_note(scene, 3 * period)
    assert note.startswith("fourbar-lecture-1: passes the change points of C at driver 0, 180 deg;")
    assert "the reference continues the smooth branch" in note
    result = crank("verify", path, "--steps-per-turn", "90", "--engine", "mujoco")
    assert result.exit_code in (0, 1)
    assert result.stderr.count("passes the change points of C at driver 0, 180 deg") == 1


def test_solve_has_a_dash_for_the_rates_of_a_singular_position_and_names_it(tmp_path: Path) -> None:
    result = crank("solve", edited(tmp_path, "fourbar-lecture-1", RHOMBUS, NEARLY))
    assert result.exit_code == 0
    assert "singular at 360 deg (C)" in result.output
    assert "rates are not determined there" in result.output
    rows = [line.split() for line in result.output.splitlines() if "360" in line]
    assert any("-" in row for row in rows)
    assert result.stderr == ""


@pytest.mark.parametrize("args", [[], ["--at-deg", "180"]])
def test_solve_goes_through_a_change_point_and_says_so(tmp_path: Path, args: list[str]) -> None:
    result = crank("solve", edited(tmp_path, "fourbar-lecture-1", RHOMBUS), *args)
    assert result.exit_code == 0
    assert "continued smoothly through the change point" in result.output
    assert "singular at" not in result.output
    table = result.output.partition("theta")[2]
    assert "180" in table
    assert "-" not in table.split()
