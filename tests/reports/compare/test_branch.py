"""A run that goes over to the other assembly of its loop is named, and never passes."""

from __future__ import annotations

from pathlib import Path

import pytest

from models.files import load_scene, shipped
from models.scene import Scene
from reports.judge.cell import Cell, Checked, check


def edited(folder: Path, name: str, old: str, new: str) -> Scene:
    """A shipped scene with some of its text changed."""
    text = shipped()[name].read_text(encoding="utf-8")
    assert text.count(old) == 1
    path = folder / "edited.toml"
    path.write_text(text.replace(old, new), encoding="utf-8")
    return load_scene(str(path))


def checked(scene: Scene, engine: str) -> Checked:
    return check(Cell(scene, engine, "tuned", scene.driver.law.period_s / 720, 1440))


@pytest.mark.parametrize("engine", ["mujoco", "pymunk"])
@pytest.mark.parametrize(
    ("name", "old", "new", "link", "left_deg"),
    [
        ("fourbar-lecture-1", "length_m = 0.1 ", "length_m = 0.1499999999 ", "coupler", 181),
        ("slider-crank-excel-210", "length_m = 2.1", "length_m = 2.0000001", "rod", 90),
    ],
)
def test_a_run_on_the_other_branch_is_out_and_says_where_it_left(
    tmp_path: Path, name: str, old: str, new: str, link: str, left_deg: int, engine: str
) -> None:
    found = checked(edited(tmp_path, name, old, new), engine)
    assert found.verdict == "out"
    assert found.status == "branch-changed"
    assert {"CC101", "CC103", "CC113"} <= {finding.rule for finding in found.failures}
    assert f"branch-changed: {link} left its branch at driver {left_deg}" in found.failures[0].text


def test_a_run_that_stays_on_its_branch_has_no_departure() -> None:
    found = checked(load_scene("slider-crank-excel-210"), "pymunk")
    assert found.status == "ok"
    assert found.errors is not None
    assert found.errors.departure is None


@pytest.mark.parametrize("engine", ["mujoco", "pymunk"])
def test_an_uncertain_reference_fails_every_engine_alike(tmp_path: Path, engine: str) -> None:
    scene = edited(tmp_path, "fourbar-lecture-1", "length_m = 0.1 ", "length_m = 0.1499999999 ")
    finding = next(f for f in checked(scene, engine).findings if f.rule == "CC112")
    assert finding.level == "fail"
    assert "acceleration of rocker" in finding.text  # pymunk reports none, and is judged by it
