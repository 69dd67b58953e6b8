"""The sheet of vector polygons, measured as one measures a drawing, and what their page holds;
`tests.reports.page` opens it."""

from __future__ import annotations

import base64
import io
import json
import math
import re
from functools import cache

import numpy as np
import pytest
from PIL import Image

from analytic.drawings.drawn_polygons import draw_polygons
from analytic.drawings.placed_mechanism import DriverState, PlacedMechanism
from analytic.kinematics import solve_driven
from models.array import Array
from models.errors import CrankcheckError
from models.files import load_scene
from reports.sheets.paper import Paper
from reports.sheets.polygons.polygon_files import polygon_file, turning_file
from reports.sheets.polygons.polygon_instant import placed_at_angle
from reports.sheets.polygons.polygon_page import INSTANTS, polygon_page
from reports.sheets.polygons.polygon_sheet import PolygonSheet, draw_lines, draw_sheet, laid_out
from tests.reports.sheets.measured import TENTH_MM, drawn_lines
from tests.worlds.tiers import few, slow

LECTURED = (
    "fourbar-lecture-1",
    "slider-crank-offset",
    "slotted-lever",
    "shaper",
    "sixbar-stephenson",
)


def sheet_of(name: str, theta: float, paper: str = "A4", k: float | None = None) -> PolygonSheet:
    return laid_out(draw_polygons(load_scene(name), DriverState(theta, 10.0)), Paper.of(paper), k)


TURN = math.pi / 2 + np.arange(24) * math.tau / 24
"""From 90 degrees on."""


@pytest.mark.parametrize(("number", "name"), list(enumerate(LECTURED)))
def test_measured_lengths_times_scales_are_the_reference(number: int, name: str) -> None:
    check_measured(name, float(TURN[5 * number]))


@slow("an SVG costs 0.15 s: at 24 angles no other fault is known than at one")
@pytest.mark.parametrize("name", LECTURED)
def test_measured_lengths_are_the_reference_over_a_turn(name: str) -> None:
    for theta in TURN:
        check_measured(name, float(theta))


def check_measured(name: str, theta: float) -> None:
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


@cache
def svg_of(name: str, theta: float) -> bytes:
    return polygon_file(sheet_of(name, theta), ".svg")


def test_layers_stand_in_the_order_of_drawing() -> None:
    layers = re.findall(r'inkscape:label="([^"]*)"', svg_of("shaper", 1.2).decode())
    groups = ["1-driver-crank", "2-RPR--lever--block-B", "3-RRP--rod--block-F"]
    assert layers[:6] == ["frame", "scheme", "table", *(f"velocity-{group}" for group in groups)]


TWO = [("shaper", 1.2), ("fourbar-lecture-1", 1.0)]


@pytest.mark.parametrize("at", few(TWO, TWO[:1], "pins alone"))
def test_the_same_sheet_has_the_same_bytes(at: tuple[str, float]) -> None:
    sheet = sheet_of(*at)
    assert polygon_file(sheet, ".svg") == svg_of(*at)
    assert polygon_file(sheet, ".pdf").startswith(b"%PDF")


@slow("a second of frames: the layers that they show are tested as drawings")
def test_an_animation_has_a_frame_for_each_layer_that_is_drawn() -> None:
    sheet = sheet_of("fourbar-lecture-1", 1.0, "A5")
    with Image.open(io.BytesIO(polygon_file(sheet, ".gif"))) as picture:
        # nothing; the table; driver, group, letters of each polygon; images of accelerations, as
        # those of velocities are the vectors themselves
        assert picture.n_frames == 1 + 1 + 2 * 3 + 1


@slow("24 sheets: what it finds beside the others is that the scales stay")
def test_over_a_turn_all_sheets_have_one_scale() -> None:
    with Image.open(io.BytesIO(turning_file(sheet_of("fourbar-lecture-1", 1.0, "A5")))) as picture:
        assert picture.n_frames == 24


