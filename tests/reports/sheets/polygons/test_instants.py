"""Polygons at an instant: at a time of a motion, against how that moves; of a log, beside the
reference: planted errors come out as they went in."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from analytic.drawings.drawn_polygons import polygons_of
from analytic.kinematics import solve
from models.array import Array
from models.errors import CrankcheckError
from models.files import load_scene
from models.motion import Motion
from reports.drawing.true_motion import true_motion
from reports.logs.map_file import Map
from reports.logs.of_motion import log_of_motion
from reports.sheets.paper import Paper
from reports.sheets.polygons.logged_instant import DIFFERENCED, REPORTED, LoggedInstant, LogInstants
from reports.sheets.polygons.polygon_instant import placed_at_angle, placed_at_time
from reports.sheets.polygons.polygon_sheet import PolygonSheet, draw_sheet, laid_out

SCENE = load_scene("fourbar-lecture-1")
ROWS, STEP_S = 720, math.tau / 10.0 / 360
OFF = np.array([3e-4, -4e-4])


MOTION = solve(SCENE, STEP_S * np.arange(ROWS), bound=False)
"""The reference over two turns, from 90 deg on; the second begins with row 360."""


def with_point(moved: Motion, name: str, **series: Array) -> Motion:
    changed = replace(moved.points[name], **series)
    return replace(moved, points={**moved.points, name: changed})


def without_rates() -> Motion:
    nothing = np.full((ROWS, 2), np.nan)
    once = with_point(MOTION, "B", velocity=nothing, acceleration=nothing)
    return with_point(once, "C", velocity=nothing, acceleration=nothing)


def logged(moved: Motion) -> LogInstants:
    return LogInstants.of_log(log_of_motion(SCENE, moved, "run.csv"))


def test_what_rates_are_off_by_is_found_at_the_sample_that_is_asked_for() -> None:
    velocity = MOTION.points["C"].velocity.copy()
    velocity[380] += OFF
    at = logged(with_point(MOTION, "C", velocity=velocity)).at_angle(110.2)
    assert at.time_s == pytest.approx(380 * STEP_S)
    assert math.degrees(at.placement.driver.theta) % 360 == pytest.approx(110.0)
    assert at.rates["velocity"]["C"] == pytest.approx(OFF, abs=1e-12)
    assert at.rates["velocity"]["B"] == pytest.approx([0.0, 0.0], abs=1e-12)
    assert at.ways == {"velocity": REPORTED, "acceleration": REPORTED}
    assert at.missing == ()
    assert at.taken == " (the last of 2 passes)"


def test_rates_that_are_not_reported_are_differenced_between_neighbours() -> None:
    place = MOTION.points["C"].position + np.outer((STEP_S * np.arange(ROWS)) ** 2 / 2, OFF)
    log = logged(with_point(without_rates(), "C", position=place))
    at = log.at_time(380.3 * STEP_S)
    assert at.time_s == pytest.approx(380 * STEP_S)
    assert at.rates["velocity"]["C"] == pytest.approx(380 * STEP_S * OFF, abs=1e-9)
    assert at.rates["acceleration"]["C"] == pytest.approx(OFF, abs=1e-6)
    assert set(at.ways.values()) == {DIFFERENCED}
    with pytest.raises(CrankcheckError, match="no neighbours on both sides"):
        log.at_time(0.0)


def test_a_point_with_one_coordinate_is_missing() -> None:
    velocity = MOTION.points["C"].velocity * (1.0, np.nan)
    at = logged(with_point(MOTION, "C", velocity=velocity)).at_angle(90)
    assert at.missing == ("C",)
    assert "C" not in at.rates["velocity"]


@pytest.mark.parametrize(
    ("ask", "told"),
    [
        (lambda log: log.at_angle(250.0), "does not pass it; in its 100 rows crank goes from 90"),
        (lambda log: log.at_angle(math.nan), "give an angle"),
        (lambda log: log.at_time(5.0), "goes from 0 to"),
        (lambda log: log.at_time(math.nan), "goes from 0 to"),
    ],
)
def test_an_instant_off_the_log_is_refused(ask: Callable[[LogInstants], object], told: str) -> None:
    with pytest.raises(CrankcheckError, match=told):
        ask(logged(solve(SCENE, STEP_S * np.arange(100), bound=False)))


def test_a_log_without_points_is_refused_with_what_it_holds() -> None:
    with pytest.raises(CrankcheckError, match=r"both coordinates of points that move .*angle of"):
        logged(replace(MOTION, points={})).at_angle(90.0)


def test_a_log_of_links_that_bend_is_refused() -> None:
    with pytest.raises(CrankcheckError, match="polygons are those of rigid links"):
        LogInstants.of_file(load_scene("fourbar-elastic"), Path("run.csv"), Map())


def sheet_beside(rates: Mapping[str, Array]) -> PolygonSheet:
    at = logged(MOTION).at_angle(90.0)
    ways = dict.fromkeys(("velocity", "acceleration"), REPORTED)
    off = {"velocity": rates, "acceleration": {}}
    at = LoggedInstant("run.csv", at.time_s, at.placement, at.places, off, ways)
    return laid_out(polygons_of(at.placement), Paper.of("A4"), log=at)


def test_the_error_is_drawn_magnified_from_the_image_to_the_log_s() -> None:
    sheet = sheet_beside({"C": OFF})
    drawn = sheet.velocity.logged
    assert drawn.factor == 100.0  # 5e-4 m/s are 0.05 mm at 0.01 m/s to the mm
    exact = sheet.velocity.at(sheet.velocity.polygon.nodes["C"])
    assert drawn.tips["C"] - exact == pytest.approx(100.0 * OFF / sheet.velocity.scale)
    words = [text.get_text() for axes in draw_sheet(sheet, "").layers for text in axes.texts]
    assert "run.csv, as the log reports them: errors \N{MULTIPLICATION SIGN} 10²" in words
    assert "run.csv: no acceleration of any point in it" in words
    assert "c*" in words


def test_an_error_that_leaves_the_sheet_makes_the_scale_coarser() -> None:
    sheet = sheet_beside({"C": np.array([-3.0, 4.0])})
    drawn, box = sheet.velocity.logged, sheet.boxes["velocity"]
    assert drawn.factor == 1.0
    assert sheet.velocity.scale > laid_out(sheet.drawn, sheet.paper).velocity.scale
    low, high = np.array([box.left, box.bottom]), np.array([box.width, box.height])
    assert np.all(drawn.tips["C"] > low)
    assert np.all(drawn.tips["C"] < low + high)
    assert drawn.exact["C"] == pytest.approx(sheet.velocity.at(sheet.velocity.polygon.nodes["C"]))


@pytest.mark.parametrize(
    ("name", "at_s"),
    [
        ("fourbar-double-rocker-swing", 0.9),  # it has turned back at a limit, on another branch
        ("fourbar-pulse", 1.3),
        ("fourbar-double-rocker", 0.3),  # it swings by a law
        ("tangent", 0.1),
        ("fourbar-elastic-controlled", 0.2),
    ],
)
def test_polygons_at_a_time_are_the_motion_s_rates(name: str, at_s: float) -> None:
    scene = load_scene(name)
    motion = true_motion(scene, np.array([at_s]))
    drawn = polygons_of(placed_at_time(scene, at_s))
    assert drawn.undetermined == ()
    for polygon in (drawn.velocity, drawn.acceleration):
        for image in polygon.images.values():
            for point, end in image.items():
                exact = getattr(motion.points[point], polygon.quantity)[0]
                assert end == pytest.approx(exact, abs=1e-9 * polygon.largest)


def test_what_is_let_go_from_rest_has_accelerations_alone() -> None:
    drawn = polygons_of(placed_at_time(load_scene("press-motor"), 0.0))
    assert drawn.velocity.largest == 0.0
    assert drawn.acceleration.largest > 1.0


def test_what_is_let_go_needs_a_time_that_is_near_or_a_speed() -> None:
    scene = load_scene("fourbar-swing")
    with pytest.raises(CrankcheckError, match="give --at-s for an instant of its motion"):
        placed_at_angle(scene, 90.0)
    assert placed_at_angle(scene, 90.0, 2.0).driver.omega == 2.0
    with pytest.raises(CrankcheckError, match="give a time up to 100 s"):
        placed_at_time(scene, 1000.0)


@pytest.mark.parametrize("omega", [0.0, 1e200, 5e-324, float("nan")])
def test_a_driver_at_rest_and_a_speed_out_of_all_bounds_are_refused(omega: float) -> None:
    told = "from 1e-09 to 1e\\+09 either way" if omega else "other than 0"
    with pytest.raises(CrankcheckError, match=told):
        placed_at_angle(load_scene("whitworth"), 90.0, omega)
