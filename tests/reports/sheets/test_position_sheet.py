"""The sheet of positions, measured."""

from __future__ import annotations

import re
from dataclasses import replace
from xml.etree import ElementTree

import numpy as np
import pytest

from models.errors import CrankcheckError
from models.files import load_scene, shipped
from models.laws import ConstantSpeed
from reports.sheets.driver_range import assembled
from reports.sheets.paper import Paper
from reports.sheets.position_sheet import PositionSheet, draw_positions, positions

A4 = Paper.of("A4")
SVG = "{http://www.w3.org/2000/svg}"
MM_PER_POINT = 25.4 / 72.0


def sheet_of(name: str, divisions: int = 8) -> PositionSheet:
    return positions(load_scene(name), divisions, A4)


def test_the_crank_circle_is_divided_equally_from_the_start() -> None:
    sheet = sheet_of("fourbar-lecture-1")
    pins = sheet.points["B"]
    angles = np.unwrap(np.arctan2(pins[:, 1], pins[:, 0]))
    assert np.diff(angles) == pytest.approx(np.pi / 4)
    assert angles[0] == pytest.approx(sheet.scene.driver.law.at(np.zeros(1))[0][0])


def test_a_crank_that_turns_clockwise_is_numbered_clockwise() -> None:
    scene = load_scene("fourbar-lecture-1")
    turning = replace(scene.driver, law=ConstantSpeed(start_rad=0.3, speed_rad_s=-10.0))
    sheet = positions(replace(scene, driver=turning), 8, A4)
    assert np.diff(sheet.angles) == pytest.approx(-np.pi / 4)


@pytest.mark.parametrize("name", shipped())
def test_everything_stands_within_the_frame_at_a_round_scale(name: str) -> None:
    sheet = sheet_of(name)
    places = np.concatenate([sheet.at(way) for way in sheet.loci.values()])
    box = sheet.box
    low, high = np.array([box.left, box.bottom]), np.array([box.width, box.height])
    assert np.all(places >= low)
    assert np.all(places <= low + high)
    mantissa = sheet.scale / 10.0 ** np.floor(np.log10(sheet.scale) + 1e-9)
    assert min(abs(mantissa - step) for step in (1.0, 2.0, 5.0)) < 1e-9


def test_the_drawn_locus_is_the_point_s_way_to_a_tenth_of_a_millimetre() -> None:
    sheet = sheet_of("slider-crank-offset")
    drawing = ElementTree.fromstring(draw_positions(sheet, "").saved("svg", "positions"))
    group = next(g for g in drawing.iter(f"{SVG}g") if g.get("id") == "locus-C")
    numbers = re.findall(r"-?\d+\.?\d*(?:e-?\d+)?", group.find(f"{SVG}path").get("d"))
    x = np.array(numbers[::2], float) * MM_PER_POINT
    assert np.ptp(x) * sheet.scale == pytest.approx(np.ptp(sheet.loci["C"][:, 0]), abs=1e-4)


def test_a_driver_that_swings_is_drawn_over_what_it_reaches() -> None:
    sheet = sheet_of("fourbar-double-rocker", 6)
    assert len(sheet.angles) == 6
    assert np.ptp(sheet.angles) < np.pi


def test_divisions_that_fall_together_are_refused_with_how_many_fit() -> None:
    with pytest.raises(CrankcheckError, match=r"at most \d+ fit, or take larger paper"):
        sheet_of("shaper", 300)


def test_a_driver_that_does_not_turn_fully_is_numbered_in_its_sense() -> None:
    scene = load_scene("fourbar-double-rocker")
    law = ConstantSpeed(start_rad=1.0, speed_rad_s=-1.0)
    sheet = positions(replace(scene, driver=replace(scene.driver, law=law)), 6, A4)
    assert np.all(np.diff(sheet.angles) < 0.0)
    assert sheet.placement.driver.omega < 0.0


def test_singular_angles_are_left_out_one_by_one() -> None:
    degrees = np.array([0.0, 45.0, 90.0, 120.0])
    possible = assembled(load_scene("tangent"), np.radians(degrees))
    assert possible.tolist() == [True, True, False, True]
