"""The sheet of a construction, measured."""

from __future__ import annotations

import math
import re
from dataclasses import replace
from functools import cache
from xml.etree import ElementTree

import numpy as np
import pytest

from analytic.kinematics import solve
from analytic.synthesis.construction import Circle, Curve, Dot, Segment, Step
from analytic.synthesis.examine import examine
from models.array import Array
from models.errors import CrankcheckError
from reports.figures.style import width_in
from reports.sheets.canvas import Canvas
from reports.sheets.constructions.construction_sheet import construction_sheet, laid_out
from reports.sheets.constructions.construction_view import ConstructionView
from reports.sheets.constructions.strokes import strokes, xy
from reports.sheets.paper import MM_PER_IN, Paper
from tests.reports.sheets.constructions.constructed import (
    burmester_curves,
    far_pole,
    rocker_by_angle,
    three_positions,
)
from tests.reports.sheets.overlaps import overlaps
from tests.worlds.tiers import few

A4, A5, UPRIGHT = Paper.of("A4"), Paper.of("A5"), Paper.of("210x297")
SVG = "{http://www.w3.org/2000/svg}"
MM_PER_POINT = 25.4 / 72.0
TENTH_MM = 0.1
EVERY = {
    "three positions": three_positions,
    "rocker by its angle": rocker_by_angle,
    "Burmester's curves": burmester_curves,
    "far pole": far_pole,
}


SHEETS = [(name, paper) for paper in (A4, UPRIGHT) for name in EVERY]
QUICK = [("Burmester's curves", A4), ("far pole", UPRIGHT)]


@cache
def sheet_of(name: str, paper: Paper = A4) -> Canvas:
    """The sheet, drawn once."""
    return construction_sheet(EVERY[name](), paper)


@cache
def measured(name: str, paper: Paper = A4) -> dict[str, list[Array]]:
    """The lines of the sheet, as they are in its file."""
    return drawn_lines(sheet_of(name, paper).saved("svg", "lines"))


def drawn_lines(svg: bytes) -> dict[str, list[Array]]:
    """The places (n, 2) [mm] of every line by its name, up to the sheet's own origin."""
    found: dict[str, list[Array]] = {}
    for group in ElementTree.fromstring(svg).iter(f"{SVG}g"):
        path = group.find(f"{SVG}path")
        if path is not None and group.get("id"):
            numbers = re.findall(r"-?\d+\.?\d*(?:e-?\d+)?", path.get("d"))
            places = np.array(numbers, float).reshape(-1, 2) * MM_PER_POINT
            found.setdefault(str(group.get("id")), []).append(places)
    return found


def layers(svg: bytes) -> list[str]:
    return re.findall(r'inkscape:label="([^"]*)"', svg.decode())


@pytest.mark.parametrize("name", ["three positions", "rocker by its angle"])
def test_links_measured_off_the_sheet_are_those_of_the_scene(name: str) -> None:
    examined = examine(EVERY[name]())
    sheet = laid_out(examined, A4)
    for link in examined.scene.links.values():
        (line,) = measured(name)[f"scheme-{link.name}"]
        first, last = (link.points[point] for point in link.points)
        length = math.dist(line[0], line[1]) * sheet.scale
        assert length == pytest.approx(math.dist(first, last), abs=TENTH_MM * sheet.scale)


def test_every_line_of_a_step_stands_where_the_construction_has_it() -> None:
    sheet = laid_out(three_positions(), A4)
    checked = 0
    for number, step in enumerate(sheet.view.steps, 1):
        for k, element in enumerate(step.elements, 1):
            if not isinstance(element, Segment):
                continue
            line = measured("three positions")[f"step-{number}.{k}"][0]
            ends = [sheet.at(xy(end)) for end in (element.start, element.end)]
            more = 1.0 + 2.0 * element.beyond
            assert np.hypot(*(line[1] - line[0])) == pytest.approx(
                more * math.dist(*ends), abs=TENTH_MM
            )
            assert line.mean(axis=0) * (1, -1) + (0, A4.height) == pytest.approx(
                np.mean(ends, axis=0), abs=TENTH_MM
            )
            checked += 1
    assert checked == 3 + 4 + 4 + 3


def test_the_radius_of_the_drawn_circle_is_the_crank() -> None:
    sheet = laid_out(rocker_by_angle(), A4)
    (circle,) = measured("rocker by its angle")["step-4.1"]
    crank = sheet.view.examined.scene.links["crank"].points
    assert np.ptp(circle[:, 0]) / 2 * sheet.scale == pytest.approx(
        math.dist(crank["O2"], crank["A"]), abs=TENTH_MM * sheet.scale
    )


def test_the_mechanism_stands_in_the_positions_that_are_asked_for() -> None:
    view = ConstructionView.of(three_positions())
    step = view.steps[0]
    asked = {each.letter: xy(each.place) for each in step.elements if isinstance(each, Dot)}
    for number, placed in enumerate(view.placements, 1):
        assert placed.points["C"] == pytest.approx(asked[f"C{number}"], abs=1e-9)
        assert placed.points["D"] == pytest.approx(asked[f"D{number}"], abs=1e-9)
    start = solve(view.examined.scene, np.zeros(1), bound=False)
    assert view.first.points["D"] == pytest.approx(start.points["D"].position[0], abs=1e-9)


