"""Positions in which the motion is not determined are named, before any engine runs."""

from __future__ import annotations

import re
import warnings
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from models.errors import CrankcheckError
from models.files import load_scene, shipped
from models.laws import Oscillating
from reports.cli import app
from reports.singular import refuse_singular

Edit = Callable[..., str]


@pytest.fixture
def edited(tmp_path: Path) -> Edit:
    """A shipped scene with some of its text changed, as a file."""

    def edit(name: str, *changes: tuple[str, str]) -> str:
        text = shipped()[name].read_text(encoding="utf-8")
        for old, new in changes:
            text, count = re.subn(old, new, text)
            assert count
        path = tmp_path / "edited.toml"
        path.write_text(text, encoding="utf-8")
        return str(path)

    return edit


RHOMBUS = (r"length_m = 0\.\d+", "length_m = 0.3")


def crank(*args: str) -> Result:
    return CliRunner().invoke(app, list(args), catch_exceptions=False)


@pytest.mark.parametrize("start", ["90.0", "90.137"])
def test_verify_refuses_a_run_through_a_singular_position_also_between_two_samples(
    edited: Edit, monkeypatch: pytest.MonkeyPatch, start: str
) -> None:
    monkeypatch.setattr("reports.commands.verify.check_all", None)  # no engine may run
    path = edited("fourbar-lecture-1", RHOMBUS, ("start_deg = 90.0", f"start_deg = {start}"))
    result = crank("verify", path, "--steps-per-turn", "360")
    assert result.exit_code == 2
    text = " ".join(result.stderr.split())
    for part in ("fourbar-lecture-1", "driver 180 deg", "dyad of C", "not determined", "choose"):
        assert part in text


def test_a_run_that_ends_before_the_singular_position_is_free_to_go(edited: Edit) -> None:
    scene = load_scene(edited("fourbar-lecture-1", RHOMBUS))
    period = scene.driver.law.period_s
    refuse_singular(scene, 0.24 * period)
    with pytest.raises(CrankcheckError, match="driver 180 deg"):
        refuse_singular(scene, 0.26 * period)


def test_a_swing_up_to_a_singular_position_is_refused(edited: Edit) -> None:
    path = edited("slider-crank-excel-210", ("length_m = 2.1", "length_m = 2.0"))
    scene = load_scene(path)
    swing = Oscillating(centre_rad=0.0, amplitude_rad=1.5707963267948966, frequency_rad_s=1.0)
    moved = replace(scene, driver=replace(scene.driver, law=swing))
    with pytest.raises(CrankcheckError, match="90 deg the dyad of C"):
        refuse_singular(moved, swing.period_s)


@pytest.mark.parametrize("name", list(shipped()))
def test_no_shipped_scene_is_refused(name: str) -> None:
    scene = load_scene(name)
    refuse_singular(scene, 2 * scene.driver.law.period_s)


def test_near_is_not_at(edited: Edit) -> None:
    path = edited("slider-crank-excel-210", ("length_m = 2.1", "length_m = 2.0000001"))
    scene = load_scene(path)
    refuse_singular(scene, scene.driver.law.period_s)


@pytest.mark.parametrize("args", [[], ["--at-deg", "180"]])
def test_solve_shows_a_dash_for_the_rates_of_a_singular_position_and_names_it(
    edited: Edit, args: list[str]
) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        result = crank("solve", edited("fourbar-lecture-1", RHOMBUS), *args)
    assert result.exit_code == 0
    assert "singular at 180 deg (C)" in result.output
    assert "rates are not determined there" in result.output
    rows = [line.split() for line in result.output.splitlines() if "180" in line]
    assert any("-" in row for row in rows)
    assert result.stderr == ""
