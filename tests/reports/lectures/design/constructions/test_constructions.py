"""The sheet of a construction, measured, and what its page holds, which `tests.reports.page` opens;
and lines cut to a box, against what of them is in it by looking."""

import math
import re
from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from analytic.kinematics import solve
from analytic.lectures.synthesis import design
from analytic.lectures.synthesis.examine import examine
from models.array import Array
from models.errors import CrankcheckError
from reports.drawing.shape import turn_of
from reports.figures.style import width_in
from reports.lectures.design.construction_sheet import construction_sheet, laid_out
from reports.lectures.design.construction_view import (
    ConstructionView,
    positions_on_way,
    strokes,
    xy,
)
from reports.lectures.design.pages import INSTANTS, MOVES, construction_page
from reports.lectures.drawing.sheets.paper import (
    MM_PER_IN,
    Canvas,
    Paper,
    arc_places,
    cut_line,
    near_angles,
)
from tests.reports.lectures.design.constructions import constructed as made
from tests.reports.lectures.drawing.sheets.measured import TENTH_MM, drawn_lines, overlaps
from tests.reports.page.hostile import embedded_in
from tests.worlds.tiers import few

A4, A5, UPRIGHT = Paper.of("A4"), Paper.of("A5"), Paper.of("210x297")
EVERY = {
    "three positions": made.three_positions,
    "rocker by its angle": made.rocker_by_angle,
    "Burmester's curves": made.burmester_curves,
    "far pole": made.far_pole,
}
SHEETS = [(name, paper) for paper in (A4, UPRIGHT) for name in EVERY]
QUICK = [("far pole", UPRIGHT)]
"""The one with the most words."""


@cache
def sheet_of(name: str, paper: Paper = A4) -> Canvas:
    return construction_sheet(EVERY[name](), paper)


@cache
def measured(name: str, paper: Paper = A4) -> dict[str, list[Array]]:
    """The lines of the sheet, as they are in its file."""
    return drawn_lines(sheet_of(name, paper).saved("svg", "lines"))


def test_links_and_a_circle_measured_off_the_sheet_are_those_of_the_scene() -> None:
    examined = examine(made.rocker_by_angle())
    sheet, lines = laid_out(examined, A4), measured("rocker by its angle")
    for link in examined.scene.links.values():
        (line,) = lines[f"scheme-{link.name}"]
        first, last = (link.points[point] for point in link.points)
        length = math.dist(first, last) / sheet.scale
        assert math.dist(line[0], line[1]) == pytest.approx(length, abs=TENTH_MM)
    (circle,) = lines["step-4.1"]
    radius = math.dist(*examined.scene.links["crank"].points.values()) / sheet.scale
    assert np.ptp(circle[:, 0]) / 2 == pytest.approx(radius, abs=TENTH_MM)


def test_every_line_of_a_step_stands_where_the_construction_has_it() -> None:
    sheet = laid_out(made.three_positions(), A4)
    checked = 0
    for number, step in enumerate(sheet.view.steps, 1):
        for k, element in enumerate(step.elements, 1):
            if not isinstance(element, design.Segment):
                continue
            line = measured("three positions")[f"step-{number}.{k}"][0]
            ends = [sheet.at(xy(end)) for end in (element.start, element.end)]
            length = (1.0 + 2.0 * element.beyond) * math.dist(*ends)
            middle = line.mean(axis=0) * (1, -1) + (0, A4.height)
            assert math.dist(line[0], line[1]) == pytest.approx(length, abs=TENTH_MM)
            assert middle == pytest.approx(np.mean(ends, axis=0), abs=TENTH_MM)
            checked += 1
    assert checked == 3 + 4 + 4 + 3


def test_the_mechanism_stands_in_the_positions_that_are_asked_for() -> None:
    view = ConstructionView.of(made.three_positions())
    step = view.steps[0]
    asked = {each.letter: xy(each.place) for each in step.elements if isinstance(each, design.Dot)}
    for number, placed in enumerate(view.placements, 1):
        for name in "CD":
            assert placed.points[name] == pytest.approx(asked[f"{name}{number}"], abs=1e-9)
    start = solve(view.examined.scene, np.zeros(1), bound=False)
    assert view.first.points["D"] == pytest.approx(start.points["D"].position[0], abs=1e-9)


