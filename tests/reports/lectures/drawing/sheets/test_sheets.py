"""The sheet of positions, measured; no label on a line or on another label, on any sheet; and the
check that says so."""

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest
from matplotlib.axes import Axes

from analytic.kinematics import reach
from analytic.lectures.drawings.drawn_polygons import draw_polygons
from analytic.lectures.drawings.polygon import DriverState
from models.errors import CrankcheckError
from models.files.reading import load_scene, shipped
from models.scene import Point, Scene
from models.scene.laws import ConstantSpeed
from reports.lectures.drawing.sheets.centre_sheet import centres_of, draw_centres
from reports.lectures.drawing.sheets.letters import Letter, write_letters
from reports.lectures.drawing.sheets.paper import Box, Canvas, Paper, line
from reports.lectures.drawing.sheets.polygon_sheet import draw_sheet, laid_out
from reports.lectures.drawing.sheets.position_sheet import PositionSheet, draw_positions, positions
from reports.lectures.drawing.sheets.scheme import assembled
from tests.reports.lectures.drawing.sheets.measured import drawn_lines, overlaps
from tests.worlds.tiers import slow

A4, SMALLEST = Paper.of("A4"), Paper.of("180x120")


def lettered(letters: list[Letter], *strokes: tuple[Point, Point, str]) -> Axes:
    """The layer of letters that are written beside such lines, and clear of them."""
    canvas = Canvas(SMALLEST)
    axes = canvas.layer("lines")
    for start, end, color in strokes:
        line(axes, np.array(start), np.array(end), color=color, linewidth=0.5)
    write_letters(canvas, canvas.layer("letters"), letters, Box(10.0, 10.0, 160.0, 100.0))
    assert overlaps(canvas.figure) == []
    return canvas.layers[-1]


def angles_of(scene: Scene, count: int) -> list[float]:
    """Driver angles over what it reaches, but for the limits themselves."""
    low, high = reach(scene)[0]
    if high - low > math.tau - 1e-6:
        return list(np.arange(count) * math.tau / count)
    spare = 0.04 * (high - low)
    return list(np.linspace(low + spare, high - spare, count))


def test_a_letter_stands_clear_of_lines_near_its_point_or_has_a_line_that_leads_to_it() -> None:
    at = np.array([60.0, 60.0])
    ends = [(60.0 + 30.0 * math.cos(a), 60.0 + 30.0 * math.sin(a)) for a in np.arange(6.0)]
    lines = (((60.0, 60.0), end, "black") for end in ends)
    layer = lettered([Letter(n, at, 1.0) for n in "ABC"], *lines)
    assert max(np.hypot(*(np.array(t.get_position()) - at)) for t in layer.texts) < 10.0
    # Faint lines it interrupts.
    fan = [((20.0, 58.0 + 0.8 * k), (100.0, 50.0 + 1.6 * k), "#a9b3bf") for k in range(20)]
    among = np.array([60.0, 65.0])
    layer = lettered([Letter("A", among, 0.5)], *fan)
    assert np.hypot(*(np.array(layer.texts[0].get_position()) - among)) < 6.0
    grid = [((40.0, y), (80.0, y), "black") for y in np.arange(50.0, 70.0, 0.8)]
    (lead,) = lettered([Letter("A", at, 0.5)], *grid).lines
    assert np.hypot(lead.get_xdata()[1] - 60.0, lead.get_ydata()[1] - 60.0) == pytest.approx(0.5)


def test_labels_of_a_drawn_sheet_are_clear_on_paper_that_is_high_enough() -> None:
    drawn = draw_polygons(load_scene("sixbar-watt"), DriverState(1.0, 1.0))
    assert overlaps(draw_centres(centres_of(drawn, "coupler", A4), "note").figure) == []
    told = r"180x120: .* 6 bodies and of the curves; 180x131 would do"
    with pytest.raises(CrankcheckError, match=told):
        centres_of(drawn, "coupler", SMALLEST)
    assert centres_of(drawn, "coupler", Paper.of("180x131")).scale > 0.0