def test_positions_that_the_driver_can_not_lead_to_are_drawn_and_told() -> None:
    examined = examine(burmester_curves())
    assert examined.defects == ["circuit defect"]
    sheet = laid_out(examined, A4)
    for position, placed in zip(examined.positions, sheet.view.placements, strict=True):
        assert placed is not None
        place = next(each.place for each in position.asked if hasattr(each, "place"))
        assert placed.points["P"] == pytest.approx(xy(place), abs=1e-9)
    assert "circuit defect" in [part.words for group in sheet.words for part in group]


def test_there_is_a_layer_for_each_step_and_the_same_sheet_has_the_same_bytes() -> None:
    svg = sheet_of("rocker by its angle").saved("svg", "layers")
    assert layers(svg) == [
        "frame",
        "positions",
        "step-1-The-rocker-O4-B-in-its-end-positions--70",
        "step-2-The-line-B1-B2--and-its-extension",
        "step-3-O2-is-chosen-on-the-extension",
        "step-4-Half-of-B1-B2-is-the-radius-of-a-circle",
        "step-5-The-crank-is-O2-A1--the-coupler-A1-B1",
        "mechanism",
        "letters",
    ]
    assert svg == construction_sheet(rocker_by_angle(), A4).saved("svg", "layers")
    assert sheet_of("rocker by its angle").saved("pdf", "layers").startswith(b"%PDF")


@pytest.mark.parametrize("case", few(SHEETS, QUICK, "words that meet on another sheet"), ids=str)
def test_no_letter_is_on_a_line_and_words_and_lines_stay_in_their_boxes(
    case: tuple[str, Paper],
) -> None:
    name, paper = case
    sheet, canvas = laid_out(EVERY[name](), paper), sheet_of(name, paper)
    low, high = sheet.box.corners
    for gid, lines in measured(name, paper).items():
        if gid.startswith("step-"):
            places = np.concatenate(lines) * (1, -1) + (0, paper.height)
            assert np.all((places > low - 0.01) & (places < high + 0.01)), gid
    low, high = sheet.column.corners
    words = canvas.named("frame").texts[2:]  # after title and note
    assert len(words) >= len(sheet.view.steps)
    for word in words:
        x, y = word.get_position()
        assert low[0] < x < x + MM_PER_IN * width_in(word.get_text()) < high[0]
        assert low[1] < y < high[1]
    assert overlaps(canvas.figure) == []


def test_an_arc_goes_from_its_one_angle_to_the_other() -> None:
    low, high = np.array([-1.0, -1.0]), np.array([1.0, 1.0])
    for start, end in ((0.2, 1.4), (5.0, 0.5), (-1.0, 2.0), (7.0, 7.5)):
        (line,) = strokes(Circle(0.1j, 0.5, arc=(start, end)), low, high)
        for place, angle in ((line[0], start), (line[-1], end)):
            exact = xy(0.1j + 0.5 * np.exp(1j * angle))
            assert place == pytest.approx(exact, abs=1e-12)
    # of a large one, as much as is in the box, wherever its angles begin
    for turn in (-math.tau, 0.0, math.tau):
        (line,) = strokes(Circle(-50.0 + 0j, 50.0, arc=(turn, turn + 0.01)), low, high)
        assert line[0] == pytest.approx((0.0, 0.0), abs=1e-9)
        assert line[-1] == pytest.approx(xy(-50.0 + 50.0 * np.exp(0.01j)), abs=1e-9)


def test_what_is_far_off_is_told_and_does_not_shrink_the_figure() -> None:
    near, far = laid_out(three_positions(), A4), laid_out(far_pole(), A4)
    assert far.scale == near.scale
    told = [part.words for group in far.words for part in group]
    assert "P12 at (-4.95, 25) m, 25.5 m from the middle towards 102°" in told
    assert any(words.startswith("a circle of step 5 with the radius 0.3 m") for words in told)
    assert not any("off the paper" in part.words.lower() for group in near.words for part in group)
    lines = measured("far pole")
    # the line to the pole, and the arc about it, which is almost across that
    (line,), (arc,) = lines["step-5.2"], lines["step-5.3"]
    along, across = line[-1] - line[0], arc[-1] - arc[0]
    assert abs(along @ across) < 0.02 * math.hypot(*along) * math.hypot(*across)


def test_curves_that_run_to_infinity_do_not_shrink_the_figure_or_jump_across_it() -> None:
    proposal = burmester_curves()
    plain = replace(
        proposal,
        steps=tuple(
            Step(step.words, tuple(each for each in step.elements if not isinstance(each, Curve)))
            for step in proposal.steps
        ),
    )
    assert laid_out(proposal, A4).scale == laid_out(plain, A4).scale
    lines = measured("Burmester's curves")
    pieces = [each for number in (3, 4) for each in lines[f"step-{number}.1"]]
    steps = np.concatenate([np.hypot(*np.diff(piece, axis=0).T) for piece in pieces])
    assert len(steps) > 200
    assert steps.max() < 60.0


def test_words_that_do_not_fit_are_refused_with_a_paper_that_would_do() -> None:
    proposal = three_positions()
    long = replace(proposal, steps=(*proposal.steps, Step("many words " * 300, ())))
    with pytest.raises(CrankcheckError, match=r"210x148: the words of 5 steps .* such as A3"):
        laid_out(long, A5)
    assert laid_out(long, Paper.of("A3")).scale > 0.0


def test_the_title_tells_the_scale_and_the_note_the_source() -> None:
    canvas = sheet_of("three positions")
    words = [text.get_text() for text in canvas.named("frame").texts]
    scale = laid_out(three_positions(), A4).scale
    assert f"three-positions: construction, position 1 of 3, K_l = {scale:g} m/mm" in words
    assert any("example 6" in each and "crankcheck" in each for each in words)