def test_positions_that_the_driver_can_not_lead_to_are_drawn_and_told() -> None:
    examined = examine(made.burmester_curves())
    assert examined.defects == ["circuit defect"]
    sheet = laid_out(examined, A4)
    for position, placed in zip(examined.positions, sheet.view.placements, strict=True):
        assert placed is not None
        place = next(each.place for each in position.asked if hasattr(each, "place"))
        assert placed.points["P"] == pytest.approx(xy(place), abs=1e-9)
    assert "circuit defect" in [part.words for group in sheet.words for part in group]


def test_there_is_a_layer_for_each_step_and_the_words_tell_the_scale_and_the_source() -> None:
    canvas = sheet_of("rocker by its angle")
    words = [text.get_text() for text in canvas.named("frame").texts]
    scale = laid_out(made.rocker_by_angle(), A4).scale
    assert f"rocker-by-angle: construction, position 1 of 2, K_l = {scale:g} m/mm" in words
    assert any("example 2" in each and "crankcheck" in each for each in words)
    svg = canvas.saved("svg", "layers")
    steps = [
        "The-rocker-O4-B-in-its-end-positions--70", "The-line-B1-B2--and-its-extension",
        "O2-is-chosen-on-the-extension", "Half-of-B1-B2-is-the-radius-of-a-circle",
        "The-crank-is-O2-A1--the-coupler-A1-B1",
    ]  # fmt: skip
    named = [f"step-{number}-{words}" for number, words in enumerate(steps, 1)]
    layers = re.findall(r'inkscape:label="([^"]*)"', svg.decode())
    assert layers == ["frame", "positions", *named, "mechanism", "letters"]


@pytest.mark.parametrize("case", few(SHEETS, QUICK, "words that meet on another sheet"), ids=str)
def test_no_letter_is_on_a_line_and_all_stays_in_its_box(case: tuple[str, Paper]) -> None:
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
        (line,) = strokes(design.DrawnCircle(0.1j, 0.5, arc=(start, end)), low, high)
        for place, angle in ((line[0], start), (line[-1], end)):
            exact = xy(0.1j + 0.5 * np.exp(1j * angle))
            assert place == pytest.approx(exact, abs=1e-12)
    # of a large one, as much as is in the box, wherever its angles begin
    for turn in (-math.tau, 0.0, math.tau):
        (line,) = strokes(design.DrawnCircle(-50.0 + 0j, 50.0, arc=(turn, turn + 0.01)), low, high)
        assert line[0] == pytest.approx((0.0, 0.0), abs=1e-9)
        assert line[-1] == pytest.approx(xy(-50.0 + 50.0 * np.exp(0.01j)), abs=1e-9)


def test_what_is_far_off_is_told_and_does_not_shrink_the_figure() -> None:
    near, far = laid_out(made.three_positions(), A4), laid_out(made.far_pole(), A4)
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


def test_curves_that_run_to_infinity_do_not_shrink_the_figure() -> None:
    proposal = made.burmester_curves()
    plain = replace(proposal, steps=(proposal.steps[0], proposal.steps[3]))
    assert laid_out(proposal, A4).scale == laid_out(plain, A4).scale


def test_words_that_do_not_fit_are_refused_with_a_paper_that_would_do() -> None:
    proposal = made.three_positions()
    long = replace(proposal, steps=(*proposal.steps, design.DrawingStep("many words " * 300, ())))
    with pytest.raises(CrankcheckError, match=r"210x148: the words of 5 steps .* such as A3"):
        laid_out(long, A5)
    assert laid_out(long, Paper.of("A3")).scale > 0.0


@pytest.mark.parametrize("make", [made.rocker_by_angle, made.burmester_curves])
def test_the_page_holds_every_step_and_its_words(make: Callable[[], design.Proposal]) -> None:
    proposal = make()
    page = construction_page(proposal)
    words = re.findall(r"<li><button type=\"button\">(.*?)</button></li>", page)
    assert words == [*(step.words for step in proposal.steps), MOVES]
    for step, drawn in zip(proposal.steps, embedded_in(page, "construction")["steps"], strict=True):
        for element, own in zip(step.elements, drawn, strict=True):
            if isinstance(element, design.Dot):
                assert own["at"] == pytest.approx(xy(element.place), rel=1e-5, abs=1e-12)
                assert own["letter"] == element.letter
            if isinstance(element, design.Segment) and not element.beyond:
                (ends,) = own["lines"]
                length = math.dist(ends[:2], ends[2:])
                assert length == pytest.approx(abs(element.end - element.start), rel=1e-5)
            if isinstance(element, design.DrawnCircle):
                places = np.concatenate(own["lines"]).reshape(-1, 2)
                away = np.hypot(*(places - xy(element.centre)).T)
                assert away == pytest.approx(element.radius, rel=1e-5)
            if isinstance(element, design.DrawnCurve):
                assert own["look"].startswith("curve-")
                assert own["lines"]


