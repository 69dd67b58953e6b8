"""The sheet of vector polygons, measured as one measures a drawing, and what their page holds;
`tests.reports.page` opens it. Polygons at an instant: at a time of a motion, beside how that moves;
of a log, beside the reference: planted errors come out as they went in."""

import io
import math
import re
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from analytic.kinematics import solve, solve_driven
from analytic.lectures.drawings.drawn_polygons import draw_polygons, polygons_of
from analytic.lectures.drawings.polygon import DriverState, PlacedMechanism
from models.array import Array
from models.errors import CrankcheckError
from models.files.reading import load_scene
from models.motion import Motion
from reports.drawing.shape import true_motion
from reports.lectures.drawing.sheets.graph_drawing import SheetLog
from reports.lectures.drawing.sheets.paper import Paper
from reports.lectures.drawing.sheets.polygon_instant import (
    DIFFERENCED,
    REPORTED,
    LoggedInstant,
    LogInstants,
    placed_at_angle,
    placed_at_time,
)
from reports.lectures.drawing.sheets.polygon_page import (
    INSTANTS,
    polygon_file,
    polygon_page,
    turning_file,
)
from reports.lectures.drawing.sheets.polygon_sheet import (
    PolygonSheet,
    draw_lines,
    draw_sheet,
    laid_out,
)
from reports.logs.map_file import Map
from reports.requests.any_log import log_of_motion
from tests.reports.drawing.test_moving import unpacked
from tests.reports.lectures.drawing.sheets.measured import TENTH_MM, drawn_lines
from tests.reports.page.hostile import embedded_in
from tests.worlds.tiers import slow, slowly
from tests.worlds.without_pdf import without_pdf


def sheet_of(name: str, theta: float, paper: str = "A4", k: float | None = None) -> PolygonSheet:
    return laid_out(draw_polygons(load_scene(name), DriverState(theta, 10.0)), Paper.of(paper), k)


@pytest.mark.parametrize(
    ("name", "theta"),
    [
        ("slider-crank-offset", 2.9),
        slowly("shaper", 5.5, reason="as the others"),
        slowly("sixbar-stephenson", 6.8, reason="as the others"),
    ],
)
def test_measured_lengths_times_scales_are_the_reference(name: str, theta: float) -> None:
    """Every vector of both polygons to a tenth of a millimetre on paper."""
    sheet = sheet_of(name, theta)
    measured = drawn_lines(draw_lines(sheet, "").saved("svg", "lines"))
    driven = np.array([[theta], [10.0], [0.0]])
    solved = solve_driven(load_scene(name), *driven, bound=False)
    for drawn in (sheet.velocity, sheet.acceleration):
        quantity, nodes = drawn.polygon.quantity, drawn.polygon.nodes
        for vector in drawn.polygon.vectors:
            (line,) = measured[f"{quantity}-{vector.name}"]
            length = (line[-1] - line[0]) * (1.0, -1.0)
            assert length == pytest.approx(vector.value / drawn.scale, abs=TENTH_MM)
        for point in nodes.keys() & solved.points.keys():
            ways = [v for v in drawn.polygon.vectors if np.array_equal(v.end, nodes[point])]
            assert ways or point == "A"
            exact = getattr(solved.points[point], quantity)[0]
            assert nodes[point] == pytest.approx(exact, abs=0.01 * TENTH_MM * drawn.scale)


def test_layers_stand_in_the_order_of_drawing_and_the_same_sheet_has_the_same_bytes() -> None:
    sheet = sheet_of("slider-crank-offset", 1.2, "A5")
    svg = polygon_file(sheet, ".svg")
    layers = re.findall(r'inkscape:label="([^"]*)"', svg.decode())
    groups = ["1-driver-crank", "2-RRP--rod--block-C"]
    assert layers[:5] == ["frame", "scheme", "table", *(f"velocity-{group}" for group in groups)]
    assert polygon_file(sheet, ".svg") == svg
    with without_pdf():
        assert polygon_file(sheet, ".pdf").startswith(b"%PDF")


