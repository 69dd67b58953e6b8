"""The figure of a family: the paper's four rods, and what is written in it."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET

import numpy as np
import pytest

from analytic.kinematics import solve
from models.files import load_scene
from reports.face.family_report import family_drawing, family_page_of
from reports.figures.family.family_figure import draw_family
from reports.workbook.family_curves import FamilyCurves, family_curves
from reports.workbook.live_workbook import formulas_of

SCENE, RODS = "slider-crank-excel-350", [3.5, 2.5, 2.2, 2.1]


@pytest.fixture(scope="module")
def curves() -> FamilyCurves:
    table = formulas_of(load_scene(SCENE), 73, 5.0)
    assert table is not None
    return family_curves(table, "L", RODS)


def test_the_paper_s_four_rods_are_the_reference_of_their_scenes(curves: FamilyCurves) -> None:
    figure = draw_family(curves, "", [])
    for k, rod in enumerate(RODS):
        scene = load_scene(f"slider-crank-excel-{100 * rod:.0f}")
        drawn = [axes.lines[-len(RODS) + k] for axes in figure.axes]
        angle = np.radians(np.asarray(drawn[0].get_xdata()))  # at 1 rad/s it is the time
        (slider,) = solve(scene, angle, bound=False).sliders.values()
        for line, exact in zip(
            drawn, (slider.displacement, slider.speed, slider.acceleration), strict=True
        ):
            assert line.get_ydata() == pytest.approx(exact, abs=1e-11)


def test_three_panels_have_labels_units_and_one_legend(curves: FamilyCurves) -> None:
    root = ET.fromstring(family_drawing(load_scene(SCENE), curves, "svg"))
    found = ["".join(t.itertext()) for t in root.iter("{http://www.w3.org/2000/svg}text")]
    for words in ("X [m]", "X' [m/s]", "X'' [m/s²]", "angle of the crank [deg]"):
        assert found.count(words) == 1
    for rod in RODS:
        assert found.count(f"L = {rod} m") == 1


def test_the_page_has_a_figure_each_and_loads_nothing(curves: FamilyCurves) -> None:
    text = family_page_of(load_scene(SCENE), curves)
    assert text.count("data:image/svg+xml;base64,") == 3
    assert not re.search(r'(src|href)="https?:', text)
    assert all(f"L = {rod} m" in text for rod in RODS)


def test_both_links_of_a_four_bar_have_panels_beside_each_other() -> None:
    table = formulas_of(load_scene("fourbar-lecture-1"), 5, 5.0)
    assert table is not None
    figure = draw_family(family_curves(table, "rocker", [0.2, 0.21]), "", [])
    assert [axes.get_ylabel() for axes in figure.axes[:2]] == [
        "theta of BC [rad]", "theta of DC [rad]"
    ]  # fmt: skip
    assert len(figure.axes) == 6
