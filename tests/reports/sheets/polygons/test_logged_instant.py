"""A log at one instant, beside the reference: planted errors come out as they went in."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from analytic.drawings.drawn_polygons import polygons_of
from analytic.kinematics import solve
from models.errors import CrankcheckError
from models.files import load_scene
from models.motion import Motion
from reports.logs.map_file import Map
from reports.logs.of_motion import log_of_motion
from reports.sheets.paper import Paper
from reports.sheets.polygons.logged_instant import DIFFERENCED, REPORTED, LoggedInstant, LogInstants
from reports.sheets.polygons.polygon_sheet import PolygonSheet, draw_sheet, laid_out

SCENE = load_scene("fourbar-lecture-1")
ROWS, STEP_S = 720, math.tau / 10.0 / 360
OFF = np.array([3e-4, -4e-4])


def motion(rows: int = ROWS) -> Motion:
    """The reference over two turns, from 90 deg on; the second begins with row 360."""
    return solve(SCENE, STEP_S * np.arange(rows), bound=False)


def with_point(moved: Motion, name: str, **series: np.ndarray) -> Motion:
    changed = replace(moved.points[name], **series)
    return replace(moved, points={**moved.points, name: changed})


def logged(moved: Motion) -> LogInstants:
    return LogInstants.of_log(log_of_motion(SCENE, moved, "run.csv"))


def test_what_rates_are_off_by_is_found_at_the_sample_that_is_asked_for() -> None:
    moved = motion()
    velocity = moved.points["C"].velocity.copy()
    velocity[380] += OFF
    at = logged(with_point(moved, "C", velocity=velocity)).at_angle(110.2)
    assert at.time_s == pytest.approx(380 * STEP_S)
    assert math.degrees(at.placement.driver.theta) % 360 == pytest.approx(110.0)
    assert at.rates["velocity"]["C"] == pytest.approx(OFF, abs=1e-12)
    assert at.rates["velocity"]["B"] == pytest.approx([0.0, 0.0], abs=1e-12)
    assert at.ways == {"velocity": REPORTED, "acceleration": REPORTED}
    assert at.missing == ()
    assert at.taken == " (the last of 2 passes)"


def test_rates_that_are_not_reported_are_differenced() -> None:
    moved = motion()
    place = moved.points["C"].position + np.outer((STEP_S * np.arange(ROWS)) ** 2 / 2, OFF)
    nothing = np.full((ROWS, 2), np.nan)
    for name in ("B", "C"):
        moved = with_point(moved, name, velocity=nothing, acceleration=nothing)
    at = logged(with_point(moved, "C", position=place)).at_time(380.3 * STEP_S)
    assert at.time_s == pytest.approx(380 * STEP_S)
    assert at.rates["velocity"]["C"] == pytest.approx(380 * STEP_S * OFF, abs=1e-9)
    assert at.rates["acceleration"]["C"] == pytest.approx(OFF, abs=1e-6)
    assert set(at.ways.values()) == {DIFFERENCED}


def test_a_point_with_one_coordinate_is_missing() -> None:
    moved = motion()
    velocity = moved.points["C"].velocity.copy()
    velocity[:, 1] = np.nan
    at = logged(with_point(moved, "C", velocity=velocity)).at_angle(90)
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
def test_an_instant_that_is_not_in_the_log_is_refused(ask: object, told: str) -> None:
    with pytest.raises(CrankcheckError, match=told):
        ask(logged(motion(100)))  # type: ignore[operator]  # a function of the log


def test_a_log_without_points_is_refused_with_what_it_holds() -> None:
    with pytest.raises(CrankcheckError, match=r"both coordinates of points that move .*angle of"):
        logged(replace(motion(), points={})).at_angle(90.0)


def test_an_end_of_a_log_without_rates_is_refused() -> None:
    moved, nothing = motion(), np.full((ROWS, 2), np.nan)
    for name in ("B", "C"):
        moved = with_point(moved, name, velocity=nothing, acceleration=nothing)
    with pytest.raises(CrankcheckError, match="no neighbours on both sides"):
        logged(moved).at_time(0.0)


def test_a_log_of_links_that_bend_is_refused() -> None:
    with pytest.raises(CrankcheckError, match="polygons are those of rigid links"):
        LogInstants.of_file(load_scene("fourbar-elastic"), Path("run.csv"), Map())


def sheet_beside(rates: Mapping[str, np.ndarray]) -> PolygonSheet:
    at = logged(motion()).at_angle(90.0)
    at = LoggedInstant(
        "run.csv", at.time_s, at.placement, at.places,
        {"velocity": rates, "acceleration": {}}, {"velocity": REPORTED, "acceleration": REPORTED},
    )  # fmt: skip
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
