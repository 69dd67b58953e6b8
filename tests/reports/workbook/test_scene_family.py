"""Families of mechanisms without formulas: values of the reference, and charts of them."""

from __future__ import annotations

import io

import numpy as np
import openpyxl
import pytest

from analytic.kinematics import solve
from models.errors import CrankcheckError
from models.files import load_scene
from models.scene import span
from reports.workbook.scene_family import scene_curves, scene_family, varied_scene
from reports.workbook.scene_family_workbook import scene_family_workbook

TIMES = np.linspace(0.0, 0.6, 5)


def test_a_length_a_pin_and_the_speed_are_varied() -> None:
    scene = load_scene("shaper")
    assert span(varied_scene(scene, "rod", 0.27).links["rod"].points) == pytest.approx(0.27)
    assert varied_scene(scene, "A.y", 0.31).ground["A"] == (0.0, 0.31)
    assert varied_scene(scene, "omega", -2.0).driver.law.at(np.ones(1))[1] == -2.0


def test_members_are_the_reference_and_their_columns_and_charts_stand_in_a_workbook() -> None:
    scene = load_scene("sixbar-stephenson")
    family = scene_family(scene, "omega", [2.0, -5.0], TIMES)
    book = openpyxl.load_workbook(io.BytesIO(scene_family_workbook(family, {})))
    turned_rad = TIMES[-1] * scene.driver.law.peak_speed_rad_s
    head, *rows = book["family"].iter_rows(values_only=True)
    for value in (2.0, -5.0):
        member = varied_scene(scene, "omega", value)
        times = [row[head.index(f"time_s, omega = {value:g}")] for row in rows]
        assert times[-1] * abs(value) == pytest.approx(turned_rad)
        motion = solve(member, np.array(times))
        lever = [row[head.index(f"lever_alpha_rad_s2, omega = {value:g}")] for row in rows]
        assert lever == pytest.approx(motion.links["lever"].alpha)
    assert len(book["charts"]._charts) == 3 * (len(scene.links) - 1)
    assert [len(chart.series) for chart in book["charts"]._charts] == [2] * 12


def test_what_is_driven_is_drawn() -> None:
    shaper = scene_curves(scene_family(load_scene("shaper"), "rod", [0.2, 0.3], TIMES))
    assert shaper.charts[0].label == "F: displacement [m]"
    six = scene_curves(scene_family(load_scene("sixbar-watt"), "D.x", [0.3, 0.301], TIMES))
    assert six.charts[2].label == "lever: alpha [rad/s²]"


@pytest.mark.parametrize(
    ("name", "values", "told"),
    [
        ("lever", [0.2, 0.05], "lever=0.05: this member cannot be assembled: sixbar-stephenson: c"),
        ("levr", [0.2, 0.3], "did you mean lever"),
        ("coupler", [0.2, 0.3], "it has crank, rocker, rod, lever, A.x|did you mean"),
        ("rod", [0.2, -0.3], "rod=-0.3: a length; give numbers above 0"),
        ("omega", [2.0, 0.0], "omega=0: a speed"),
        ("rod", [0.2], "1 values; give 2 to 20"),
    ],
)
def test_a_family_that_can_not_be_is_refused(name: str, values: list[float], told: str) -> None:
    with pytest.raises(CrankcheckError, match=told):
        scene_family(load_scene("sixbar-stephenson"), name, values, TIMES)


def test_a_member_that_is_open_between_rows_alone_is_refused() -> None:
    told = "rod=0.184977: this member cannot be assembled: sixbar-watt: crank at 216"
    with pytest.raises(CrankcheckError, match=told):
        scene_family(load_scene("sixbar-watt"), "rod", [0.3, 0.184977], np.linspace(0.0, 0.6, 2))
