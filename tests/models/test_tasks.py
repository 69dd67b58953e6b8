"""Task files: the shipped ones read, and what is wrong with others is said in one message."""

from __future__ import annotations

from pathlib import Path

import pytest

from models.errors import CrankcheckError, SceneError
from models.tasks.coupler import CouplerTask
from models.tasks.files import KINDS, find_task, load_task, shipped_tasks

HEAD = 'name = "x"\nsource = "a test"\n'
A, B = "{ point_m = [0.0, 0.0], angle_deg = 0.0 }", "{ point_m = [0.1, 0.0], angle_deg = 10.0 }"
C, D = "{ point_m = [0.2, 0.1], angle_deg = 30.0 }", "{ point_m = [0.3, 0.1], angle_deg = 50.0 }"
MOVING = "moving_m = [[0.0, 0.0], [0.1, 0.0]]"


@pytest.mark.parametrize(
    ("kind", "name"), [(kind, name) for kind, names in shipped_tasks().items() for name in names]
)
def test_shipped_tasks_are_named_as_their_files_and_have_a_source(kind: str, name: str) -> None:
    task = load_task(kind, name)
    assert task.name == name
    assert task.source


def test_every_kind_has_a_shipped_task() -> None:
    assert all(shipped_tasks()[kind] for kind in KINDS)


FAULTS = [
    ("coupler", f"positions = [{A}]", "at least 2"),
    ("coupler", f"positions = [{A}, {B}]", "moving_m: missing"),
    ("coupler", f"positions = [{A}, {B}, {C}, {D}, {A}, {B}]", "at most 5"),
    ("coupler", f"positions = [{A}, {B}, {C}, {D}]\n{MOVING}", "leave it out"),
    ("coupler", f"positions = [{A}, {B}]\nfixed_m = [[0.0, 0.0], [1.0, 0.0]]", "for three"),
    ("coupler", f"positions = [{A}, {B}, {C}]\n{MOVING}\ndistances_m = [0.1, 0.2]", "leave it out"),
    ("coupler", f"positions = [{A}, {B}, {C}]\n{MOVING}\ndriving_dyad = true", "between two"),
    (
        "coupler", f"positions = [{A}, {{ points = {{ C = [0.0, 0.0], D = [1.0, 0.0] }} }}]",
        "in the same way"),
    (
        "coupler",
        "positions = [{ points = { C = [0.0, 0.0], D = [1.0, 0.0] } }, "
        "{ points = { C = [0.0, 0.0], D = [0.0, 1.1] } }]",
        "1 m apart in position 1 and 1.1 m in position 2; a body is rigid",
    ),
    (
        "coupler",
        "positions = [{ points = { O2 = [0.0, 0.0], D = [1.0, 0.0] } }, "
        "{ points = { O2 = [0.0, 0.0], D = [0.0, 1.0] } }]",
        "O2: solutions have pivots and links of that name",
    ),
    ("coupler", "positions = [{ point_m = [0.0, 0.0] }, { angle_deg = 1.0 }]", "point_m and angle"),
    ("coupler", f"positions = [{A}, {B}]\n{MOVING}\npositons = 3", "unknown key"),
    (
        "coupler",
        f"positions = [{A}, {B}]\n{MOVING}\n"
        "pivots_in = { from_m = [1.0, 0.0], to_m = [0.0, 1.0] }",
        "lower left",
    ),
    ("rocker", "rocker_m = 0.1", "swing_deg, or two positions"),
    ("rocker", "swing_deg = 200.0\nrocker_m = 0.1", "less than 180"),
    ("rocker", "swing_deg = 20.0", "rocker_m: missing"),
    ("rocker", f"positions = [{A}]", "between two"),
    ("stroke", "stroke_m = 0.1\ntime_ratio = 1.2", 'belong to form = "offset"'),
    ("stroke", 'stroke_m = 0.1\nform = "offset"', "give offset_m, or time_ratio"),
    ("stroke", 'stroke_m = 0.1\nform = "isosceles"\nrod_m = 1.0', "a quarter of the stroke"),
    ("stroke", "stroke_m = -0.1", "greater than"),
    ("stroke", 'stroke_m = 0.1\nform = "offset"\ntime_ratio = 0.9', "greater than 1"),
    ("quick-return", 'mechanism = "whitworth"\ntime_ratio = 2.0', "found no size"),
    (
        "quick-return", 'mechanism = "whitworth"\ntime_ratio = 2.0\ncrank_m = 0.1\npivots_m = 0.1',
        "crank_m and pivots_m"),
    (
        "quick-return", 'mechanism = "crank-rocker"\ntime_ratio = 1.2\nrocker_m = 0.1',
        "swing_deg: a crank-rocker needs it"),
    ("quick-return", 'mechanism = "shaper"\ntime_ratio = 1.2\ncrank_m = 0.1', "slotted-lever"),
]  # fmt: skip


@pytest.mark.parametrize(("kind", "text", "says"), FAULTS)
def test_faults_are_said(tmp_path: Path, kind: str, text: str, says: str) -> None:
    file = tmp_path / "task.toml"
    file.write_text(HEAD + text, encoding="utf-8")
    with pytest.raises(SceneError) as found:
        load_task(kind, str(file))
    assert says in str(found.value)


def test_near_names_are_suggested() -> None:
    with pytest.raises(CrankcheckError, match="did you mean coupler"):
        find_task("couplers", "x")
    with pytest.raises(CrankcheckError, match="Did you mean three-positions"):
        find_task("coupler", "three-position")


def test_a_body_by_two_points_has_the_first_as_its_origin() -> None:
    task = load_task("coupler", "three-positions")
    assert isinstance(task, CouplerTask)
    assert task.own_points["C"] == 0j
    assert task.own_points["D"] == pytest.approx(0.14, abs=1e-6)
    place, angle = task.poses[1]
    assert place == 0.08 + 0.24j
    assert angle == pytest.approx(-0.1745329, abs=1e-5)
