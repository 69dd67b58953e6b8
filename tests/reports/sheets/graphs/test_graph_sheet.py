"""The sheet of graphs: construction on paper, what fits, and what is refused."""

from __future__ import annotations

import itertools
import math
import re
from functools import cache
from xml.etree import ElementTree

import numpy as np
import pytest

from analytic.drawings.graphical import METHODS, Method
from models.array import Array
from models.errors import CrankcheckError
from models.files import load_scene
from reports.sheets.graphs.graph_drawing import drawn_graphs
from reports.sheets.graphs.graph_page import caption, draw_graphs, laid_out
from reports.sheets.graphs.graph_scales import POLES_MM, graph_scales
from reports.sheets.graphs.graph_sheet import GraphSheet
from reports.sheets.graphs.graph_span import Over, over_period
from reports.sheets.graphs.graph_table import table_cells
from reports.sheets.paper import Paper

SVG = "{http://www.w3.org/2000/svg}"
MM_PER_POINT = 25.4 / 72.0


@cache
def sheet_of(
    name: str, of: str, by: Method = "chords", divisions: int = 24, over: Over = "time",
    paper: str = "A4",
) -> GraphSheet:  # fmt: skip
    ranged = over_period(load_scene(name), of, over, None)
    return laid_out(drawn_graphs(ranged, by, divisions), Paper.of(paper))


@cache
def drawing_of(by: Method) -> ElementTree.Element:
    sheet = sheet_of("fourbar-lecture-1", "rocker", by, 12)
    return ElementTree.fromstring(draw_graphs(sheet, "").saved("svg", "graphs"))


def slopes(drawing: ElementTree.Element, name: str) -> Array:
    """Rise over run of the numbered lines of an SVG."""
    groups = {group.get("id"): group for group in drawing.iter(f"{SVG}g")}
    names = itertools.takewhile(groups.__contains__, (f"{name}-{k}" for k in itertools.count()))
    paths = [groups[each].find(f"{SVG}path").get("d") for each in names]
    ends = np.array([[float(n) for n in re.findall(r"-?\d+\.?\d*", path)] for path in paths])
    return -(ends[:, 3] - ends[:, 1]) / (ends[:, 2] - ends[:, 0])


@pytest.mark.parametrize(
    ("by", "line", "ray"),
    [
        ("chords", "chord-phi", "ray-omega"),
        ("tangents", "tangent-omega", "ray-epsilon"),
        ("integration", "step-omega", "ray-epsilon"),
        ("integration", "step-phi", "ray-omega"),
    ],
)
def test_rays_are_parallel_on_paper_to_what_is_drawn_of_them(
    by: Method, line: str, ray: str
) -> None:
    drawing = drawing_of(by)
    rays = slopes(drawing, ray)
    assert len(rays) >= 8
    # lines of 10 mm are written to a millionth of a point
    assert slopes(drawing, line) == pytest.approx(rays, abs=1e-5)


def test_scales_of_integration_are_those_of_the_problem_book() -> None:
    sheet = sheet_of("fourbar-lecture-1", "rocker", "integration", 12)
    second, first, value = sheet.panels
    assert (second.order, first.order, value.order) == (2, 1, 0)
    assert first.scale == pytest.approx(second.pole_mm * sheet.scale_x * second.scale)
    assert value.scale == pytest.approx(first.pole_mm * sheet.scale_x * first.scale)
    assert math.isnan(value.pole_mm)
    assert "from 4.67615 rad/s on (exact)" in caption(sheet, first)


@pytest.mark.parametrize("by", METHODS)
@pytest.mark.parametrize("heights", [(1.0, 6.0, 90.0), (1.0, 1e-3, 1e-6), (1e-6, 10.0, 4e3)])
def test_graphs_of_any_heights_fit_with_one_scale_round(
    by: Method, heights: tuple[float, float, float]
) -> None:
    scales = graph_scales(by, heights, 0.003, 45.0)
    high = np.array(heights) / scales.units_per_mm
    assert high.max() <= 45.0 * (1.0 + 1e-8)
    read = 2 if by == "integration" else 0
    assert f"{scales.units_per_mm[read]:.1e}"[:3] in ("1.0", "2.0", "5.0")
    assert {pole for pole in scales.poles_mm if not math.isnan(pole)} <= set(POLES_MM)


