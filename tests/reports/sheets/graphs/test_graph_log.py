"""Graphs of a log: what it adds to the error of the drawing, and which logs are refused."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg

from analytic.drawings.graphical import Method
from models.array import Array
from models.errors import CrankcheckError
from models.files import load_scene
from reports.figures.style import styled
from reports.sheets.graphs.graph_drawing import DrawnGraphs, drawn_graphs
from reports.sheets.graphs.graph_log import graph_log
from reports.sheets.graphs.graph_orders import ErrorLine, graph_errors
from reports.sheets.graphs.graph_orders_sheet import draw_errors
from reports.sheets.graphs.graph_page import draw_graphs, laid_out
from reports.sheets.graphs.graph_span import over_period
from reports.sheets.graphs.graph_words import told_log
from reports.sheets.paper import Paper

LECTURE = load_scene("fourbar-lecture-1")
PERIOD = LECTURE.driver.law.period_s
ROCKER = over_period(LECTURE, "rocker", "time", None)
EVEN = np.arange(0, 721) * PERIOD / 720
Write = Callable[..., Path]


def ripple(t: Array, order: int = 0) -> Array:
    """An engine's error: seven waves a period of a ten-thousandth [rad], and its rates."""
    rate = 7.0 * 10.0
    return 1e-4 * rate**order * np.sin(rate * t + order * math.pi / 2)


@pytest.fixture
def write(tmp_path: Path) -> Write:
    """Writes a log of columns."""

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


def test_the_error_of_the_engine_is_told_apart_from_that_of_the_method(write: Write) -> None:
    theta = ROCKER.exact(0, EVEN) + ripple(EVEN)
    graphs = drawn(write(time_s=EVEN, rocker_theta_rad=theta), parts=96)
    # of a ripple so short the chords of 96 parts show nearly all: 7e-3 rad/s of 6.1
    assert graphs.own_part(1) == pytest.approx(7e-3 / graphs.sizes[1], rel=0.02)
    assert graphs.off(graphs.reference, 1) == pytest.approx(5e-4, rel=0.05)


def test_readings_are_taken_between_rows_and_between_turns(write: Write) -> None:
    t = np.linspace(0.0, 1.1 * PERIOD, 500)
    degrees = np.degrees(ROCKER.exact(0, t))
    wrapped = (degrees + 60.0) % 360.0  # a rocker of 94 to 154 deg, and its encoder's zero
    graphs = drawn(write(time_s=t, rocker_deg=wrapped - 60.0))
    assert graphs.own_part(0) < 1e-8
    assert (
        "by cubic splines between its rows, 0.00139 s apart, which add up to" in told_log(graphs)[1]
    )


def test_a_crank_that_loses_its_turns_goes_on(write: Write) -> None:
    of = over_period(LECTURE, "crank", "time", None)
    angle = np.mod(of.exact(0, EVEN), math.tau)
    log = graph_log(write(time_s=EVEN, crank_theta_rad=angle), None, of)
    assert drawn_graphs(of, "chords", 12, log).own_part(0) < 1e-12


def test_a_log_that_begins_later_is_drawn_from_there(write: Write) -> None:
    t = 0.3 + EVEN
    graphs = drawn(write(time_s=t, rocker_theta_rad=ROCKER.exact(0, t)))
    assert (graphs.span.start, graphs.span.end) == pytest.approx((0.3, 0.3 + PERIOD))
    assert graphs.own_part(2) < 1e-9


def test_of_a_log_that_begins_later_a_whole_period_of_the_driver_is_preferred(
    write: Write,
) -> None:
    t = 0.3 + np.arange(0, 1441) * PERIOD / 720
    graphs = drawn(write(time_s=t, rocker_theta_rad=ROCKER.exact(0, t)))
    assert (graphs.span.start, graphs.span.end) == pytest.approx((PERIOD, 2 * PERIOD))


def test_what_is_let_go_is_drawn_from_its_start_on(write: Write) -> None:
    of = over_period(load_scene("fourbar-swing"), "rocker", "time", 0.5)
    t = np.linspace(0.0, 0.6, 601)
    log = write(time_s=t, rocker_theta_rad=of.exact(0, np.minimum(t, 0.5)))
    assert drawn_graphs(of, "chords", 50, graph_log(log, None, of)).own_part(0) < 1e-9
    late = write(time_s=t[100:], rocker_theta_rad=of.exact(0, np.minimum(t[100:], 0.5)))
    with pytest.raises(CrankcheckError, match=r"those from 0 s to 0\.5 s"):
        graph_log(late, None, of)


def test_own_rates_and_rays_of_the_log_are_layers_of_their_own(write: Write) -> None:
    log = write(
        time_s=EVEN,
        rocker_theta_rad=ROCKER.exact(0, EVEN),
        rocker_omega_rad_s=ROCKER.exact(1, EVEN) + ripple(EVEN, 1),
    )
    graphs = drawn(log)
    drawing = draw_graphs(laid_out(graphs, Paper.of("A4")), "").saved("svg", "").decode()
    for layer in ("rays-omega-log", "graph-epsilon-log", "own-omega"):
        assert f'id="layer-{layer}"' in drawing
    assert 'id="layer-own-epsilon"' not in drawing  # which it has not
    assert "as logged" in drawing
    assert told_log(graphs)[-1].startswith("as logged, at the divisions: omega off by up to 0.1")