@slow("24 sheets, and a second of frames: the layers that they show are tested as drawings")
def test_an_animation_has_a_frame_for_each_layer_that_is_drawn_or_for_each_angle() -> None:
    sheet = sheet_of("fourbar-lecture-1", 1.0, "A5")
    # nothing; the table; driver, group, letters of each polygon; images of accelerations, as those
    # of velocities are the vectors themselves
    for file, frames in (
        (polygon_file(sheet, ".gif"), 1 + 1 + 2 * 3 + 1),
        (turning_file(sheet), 24),
    ):
        with Image.open(io.BytesIO(file)) as picture:
            assert picture.n_frames == frames


def words_on(sheet: PolygonSheet) -> list[str]:
    return [text.get_text() for axes in draw_sheet(sheet, "").layers for text in axes.texts]


def test_ends_of_components_have_letters_and_a_table_says_what_the_images_of_links_are() -> None:
    assert {"n'", "k'", "b(lever)'"} <= {*words_on(sheet_of("slotted-lever", 0.9))}
    words = words_on(sheet_of("scotch-yoke", 1.0))
    assert "v: one point, as omega is 0" in words
    assert "v: similar, 10 1/s, turned by 90°" in words


def test_directions_that_hardly_cross_are_told() -> None:
    # coupler and rocker in line: cos phi = (0.25^2 + 0.3^2 - 0.4^2) / (2 0.25 0.3)
    limit = math.acos(-0.05)
    words = words_on(sheet_of("fourbar-double-rocker-swing", limit - 1e-6))
    assert any(word.startswith("flat: RRR (coupler, rocker): its directions") for word in words)


def test_the_book_s_scale_draws_vectors_k_times_the_crank_where_the_paper_has_room() -> None:
    sheet = sheet_of("fourbar-lecture-1", 1.0, k=2.0)
    for drawn in (sheet.velocity, sheet.acceleration):
        size = drawn.polygon.vectors[0].size / drawn.scale
        assert size == pytest.approx(2.0 * 0.1 / sheet.length_scale)
    with pytest.raises(CrankcheckError, match=r"needs \d+ x \d+ mm .* larger paper, or a smaller"):
        sheet_of("fourbar-lecture-1", 1.0, k=20.0)


def test_paper_that_is_none_or_without_room_is_refused() -> None:
    for paper, told in (
        ("A7", "unknown size; use A5, A4"),
        ("100x50", "needs 180 x 120 mm"),
        ("nanx1", "unknown size"),
        ("99999x99999", "at most 2000 mm"),
    ):
        with pytest.raises(CrankcheckError, match=told):
            Paper.of(paper)
    with pytest.raises(CrankcheckError, match=r"\d+ rows .* can not be read .* such as A3"):
        draw_sheet(sheet_of("squeezer", -0.6, "A5"), "")


def test_the_page_holds_the_polygons_of_each_instant() -> None:
    placed = placed_at_angle(load_scene("slotted-lever"), 50.0)
    own = embedded_in(polygon_page(placed), "polygons")
    at = own["home"]
    assert own["drawing"]["told"]["at"][at] == pytest.approx(50.0)
    drawn = draw_polygons(placed.scene, placed.driver)
    for packed, polygon in zip(own["polygons"], (drawn.velocity, drawn.acceleration), strict=True):
        rows = unpacked(packed["rows"])[:, at].reshape(-1, 4)
        assert [one["name"] for one in packed["vectors"]] == [v.name for v in polygon.vectors]
        exact = np.array([[*v.start, *v.end] for v in polygon.vectors])
        assert rows == pytest.approx(exact, abs=2e-4 * np.abs(rows).max())
    # Of a link that does not turn, rates are 0 exactly.
    own = embedded_in(polygon_page(placed_at_angle(load_scene("scotch-yoke"), 50.0)), "polygons")
    rows = unpacked(own["links"]["rows"])
    number = own["links"]["names"].index("yoke")
    assert np.all(rows[2 * number : 2 * number + 2] == 0.0)


