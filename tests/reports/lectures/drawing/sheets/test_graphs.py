"""The sheet of graphs: construction on paper, what fits, and what is refused; and graphs of a log:
what it adds to the error of the drawing, and which logs are refused."""

import itertools
import math
from collections.abc import Callable
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg

from analytic.lectures.drawings.graphical import METHODS, Method
from models.array import Array
from models.errors import CrankcheckError
from models.files.reading import load_scene
from reports.figures.style import SMALL, styled
from reports.lectures.drawing.sheets.graph_drawing import DrawnGraphs, drawn_graphs, graph_log
from reports.lectures.drawing.sheets.graph_orders import ErrorLine, graph_errors
from reports.lectures.drawing.sheets.graph_page import caption, draw_graphs, laid_out
from reports.lectures.drawing.sheets.graph_sheet import POLES_MM, GraphSheet, graph_scales
from reports.lectures.drawing.sheets.graph_span import Over, over_period
from reports.lectures.drawing.sheets.graph_words import table_cells, told_log
from reports.lectures.drawing.sheets.paper import Paper
from tests.reports.lectures.drawing.sheets.measured import drawn_lines
from tests.worlds.tiers import slowly

LECTURE = load_scene("fourbar-lecture-1")
PERIOD = LECTURE.driver.law.period_s
ROCKER = over_period(LECTURE, "rocker", "time", None)
EVEN = np.arange(0, 721) * PERIOD / 720
Write = Callable[..., Path]


@cache
def sheet_of(
    name: str, of: str, by: Method = "chords", divisions: int = 24, over: Over = "time",
    paper: str = "A4",
) -> GraphSheet:  # fmt: skip
    ranged = over_period(load_scene(name), of, over, None)
    return laid_out(drawn_graphs(ranged, by, divisions), Paper.of(paper))


@cache
def lines_of(by: Method) -> dict[str, list[Array]]:
    sheet = sheet_of("fourbar-lecture-1", "rocker", by, 12)
    return drawn_lines(draw_graphs(sheet, "").saved("svg", "graphs"))


def slopes(by: Method, name: str) -> Array:
    """Rise over run of the numbered lines of a drawing."""
    drawn = lines_of(by)
    names = itertools.takewhile(drawn.__contains__, (f"{name}-{k}" for k in itertools.count()))
    x, y = np.array([drawn[each][0][1] - drawn[each][0][0] for each in names]).T
    return -y / x


@pytest.mark.parametrize(
    ("by", "line", "ray"),
    [
        ("chords", "chord-phi", "ray-omega"),
        ("tangents", "tangent-omega", "ray-epsilon"),
        slowly("integration", "step-omega", "ray-epsilon", reason="as of phi"),
        ("integration", "step-phi", "ray-omega"),
    ],
)
def test_rays_are_parallel_on_paper_to_what_they_are_of(by: Method, line: str, ray: str) -> None:
    rays = slopes(by, ray)
    assert len(rays) >= 8
    # lines of 10 mm are written to a millionth of a point
    assert slopes(by, line) == pytest.approx(rays, abs=1e-5)


def test_scales_of_integration_are_those_of_the_problem_book() -> None:
    sheet = sheet_of("fourbar-lecture-1", "rocker", "integration", 12)
    second, first, value = sheet.panels
    assert (second.order, first.order, value.order) == (2, 1, 0)
    assert first.scale == pytest.approx(second.pole_mm * sheet.scale_x * second.scale)
    assert value.scale == pytest.approx(first.pole_mm * sheet.scale_x * first.scale)
    assert math.isnan(value.pole_mm)
    assert "from 4.67615 rad/s on (exact)" in caption(sheet, first)
    texts = [text for axes in draw_graphs(sheet, "").figure.axes for text in axes.texts]
    assert SMALL in [
        text.get_fontsize() for text in texts if text.get_text() == caption(sheet, first)
    ]


@pytest.mark.parametrize("by", METHODS)
@pytest.mark.parametrize("heights", [(1.0, 6.0, 90.0), (1.0, 1e-3, 1e-6), (1e-6, 10.0, 4e3)])
def test_heights_fit_with_one_scale_round(by: Method, heights: tuple[float, float, float]) -> None:
    scales = graph_scales(by, heights, 0.003, 45.0)
    high = np.array(heights) / scales.units_per_mm
    assert high.max() <= 45.0 * (1.0 + 1e-8)
    read = 2 if by == "integration" else 0
    assert f"{scales.units_per_mm[read]:.1e}"[:3] in ("1.0", "2.0", "5.0")
    assert {pole for pole in scales.poles_mm if not math.isnan(pole)} <= set(POLES_MM)


@pytest.mark.parametrize(
    ("name", "of", "by", "paper"),
    [("shaper", "E.y", "tangents", "A3"), ("whitworth", "lever", "integration", "A5")],
)
def test_graphs_and_table_stay_in_their_boxes(name: str, of: str, by: Method, paper: str) -> None:
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


