"""`sensitivity`: what is printed, drawn and written of the effects of dimensions."""

import json
from pathlib import Path

import numpy as np
import pytest

import crankcheck
from analytic.gradients.dimensions import with_dimensions
from analytic.kinematics import solve_driven
from models.files.reading import load_scene
from reports.lectures.machine.sensitivity import effects
from tests.worlds.command_line import crank_alone


def test_effects_are_those_of_a_longer_link_at_the_angle_where_they_are_largest() -> None:
    scene = load_scene("fourbar-lecture-1")
    found = effects(scene, "rocker", (), 1e-6, 1e-6)
    for row in found.rows():
        if row["unit"] == "deg":
            continue
        longer = with_dimensions(
            scene, {row["dimension"]: (row["value"] + row["tolerance"]) * 1e-3}
        )
        angle = np.radians([float(row["at"].split()[2])])
        theta = [solve_driven(s, angle, np.ones(1), np.zeros(1)).links["rocker"].theta[0]
                 for s in (scene, longer)]  # fmt: skip
        assert np.degrees(theta[1] - theta[0]) == pytest.approx(row["largest"], rel=1e-4)
    sizes = [abs(row["largest"]) for row in found.rows()]
    assert sizes == sorted(sizes, reverse=True)


def test_the_follower_is_a_slider_on_the_ground_or_a_link_that_is_pinned_there() -> None:
    names = {"slider-crank-offset": "C", "shaper": "F", "whitworth": "lever", "cam-flat": "guide"}
    for scene, of in names.items():
        assert effects(load_scene(scene), "", (), 1e-4, 1e-4).of == of


def test_a_point_has_the_length_of_its_way() -> None:
    scene = load_scene("fourbar-lecture-1")
    found = effects(scene, "B", ("crank",), 1e-3, 1e-3)
    assert found.at_tolerance == pytest.approx(np.ones((1, 361)))


def test_it_is_written_as_curves_table_and_document(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    line = ("sensitivity", "slider-crank-offset", "--by", "rod", "--by", "driver.angle")
    for file in ("curves.csv", "curves.svg", "curves.csv"):
        assert crank_alone(*line, "-o", file).exit_code == 0
    head, first, *_ = (tmp_path / "curves.csv").read_text().splitlines()
    assert head == "driver_deg,time_s,C_by_rod_m_per_m,C_by_driver.angle_m_per_rad"
    assert float(first.split(",")[0]) == pytest.approx(30.0)
    svg = (tmp_path / "curves.svg").read_text()
    assert "Effect of dimensions on C" in svg
    assert all(name in svg for name in ("rod", "driver.angle", "angle of crank [deg]"))
    document = json.loads(crank_alone(*line, "--json").stdout)
    assert [row["dimension"] for row in document["dimensions"]] == ["driver.angle", "rod"]


def test_in_python_it_prints_and_has_a_frame() -> None:
    found = crankcheck.gradient("slider-crank-offset", [0.0, 0.1], ["crank", "C.mass"])
    assert "C, m" in str(found)
    assert list(found.forces) == ["C.mass"]
    frame = found.frame()
    assert list(frame.columns[:4]) == ["by", "over", "time_s", "crank_theta_rad"]
    slope = found.by["crank"].sliders["C"].displacement
    assert frame["C_slider_displacement_m"].tolist() == slope.tolist()