def words_on(sheet: PolygonSheet) -> list[str]:
    return [text.get_text() for axes in draw_sheet(sheet, "").layers for text in axes.texts]


def test_ends_of_components_have_letters_as_the_lecture_has_them() -> None:
    assert {"n'CB", "n'CD", "b'", "c'"} <= {*words_on(sheet_of("fourbar-lecture-1", 1.0))}
    assert {"n'", "k'", "b(lever)'"} <= {*words_on(sheet_of("slotted-lever", 0.9))}


def test_the_table_says_what_the_images_of_links_are() -> None:
    words = words_on(sheet_of("scotch-yoke", 1.0))
    assert "v: one point, as omega is 0" in words
    assert "v: similar, 10 1/s, turned by 90°" in words


def test_a_table_without_room_asks_for_larger_paper() -> None:
    with pytest.raises(CrankcheckError, match=r"\d+ rows .* can not be read .* such as A3"):
        draw_sheet(sheet_of("squeezer", -0.6, "A5"), "")


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


@pytest.mark.parametrize(
    ("paper", "told"),
    [
        ("A7", "no size; use A5, A4"),
        ("100x50", "needs 180 x 120 mm"),
        ("0x0", "needs 180"),
        ("99999x99999", "at most 2000 mm"),
        ("nanx1", "no size"),
    ],
)
def test_paper_that_can_not_be_drawn_on_is_refused(paper: str, told: str) -> None:
    with pytest.raises(CrankcheckError, match=told):
        Paper.of(paper)


def embedded(page: str) -> dict:
    match = re.search(r'id="embedded-polygons">(.*?)</script>', page)
    return json.loads(match[1])  # type: ignore[no-any-return]  # an object, as it was written


def unpacked(packed: dict) -> Array:
    whole = np.frombuffer(base64.b64decode(packed["base64"]), "<i2").astype(float)
    whole[whole == -32768] = np.nan
    return whole.reshape(-1, packed["samples"]) * np.array(packed["scales"])[:, None]


def test_the_page_holds_the_polygons_of_each_instant() -> None:
    placed = placed_at_angle(load_scene("slotted-lever"), 50.0)
    own = embedded(polygon_page(placed))
    at = own["home"]
    assert own["drawing"]["told"]["at"][at] == pytest.approx(50.0)
    drawn = draw_polygons(placed.scene, placed.driver)
    for packed, polygon in zip(own["polygons"], (drawn.velocity, drawn.acceleration), strict=True):
        rows = unpacked(packed["rows"])[:, at].reshape(-1, 4)
        assert [one["name"] for one in packed["vectors"]] == [v.name for v in polygon.vectors]
        exact = np.array([[*v.start, *v.end] for v in polygon.vectors])
        assert rows == pytest.approx(exact, abs=2e-4 * np.abs(rows).max())


def test_of_a_link_that_does_not_turn_the_page_has_rates_of_exactly_0() -> None:
    own = embedded(polygon_page(placed_at_angle(load_scene("scotch-yoke"), 50.0)))
    rows = unpacked(own["links"]["rows"])
    number = own["links"]["names"].index("yoke")
    assert np.all(rows[2 * number : 2 * number + 2] == 0.0)


def test_a_speed_of_ones_own_is_that_of_a_whole_turn_if_the_driver_goes_through_one() -> None:
    placed = placed_at_angle(load_scene("fourbar-swing"), 90.0, 3.0)
    at = embedded(polygon_page(placed, steady=True))["drawing"]["told"]["at"]
    assert at[-1] - at[0] == pytest.approx(360.0)
    assert len(at) == INSTANTS
    scene = load_scene("fourbar-double-rocker")  # whose driver goes through no turn
    with pytest.raises(CrankcheckError):
        polygon_page(PlacedMechanism.of(scene, DriverState(1.0, 1.0)), steady=True)