def test_no_words_of_a_small_sheet_stand_on_others(write: Write) -> None:
    theta, omega = (ROCKER.exact(order, EVEN) + ripple(EVEN, order) for order in (0, 1))
    log = write(time_s=EVEN, rocker_theta_rad=theta, rocker_omega_rad_s=omega)
    figure = draw_graphs(laid_out(drawn(log), Paper.of("180x120")), "a source").figure
    with styled():
        canvas = FigureCanvasAgg(figure)
        canvas.draw()
    texts = [text for axes in figure.axes for text in axes.texts]
    boxes = [text.get_window_extent(canvas.get_renderer()).padded(-1.0) for text in texts]
    for one, other in itertools.combinations(range(len(texts)), 2):
        assert not boxes[one].overlaps(boxes[other]), (texts[one], texts[other])
    assert all(box.x0 > 0.0 and box.x1 < figure.bbox.width for box in boxes)


def test_an_accelerometer_is_integrated_from_the_exact_start(write: Write) -> None:
    alpha = ROCKER.exact(2, EVEN) + ripple(EVEN, 2)
    graphs = drawn(write(time_s=EVEN, rocker_alpha_rad_s2=alpha), parts=96, by="integration")
    # the ripple's rate starts at 7e-3 rad/s, which the exact constant leaves out
    assert graphs.own_part(1) == pytest.approx(2 * 7e-3 / graphs.sizes[1], rel=0.02)


@pytest.mark.parametrize(
    ("by", "expected"), [("chords", 2.0), ("integration", 2.0)], ids=["chords", "integration"]
)
def test_errors_of_a_log_fall_by_the_same_order_to_its_own(
    write: Write, by: Method, expected: float
) -> None:
    fine = np.arange(0, 2881) * PERIOD / 2880
    columns = {
        "time_s": fine,
        "rocker_theta_rad": ROCKER.exact(0, fine) + 1e-3 * ripple(fine),
        "rocker_alpha_rad_s2": ROCKER.exact(2, fine) + 1e-3 * ripple(fine, 2),
    }
    log = graph_log(write(**columns), None, ROCKER)
    divisions = (24, 48, 96, 192)
    for line in graph_errors(ROCKER, by, divisions, log).lines:
        if line.is_own:
            assert line.order(divisions) is None
        else:
            assert line.order(divisions) == pytest.approx(expected, abs=0.1)


@pytest.mark.parametrize(
    ("errors", "own", "expected"),
    [
        ((16.0, 4.0, 1.0), (), 2.0),
        ((16.0, 4.0, 1.1), (0.1, 0.1, 0.1), 1.93),
        ((16.0, 4.5, 1.9), (1.0, 1.0, 1.0), None),  # most of the last is the log's own
        ((16.0, 4.0, 3.9), (), None),  # two slopes, and none of them fitted
        ((16.0, 0.0, 0.0), (), None),
    ],
)
def test_an_order_is_told_of_what_falls_alone(
    errors: tuple[float, ...], own: tuple[float, ...], expected: float | None
) -> None:
    order = ErrorLine("log", "omega", errors, own).order((24, 48, 96))
    assert order == (expected if expected is None else pytest.approx(expected, abs=0.01))


def test_the_slope_of_order_2_is_below_the_first_error_that_there_is(write: Write) -> None:
    # of a crank the reference's graphs are straight: only those of the log are off
    of = over_period(LECTURE, "crank", "time", None)
    angle = of.exact(0, EVEN) + ripple(EVEN)
    log = graph_log(write(time_s=EVEN, crank_theta_rad=angle), None, of)
    errors = graph_errors(of, "chords", (24, 48), log)
    sheet = draw_errors(errors, Paper.of("A4"), "")
    slope = next(
        line for line in sheet.figure.axes[-1].get_lines() if line.get_label() == "slope of order 2"
    )
    first = next(line for line in errors.lines if line.of == "log").errors[0]
    assert np.asarray(slope.get_ydata()) == pytest.approx([0.5 * first, 0.125 * first])


def test_a_log_at_another_speed_is_drawn_with_a_doubt(write: Write) -> None:
    angle = ROCKER.exact(0, 1.3 * EVEN)  # which begins as the scene does
    told = told_log(drawn(write(time_s=EVEN, rocker_theta_rad=angle)))
    assert "half of its places of rocker are off by" in told[2]


def refusals() -> Sequence[tuple[dict[str, Array], str]]:
    theta, other = ROCKER.exact(0, EVEN), ROCKER.exact(0, EVEN + 0.2)
    short = EVEN <= 0.4
    return [
        (
            {"time_s": EVEN[short], "rocker_theta_rad": theta[short]},
            "to 0.628319 s: log 0.628319 s or more",
        ),
        ({"time_s": EVEN, "rocker_theta_rad": other}, "another scene, speed, start or unit"),
        ({"time_s": EVEN, "lever_theta_rad": theta}, "no column is of scene"),
        ({"time_s": EVEN, "crank_theta_rad": 0.5 * np.pi + 10.0 * EVEN}, "no column is of rocker"),
        (
            {"time_s": EVEN, "rocker_omega_rad_s": ROCKER.exact(1, EVEN)},
            r"\(found rates\); log places$",
        ),
        (
            {"time_s": EVEN[::360], "rocker_theta_rad": theta[::360]},
            "found fewer than 4 rows of it",
        ),
        ({"time_s": EVEN[::60], "rocker_theta_rad": theta[::60]}, "13 rows in the period"),
        ({"time_s": EVEN, "rocker_theta_rad": np.where(short, theta, np.nan)}, "nan"),
    ]


@pytest.mark.parametrize(("columns", "told"), refusals())
def test_a_log_that_can_not_be_drawn_is_refused(
    write: Write, columns: dict[str, Array], told: str
) -> None:
    with pytest.raises(CrankcheckError, match=told):
        drawn(write(**columns))


def test_a_log_over_analogues_is_refused(write: Write) -> None:
    of = over_period(load_scene("fourbar-double-rocker"), "rocker", "angle", None)
    with pytest.raises(CrankcheckError, match="which no log has; use --over time"):
        graph_log(write(time_s=EVEN), None, of)