def test_the_motion_meets_each_position_where_the_page_stops() -> None:
    view = ConstructionView.of(made.three_positions())
    motion = turn_of(view.examined.scene, INSTANTS)
    theta = motion.links["input"].theta
    for at, position in zip(positions_on_way(view, motion), view.examined.positions, strict=True):
        assert at is not None
        here = np.interp(at, np.arange(INSTANTS), theta)
        assert math.remainder(here - position.driver_rad, math.tau) == pytest.approx(0.0, abs=1e-9)


def test_a_position_that_the_driver_can_not_lead_to_is_no_stop_and_what_is_chosen_is_told() -> None:
    page = construction_page(made.burmester_curves())
    own = embedded_in(page, "construction")
    assert None in own["at"]
    assert own["at"][0] is not None
    assert len(own["poses"]) == 4
    assert "It has a defect: circuit defect." in page
    chosen = "Chosen: O2 from the middle of B1 B2, 0.3 m."
    assert chosen in construction_page(made.rocker_by_angle())


def test_hostile_words_are_text() -> None:
    proposal = made.three_positions()
    evil = "</script><script>window.hacked=1</script><img src=x>"
    steps = (*proposal.steps, design.DrawingStep(evil, (design.Dot(0j, evil),)))
    page = construction_page(replace(proposal, steps=steps, doubt=evil, chosen={evil: evil}))
    assert "<img" not in page
    assert "<script>window" not in page


LOW, HIGH = np.array([-1.0, -0.5]), np.array([2.0, 1.0])


def test_a_line_is_cut_to_as_long_as_it_is_in_the_box() -> None:
    random = np.random.default_rng(3)
    for start, end in random.uniform(-4.0, 4.0, (50, 2, 2)):
        along = start + np.linspace(0.0, 1.0, 20001)[:, None] * (end - start)
        inside = np.all((along >= LOW) & (along <= HIGH), axis=1).mean()
        parts = cut_line(np.array([start, end]), LOW, HIGH)
        assert len(parts) <= 1
        kept = sum(math.dist(part[0], part[-1]) for part in parts)
        assert kept / math.dist(start, end) == pytest.approx(inside, abs=2e-4)


def test_a_line_that_leaves_and_comes_back_has_two_parts_and_one_that_stays_has_one() -> None:
    out = np.array([[0.0, 0.0], [0.0, 2.0], [1.0, 2.0], [1.0, 0.0], [1.5, 0.0]])
    first, second = cut_line(out, LOW, HIGH)
    assert first == pytest.approx(np.array([[0.0, 0.0], [0.0, 1.0]]))
    assert second == pytest.approx(np.array([[1.0, 1.0], [1.0, 0.0], [1.5, 0.0]]))
    (whole,) = cut_line(out[[0, 3, 4]], LOW, HIGH)
    assert len(whole) == 3
    far = np.array([[0.0, 0.0], [1.0, 0.5], [40.0, 20.0], [-40.0, -20.0], [-0.5, -0.25]])
    assert [len(part) for part in cut_line(far, LOW, HIGH)] == [3, 2]
    assert len(cut_line(np.array([[-1.0, 0.0], [-1.0, 0.5]]), LOW, HIGH)) == 1  # on the edge
    assert cut_line(np.array([[3.0, -3.0], [3.0, 3.0]]), LOW, HIGH) == []


@pytest.mark.parametrize("radius", [5.0, 5e5])
def test_of_a_large_circle_all_that_is_in_the_box_is_kept(radius: float) -> None:
    middle = np.array([0.3, 0.1]) + radius * np.array([math.cos(1.0), math.sin(1.0)])
    arc = arc_places(middle, radius, *near_angles(middle, radius, LOW, HIGH))
    (part,) = cut_line(arc, LOW, HIGH)
    for end in (part[0], part[-1]):
        assert min(np.abs(np.concatenate([end - LOW, end - HIGH]))) < 1e-9
    assert len(part) > 100