def test_a_speed_of_ones_own_is_that_of_a_whole_turn_if_the_driver_goes_through_one() -> None:
    placed = placed_at_angle(load_scene("fourbar-swing"), 90.0, 3.0)
    at = embedded_in(polygon_page(placed, steady=True), "polygons")["drawing"]["told"]["at"]
    assert at[-1] - at[0] == pytest.approx(360.0)
    assert len(at) == INSTANTS
    scene = load_scene("fourbar-double-rocker")  # whose driver goes through no turn
    with pytest.raises(CrankcheckError):
        polygon_page(PlacedMechanism.of(scene, DriverState(1.0, 1.0)), steady=True)


SCENE = load_scene("fourbar-lecture-1")
ROWS, STEP_S = 720, math.tau / 10.0 / 360
OFF = np.array([3e-4, -4e-4])
MOTION = solve(SCENE, STEP_S * np.arange(ROWS), bound=False)
"""The reference over two turns, from 90 deg on; the second begins with row 360."""


def with_point(moved: Motion, name: str, **series: Array) -> Motion:
    changed = replace(moved.points[name], **series)
    return replace(moved, points={**moved.points, name: changed})


def logged(moved: Motion) -> LogInstants:
    return LogInstants.of(SheetLog.of_log(log_of_motion(SCENE, moved, "run.csv")))


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
    rates = dict.fromkeys(("velocity", "acceleration"), np.full((ROWS, 2), np.nan))
    bare = with_point(with_point(MOTION, "B", **rates), "C", position=place, **rates)
    log = logged(bare)
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


def test_logs_without_the_instant_or_points_and_of_links_that_bend_are_refused() -> None:
    log = logged(solve(SCENE, STEP_S * np.arange(100), bound=False))
    none = logged(replace(MOTION, points={}))
    for ask, at, told in (
        (log.at_angle, 250.0, "does not pass it; in its 100 rows crank goes from 90"),
        (log.at_angle, math.nan, "give an angle"),
        (log.at_time, 5.0, "goes from 0 to"),
        (log.at_time, math.nan, "goes from 0 to"),
        (none.at_angle, 90.0, r"both coordinates of points that move .*angle of"),
    ):
        with pytest.raises(CrankcheckError, match=told):
            ask(at)
    with pytest.raises(CrankcheckError, match="polygons are those of rigid links"):
        SheetLog.of_file(load_scene("fourbar-elastic"), Path("run.csv"), Map(), "polygons")


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
    words = words_on(sheet)
    assert "run.csv, as the log reports them: errors \N{MULTIPLICATION SIGN} 10²" in words
    assert "run.csv: no acceleration of any point in it" in words
    assert "c*" in words


def test_an_error_that_leaves_the_sheet_makes_the_scale_coarser() -> None:
    sheet = sheet_beside({"C": np.array([-3.0, 4.0])})
    drawn = sheet.velocity.logged
    assert drawn.factor == 1.0
    assert sheet.velocity.scale > laid_out(sheet.drawn, sheet.paper).velocity.scale
    low, high = sheet.boxes["velocity"].corners
    assert np.all(drawn.tips["C"] > low)
    assert np.all(drawn.tips["C"] < high)
    assert drawn.exact["C"] == pytest.approx(sheet.velocity.at(sheet.velocity.polygon.nodes["C"]))


@pytest.mark.parametrize(
    ("name", "at_s"),
    [
        ("fourbar-double-rocker-swing", 0.5),  # it has turned back at a limit, on another branch
        ("fourbar-double-rocker", 0.3),  # it swings by a law
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


def test_an_instant_needs_a_time_that_is_near_or_a_speed_within_bounds() -> None:
    scene = load_scene("fourbar-swing")  # which is let go
    with pytest.raises(CrankcheckError, match="give --at-s for an instant of its motion"):
        placed_at_angle(scene, 90.0)
    assert placed_at_angle(scene, 90.0, 2.0).driver.omega == 2.0
    with pytest.raises(CrankcheckError, match="give a time up to 100 s"):
        placed_at_time(scene, 1000.0)
    for omega in (0.0, 1e200, 5e-324, math.nan):
        told = "from 1e-09 to 1e\\+09 either way" if omega else "other than 0"
        with pytest.raises(CrankcheckError, match=told):
            placed_at_angle(load_scene("whitworth"), 90.0, omega)
