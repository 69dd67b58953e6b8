"""No label on a line or on another label, on any sheet; and the check that says so."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
import pytest

from analytic.drawings.drawn_polygons import draw_polygons
from analytic.drawings.placed_mechanism import DriverState
from analytic.kinematics import reach
from models.errors import CrankcheckError
from models.files import load_scene, shipped
from models.scene import Scene
from reports.sheets.canvas import Canvas, line, text
from reports.sheets.centre_sheet import centres_of, draw_centres
from reports.sheets.letters import Letter, write_letters
from reports.sheets.paper import Box, Paper
from reports.sheets.polygons.polygon_sheet import draw_sheet, laid_out
from reports.sheets.position_sheet import draw_positions, positions
from tests.reports.sheets.measured import overlaps
from tests.worlds.tiers import slow

A4, SMALLEST = Paper.of("A4"), Paper.of("180x120")
ROOM = Box(10.0, 10.0, 160.0, 100.0)


def sheet_with(*strokes: tuple[tuple[float, float], tuple[float, float], str]) -> Canvas:
    canvas = Canvas(SMALLEST)
    axes = canvas.layer("lines")
    for start, end, color in strokes:
        line(axes, np.array(start), np.array(end), color=color, linewidth=0.5)
    return canvas


def angles_of(scene: Scene, count: int) -> list[float]:
    """Driver angles over what it reaches, but for the limits themselves."""
    low, high = reach(scene)[0]
    if high - low > math.tau - 1e-6:
        return list(np.arange(count) * math.tau / count)
    spare = 0.04 * (high - low)
    return list(np.linspace(low + spare, high - spare, count))


def test_the_check_tells_words_on_lines_on_words_and_off_the_sheet() -> None:
    canvas = sheet_with(((20.0, 51.0), (60.0, 51.0), "black"))
    axes = canvas.layer("words")
    text(axes, 30.0, 50.0, "crossed")
    text(axes, 30.0, 80.0, "first")
    text(axes, 31.0, 80.5, "second")
    text(axes, 178.0, 20.0, "beyond")
    text(axes, 100.0, 52.0, "clear")
    told = overlaps(canvas.figure)
    assert told == ["'first' over 'second'", "'crossed' on a line", "'beyond' off the sheet"]


def test_a_letter_stands_beside_its_point_clear_of_the_lines_that_meet_there() -> None:
    ends = [(60.0 + 30.0 * math.cos(a), 60.0 + 30.0 * math.sin(a)) for a in np.arange(6.0)]
    canvas = sheet_with(*(((60.0, 60.0), end, "black") for end in ends))
    at = np.array([60.0, 60.0])
    write_letters(canvas, canvas.layer("letters"), [Letter(n, at, 1.0) for n in "ABC"], ROOM)
    assert overlaps(canvas.figure) == []
    spots = [np.array(t.get_position()) for t in canvas.layers[-1].texts]
    assert max(np.hypot(*(spot - at)) for spot in spots) < 10.0


def test_among_faint_lines_a_letter_interrupts_them_and_stays_near() -> None:
    fan = [((20.0, 58.0 + 0.8 * k), (100.0, 50.0 + 1.6 * k), "#a9b3bf") for k in range(20)]
    canvas = sheet_with(*fan)
    at = np.array([60.0, 65.0])
    write_letters(canvas, canvas.layer("letters"), [Letter("A", at, 0.5)], ROOM)
    assert overlaps(canvas.figure) == []
    assert np.hypot(*(np.array(canvas.layers[-1].texts[0].get_position()) - at)) < 6.0


def test_a_letter_that_stands_far_off_has_a_line_that_leads_to_it() -> None:
    grid = [((40.0, y), (80.0, y), "black") for y in np.arange(50.0, 70.0, 0.8)]
    canvas = sheet_with(*grid)
    write_letters(canvas, canvas.layer("letters"), [Letter("A", np.array([60.0, 60.0]), 0.5)], ROOM)
    assert overlaps(canvas.figure) == []
    (lead,) = canvas.layers[-1].lines
    assert np.hypot(lead.get_xdata()[1] - 60.0, lead.get_ydata()[1] - 60.0) == pytest.approx(0.5)


def test_labels_of_a_drawn_sheet_are_clear() -> None:
    drawn = draw_polygons(load_scene("sixbar-watt"), DriverState(1.0, 1.0))
    assert overlaps(draw_centres(centres_of(drawn, "coupler", A4), "note").figure) == []


def test_paper_too_low_for_the_bodies_of_a_sheet_is_refused_with_what_would_do() -> None:
    drawn = draw_polygons(load_scene("sixbar-watt"), DriverState(1.0, 1.0))
    with pytest.raises(
        CrankcheckError, match=r"180x120: .* 6 bodies and of the curves; 180x131 would do"
    ):
        centres_of(drawn, "coupler", SMALLEST)
    assert centres_of(drawn, "coupler", Paper.of("180x131")).scale > 0.0


@slow("labels that meet in one scene alone: two sheets for each, a second")
@pytest.mark.parametrize("name", shipped())
def test_labels_of_positions_are_clear(name: str) -> None:
    for divisions in (12, 24):
        sheet = positions(load_scene(name), divisions, A4)
        assert overlaps(draw_positions(sheet, "note").figure) == []


@slow("centres far off or on each other: six angles for each link of each scene")
@pytest.mark.parametrize("name", shipped())
def test_labels_of_centres_are_clear(name: str) -> None:
    for tag, canvas in centre_sheets(load_scene(name)):
        assert (tag, overlaps(canvas.figure)) == (tag, [])


def centre_sheets(scene: Scene) -> Iterator[tuple[str, Canvas]]:
    """All that can be drawn: where a link does not turn, its circles are refused."""
    for theta in angles_of(scene, 6):
        for link in ("", *scene.links):
            try:
                sheet = centres_of(draw_polygons(scene, DriverState(theta, 1.0)), link, A4)
            except CrankcheckError:
                continue
            yield f"{link or 'none'} at {math.degrees(theta):.1f} deg", draw_centres(sheet, "note")


@slow("polygons that fold up at some angle: six angles for each scene")
@pytest.mark.parametrize("name", shipped())
def test_labels_of_polygons_are_clear(name: str) -> None:
    scene = load_scene(name)
    for theta in angles_of(scene, 6):
        canvas = draw_sheet(laid_out(draw_polygons(scene, DriverState(theta, 10.0)), A4), "note")
        assert (theta, overlaps(canvas.figure)) == (theta, [])