@pytest.mark.parametrize(
    ("name", "of", "by", "paper"),
    [
        ("slider-crank-offset", "C", "chords", "A4"),
        ("shaper", "E.y", "tangents", "A3"),
        ("whitworth", "lever", "integration", "A5"),
        ("fourbar-lecture-1", "crank", "integration", "A4"),
    ],
)
def test_graphs_and_table_stay_within_their_boxes(
    name: str, of: str, by: Method, paper: str
) -> None:
    sheet = sheet_of(name, of, by, paper=paper)
    for panel in sheet.panels:
        exact = sheet.drawn.span.exact(panel.order, sheet.drawn.span.dense)
        high = panel.height_mm(np.concatenate([exact, sheet.drawn.reference.graphs[panel.order].y]))
        assert panel.box.bottom - 0.01 <= high.min()
        assert high.max() <= panel.box.bottom + panel.box.height + 0.01
    assert sheet.table.left + sheet.table.width <= sheet.paper.width - 8.0
    part = sheet.panels[0].box.width / sheet.drawn.parts
    assert 2.0 * part == pytest.approx(round(2.0 * part))  # half millimetres of a ruler


def test_the_table_has_division_angle_and_value() -> None:
    no, degrees, phi = table_cells(sheet_of("fourbar-lecture-1", "rocker").drawn)
    assert (no[2], degrees[2], phi[2]) == ("0", "90.00", "1.9085")
    assert (no[-1], degrees[-1], phi[-1]) == ("24", "450.00", "1.9085")
    no, degrees, _ = table_cells(sheet_of("fourbar-lecture-1", "rocker", "integration").drawn)
    assert (no[2], degrees[2], len(no)) == ("0.5", "97.50", 26)


def test_over_the_angle_of_a_steady_driver_rates_are_rates() -> None:
    time, angle = (
        sheet_of("fourbar-lecture-1", "rocker", over=over).drawn for over in ("time", "angle")
    )
    assert angle.span.units == time.span.units
    assert angle.reference.graphs[2].y == pytest.approx(time.reference.graphs[2].y)
    assert angle.span.shown == pytest.approx(math.degrees(10.0))


def test_over_the_angle_of_another_driver_rates_are_analogues() -> None:
    sheet = sheet_of("fourbar-double-rocker", "rocker", over="angle")
    of = sheet.drawn.span
    assert (of.symbols[1], of.units[1]) == ("phi'", "rad/rad")
    assert np.degrees([of.start, of.end]) == pytest.approx([27.0, 57.0])
    # its rate over that of the driver, at an instant in the middle of the swing
    at = over_period(load_scene("fourbar-double-rocker"), "rocker", "time", None)
    driver = at.scene.driver.law.at(np.zeros(1))
    assert of.exact(1, driver[0]) == pytest.approx(at.exact(1, np.zeros(1)) / driver[1])
    assert sheet.drawn.off(sheet.drawn.reference, 1) < 0.002


def test_what_is_let_go_is_drawn_for_a_duration() -> None:
    scene = load_scene("fourbar-swing")
    drawn = drawn_graphs(over_period(scene, "rocker", "time", 0.5), "chords", 96)
    assert drawn.span.end == 0.5
    assert drawn.off(drawn.reference, 1) < 0.01


@pytest.mark.parametrize(
    ("scene", "of", "over", "duration", "told"),
    [
        ("fourbar-lecture-1", "roker", "time", None, "did you mean rocker"),
        ("fourbar-lecture-1", "C.z", "time", None, "--of C.z"),
        ("fourbar-lecture-1", "D.x", "time", None, "stands still"),
        ("fourbar-lecture-1", "rocker", "time", 2.0, "drawn over its period of 0.628319 s"),
        ("fourbar-swing", "rocker", "time", None, "let go, and has no period.*--duration"),
        ("fourbar-swing", "rocker", "angle", 1.0, "may turn back; use --over time"),
        ("fourbar-elastic-pulse", "rocker", "time", 0.1, "coupler bends .*`crankcheck solve`"),
        ("fourbar-swing", "rocker", "time", math.nan, "give seconds above 0"),
    ],
)
def test_what_can_not_be_drawn_is_refused(
    scene: str, of: str, over: Over, duration: float | None, told: str
) -> None:
    with pytest.raises(CrankcheckError, match=told):
        over_period(load_scene(scene), of, over, duration)


def test_more_parts_than_paper_has_room_for_are_refused() -> None:
    with pytest.raises(CrankcheckError, match=r"at most \d+ fit, or take larger paper"):
        sheet_of("fourbar-lecture-1", "rocker", divisions=120)