@slow("labels that meet in one scene alone: every sheet of each")
@pytest.mark.parametrize("name", shipped())
def test_labels_of_a_scene_are_clear_on_every_sheet(name: str) -> None:
    for tag, canvas in every_sheet(load_scene(name)):
        assert (tag, overlaps(canvas.figure)) == (tag, [])


def every_sheet(scene: Scene) -> Iterator[tuple[str, Canvas]]:
    """All that can be drawn: where a link does not turn, its circles are refused."""
    for divisions in (12, 24):
        yield f"{divisions} positions", draw_positions(positions(scene, divisions, A4), "note")
    for theta in angles_of(scene, 6):
        drawn = draw_polygons(scene, DriverState(theta, 10.0))
        yield f"polygons at {theta}", draw_sheet(laid_out(drawn, A4), "note")
        for link in ("", *scene.links):
            try:
                sheet = centres_of(drawn, link, A4)
            except CrankcheckError:
                continue
            yield f"centres, {link or 'none'} at {theta}", draw_centres(sheet, "note")


def sheet_of(name: str, divisions: int = 8) -> PositionSheet:
    return positions(load_scene(name), divisions, A4)


def test_the_crank_circle_is_divided_equally_from_the_start() -> None:
    sheet = sheet_of("fourbar-lecture-1")
    pins = sheet.points["B"]
    angles = np.unwrap(np.arctan2(pins[:, 1], pins[:, 0]))
    assert np.diff(angles) == pytest.approx(np.pi / 4)
    assert angles[0] == pytest.approx(sheet.scene.driver.law.at(np.zeros(1))[0][0])
    # Divisions that fall together are refused.
    with pytest.raises(CrankcheckError, match=r"at most \d+ fit, or take larger paper"):
        sheet_of("shaper", 300)


def test_a_driver_that_turns_or_swings_clockwise_is_numbered_in_its_sense() -> None:
    def driven(name: str, divisions: int, *law: float) -> PositionSheet:
        scene = load_scene(name)
        turning = replace(scene.driver, law=ConstantSpeed(*law))
        return positions(replace(scene, driver=turning), divisions, A4)

    turns = driven("fourbar-lecture-1", 8, 0.3, -10.0)
    assert np.diff(turns.angles) == pytest.approx(-np.pi / 4)
    swings = driven("fourbar-double-rocker", 6, 1.0, -1.0)
    assert np.all(np.diff(swings.angles) < 0.0)
    assert np.ptp(swings.angles) < np.pi
    assert swings.placement.driver.omega < 0.0


@pytest.mark.parametrize("name", ["shaper", "scotch-yoke", "fourbar-double-rocker"])
def test_everything_stands_within_the_frame_at_a_round_scale(name: str) -> None:
    sheet = sheet_of(name)
    places = np.concatenate([sheet.at(way) for way in sheet.loci.values()])
    low, high = sheet.box.corners
    assert np.all(places >= low)
    assert np.all(places <= high)
    mantissa = sheet.scale / 10.0 ** np.floor(np.log10(sheet.scale) + 1e-9)
    assert min(abs(mantissa - step) for step in (1.0, 2.0, 5.0)) < 1e-9


def test_the_drawn_locus_is_the_point_s_way_to_a_tenth_of_a_millimetre() -> None:
    sheet = sheet_of("slider-crank-offset")
    drawn = drawn_lines(draw_positions(sheet, "").saved("svg", "positions"))
    assert np.ptp(drawn["locus-C"][0][:, 0]) * sheet.scale == pytest.approx(
        np.ptp(sheet.loci["C"][:, 0]), abs=1e-4
    )


def test_singular_angles_are_left_out_one_by_one() -> None:
    degrees = np.array([0.0, 45.0, 90.0, 120.0])
    possible = assembled(load_scene("tangent"), np.radians(degrees))
    assert possible.tolist() == [True, True, False, True]