def test_over_another_driver_s_angle_rates_are_analogues_which_no_log_has(write: Write) -> None:
    sheet = sheet_of("fourbar-double-rocker", "rocker", over="angle")
    of = sheet.drawn.span
    assert (of.symbols[1], of.units[1]) == ("phi'", "rad/rad")
    assert np.degrees([of.start, of.end]) == pytest.approx([27.0, 57.0])
    # its rate over that of the driver, at an instant in the middle of the swing
    at = over_period(load_scene("fourbar-double-rocker"), "rocker", "time", None)
    driver = at.scene.driver.law.at(np.zeros(1))
    assert of.exact(1, driver[0]) == pytest.approx(at.exact(1, np.zeros(1)) / driver[1])
    assert sheet.drawn.off(sheet.drawn.reference, 1) < 0.002
    with pytest.raises(CrankcheckError, match="which no log has; use --over time"):
        graph_log(write(time_s=EVEN), None, of)


@pytest.mark.parametrize(
    ("scene", "of", "over", "duration", "told"),
    [
        ("fourbar-lecture-1", "roker", "time", None, "did you mean rocker"),
        ("fourbar-lecture-1", "C.z", "time", None, "--of C.z"),
        ("fourbar-lecture-1", "D.x", "time", None, "stands still"),
        ("fourbar-lecture-1", "rocker", "time", 2.0, "drawn over its period of 0.628319 s"),
        ("fourbar-swing", "rocker", "time", None, "free motion has no period.*--duration"),
        ("fourbar-swing", "rocker", "angle", 1.0, "may turn back; use --over time"),
        ("fourbar-elastic-pulse", "rocker", "time", 0.1, "coupler is elastic .*`crankcheck solve`"),
        ("fourbar-swing", "rocker", "time", math.nan, "give seconds above 0"),
        ("fourbar-swing", "rocker", "time", 0.0, "give seconds above 0"),
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


def ripple(t: Array, order: int = 0) -> Array:
    """An engine's error: seven waves a period of a ten-thousandth [rad], and its rates."""
    rate = 7.0 * 10.0
    return 1e-4 * rate**order * np.sin(rate * t + order * math.pi / 2)


@pytest.fixture
def write(tmp_path: Path) -> Write:
    def log(**columns: Array) -> Path:
        path = tmp_path / "run.csv"
        rows = np.column_stack(list(columns.values()))
        np.savetxt(path, rows, "%.15g", ",", header=",".join(columns), comments="")
        return path

    return log


def drawn(path: Path, parts: int = 24, by: Method = "chords") -> DrawnGraphs:
    log = graph_log(path, None, ROCKER)
    return drawn_graphs(log.span, by, parts, log)


def test_an_exact_log_is_drawn_as_the_reference_is(write: Write) -> None:
    graphs = drawn(write(time_s=EVEN, rocker_theta_rad=ROCKER.exact(0, EVEN)))
    assert graphs.own_part(1) < 1e-12
    assert graphs.off(graphs.logged, 1) == pytest.approx(graphs.off(graphs.reference, 1))
    assert told_log(graphs)[1:] == [
        "phi is read in period 1 of the driver, the first whole one in it, at its rows; it is off "
        "by up to 0 %"
    ]


def test_readings_are_taken_between_rows_and_between_turns(write: Write) -> None:
    t = np.linspace(0.0, 1.1 * PERIOD, 500)
    degrees = np.degrees(ROCKER.exact(0, t))
    wrapped = (degrees + 60.0) % 360.0  # a rocker of 94 to 154 deg, and its encoder's zero
    graphs = drawn(write(time_s=t, rocker_deg=wrapped - 60.0))
    assert graphs.own_part(0) < 1e-8
    told = "by cubic splines between its rows, 0.00139 s apart, which add up to"
    assert told in told_log(graphs)[1]


def test_a_log_that_begins_later_is_drawn_from_there_or_its_next_period_on(write: Write) -> None:
    for periods, start in ((1, 0.3), (2, PERIOD)):
        t = 0.3 + np.arange(0, 720 * periods + 1) * PERIOD / 720
        graphs = drawn(write(time_s=t, rocker_theta_rad=ROCKER.exact(0, t)))
        assert (graphs.span.start, graphs.span.end) == pytest.approx((start, start + PERIOD))
        assert graphs.own_part(2) < 1e-9


def test_what_is_let_go_is_drawn_from_its_start_on(write: Write) -> None:
    of = over_period(load_scene("fourbar-swing"), "rocker", "time", 0.5)
    t = np.linspace(0.0, 0.6, 601)
    log = write(time_s=t, rocker_theta_rad=of.exact(0, np.minimum(t, 0.5)))
    graphs = drawn_graphs(of, "chords", 100, graph_log(log, None, of))
    assert graphs.own_part(0) < 1e-9
    assert graphs.span.end == 0.5
    assert graphs.off(graphs.reference, 1) < 0.009
    late = write(time_s=t[100:], rocker_theta_rad=of.exact(0, np.minimum(t[100:], 0.5)))
    with pytest.raises(CrankcheckError, match=r"those from 0 s to 0\.5 s"):
        graph_log(late, None, of)


def test_own_rates_and_rays_of_a_log_are_layers_whose_words_are_clear(write: Write) -> None:
    theta, omega = ROCKER.exact(0, EVEN), ROCKER.exact(1, EVEN) + ripple(EVEN, 1)
    graphs = drawn(write(time_s=EVEN, rocker_theta_rad=theta, rocker_omega_rad_s=omega))
    canvas = draw_graphs(laid_out(graphs, Paper.of("180x120")), "a source")
    drawing = canvas.saved("svg", "").decode()
    for layer in ("rays-omega-log", "graph-epsilon-log", "own-omega"):
        assert f'id="layer-{layer}"' in drawing
    assert 'id="layer-own-epsilon"' not in drawing  # which it has not
    assert "as logged" in drawing
    assert told_log(graphs)[-1].startswith("as logged, at the divisions: omega off by up to 0.1")
    with styled():
        agg = FigureCanvasAgg(canvas.figure)
        agg.draw()
    texts = [text for axes in canvas.figure.axes for text in axes.texts]
    boxes = [text.get_window_extent(agg.get_renderer()).padded(-1.0) for text in texts]
    for one, other in itertools.combinations(range(len(texts)), 2):
        assert not boxes[one].overlaps(boxes[other]), (texts[one], texts[other])
    assert all(box.x0 > 0.0 and box.x1 < canvas.figure.bbox.width for box in boxes)


def test_an_accelerometer_is_integrated_from_the_exact_start(write: Write) -> None:
    alpha = ROCKER.exact(2, EVEN) + ripple(EVEN, 2)
    graphs = drawn(write(time_s=EVEN, rocker_alpha_rad_s2=alpha), parts=96, by="integration")
    # the ripple's rate starts at 7e-3 rad/s, which the exact constant leaves out
    assert graphs.own_part(1) == pytest.approx(2 * 7e-3 / graphs.sizes[1], rel=0.02)


@pytest.mark.parametrize("by", METHODS)
def test_errors_of_a_log_fall_by_the_same_order_to_its_own(write: Write, by: Method) -> None:
    fine = np.arange(0, 2881) * PERIOD / 2880
    theta, alpha = (ROCKER.exact(k, fine) + 1e-3 * ripple(fine, k) for k in (0, 2))
    file = write(time_s=fine, rocker_theta_rad=theta, rocker_alpha_rad_s2=alpha)
    divisions = (24, 48, 96, 192)
    for line in graph_errors(ROCKER, by, divisions, graph_log(file, None, ROCKER)).lines:
        expected = None if line.is_own else pytest.approx(2.0, abs=0.1)
        assert line.order(divisions) == expected


def test_an_order_is_told_of_what_falls_alone() -> None:
    for errors, own, expected in (
        ((16.0, 4.0, 1.0), (), 2.0),
        ((16.0, 4.0, 1.1), (0.1, 0.1, 0.1), 1.93),
        ((16.0, 4.5, 1.9), (1.0, 1.0, 1.0), None),  # most of the last is the log's own
        ((16.0, 4.0, 3.9), (), None),  # two slopes, and none of them fitted
        ((16.0, 0.0, 0.0), (), None),
    ):
        order = ErrorLine("log", "omega", errors, own).order((24, 48, 96))
        assert order == (expected if expected is None else pytest.approx(expected, abs=0.01))


def test_a_log_at_another_speed_is_drawn_with_a_doubt(write: Write) -> None:
    angle = ROCKER.exact(0, 1.3 * EVEN)  # which begins as the scene does
    told = told_log(drawn(write(time_s=EVEN, rocker_theta_rad=angle)))
    assert "half of its places of rocker have errors of" in told[2]


THETA, SHORT = ROCKER.exact(0, EVEN), EVEN <= 0.4
ONCE = {"time_s": EVEN, "rocker_theta_rad": THETA}
CUT = {name: column[SHORT] for name, column in ONCE.items()}
LATE = ONCE | {"rocker_theta_rad": ROCKER.exact(0, EVEN + 0.2)}
UNFIT: list[tuple[dict[str, Array], str]] = [
    (CUT, "to 0.628319 s: log 0.628319 s or more"),
    (LATE, "another scene, speed, start or unit"),
    ({"time_s": EVEN, "lever_theta_rad": THETA}, "no column belongs to scene"),
    ({"time_s": EVEN, "crank_theta_rad": 0.5 * np.pi + 10.0 * EVEN}, "no column gives rocker"),
    (
        {"time_s": EVEN, "rocker_omega_rad_s": ROCKER.exact(1, EVEN)},
        r"\(found rates\); log places$",
    ),
    ({name: column[::360] for name, column in ONCE.items()}, "found fewer than 4 rows of it"),
    ({name: column[::60] for name, column in ONCE.items()}, "13 rows in the period"),
    (ONCE | {"rocker_theta_rad": np.where(SHORT, THETA, np.nan)}, "nan"),
]


@pytest.mark.parametrize(("columns", "told"), UNFIT)
def test_a_log_that_is_unfit_is_refused(write: Write, columns: dict[str, Array], told: str) -> None:
    with pytest.raises(CrankcheckError, match=told):
        drawn(write(**columns))
