"""What a drawing holds: the reference, errors small enough to be magnified, and elastic links."""

import base64
import math

import numpy as np
import pytest

from analytic.elastic.discretisation import Modes
from analytic.elastic.elastic_motion import DrivenElasticMotion
from analytic.kinematics import solve
from models.array import Array
from models.files.reading import load_scene
from models.scene import Scene
from reports.describe.elastic_course import ElasticCourse, elastic_course
from reports.drawing.moving import (
    Magnified,
    displacements,
    drawing,
    instants,
    magnification,
    moving_points,
)

SCENES = ("fourbar-lecture-1", "slider-crank-offset", "shaper", "scotch-yoke", "sixbar-stephenson")
FOURBAR = load_scene("fourbar-lecture-1")
TIME_S = instants(FOURBAR)


def unpacked(packed: dict[str, object]) -> Array:
    """Rows as the page reads them."""
    whole = np.frombuffer(base64.b64decode(str(packed["base64"])), "<i2")
    rows = whole.reshape(len(np.asarray(packed["scales"])), -1).astype(np.float64)
    rows[rows == -32768] = np.nan
    return rows * np.asarray(packed["scales"])[:, None]


def traced(
    scene: Scene, time_s: Array, shift_m: float = 0.0, turn_rad: float = 0.0
) -> dict[str, Array]:
    """The trace of a run that is off the reference by a shift in x, and links by a turn."""
    motion = solve(scene, time_s, bound=False)
    found = {"time_s": time_s}
    for name, point in motion.points.items():
        found[f"x.{name}"], found[f"y.{name}"] = (point.position + np.array([shift_m, 0.0])).T
    return found | {f"theta.{name}": link.theta + turn_rad for name, link in motion.links.items()}


def rows_off(trace: dict[str, Array], time_s: Array = TIME_S, scene: Scene = FOURBAR) -> Array:
    """The displacements of a trace."""
    return unpacked(displacements(scene, trace, time_s))


@pytest.mark.parametrize("name", SCENES)
def test_the_reference_is_the_closed_form(name: str) -> None:
    scene = load_scene(name)
    time_s = instants(scene)
    drawn = drawing(scene, time_s)
    motion = solve(scene, time_s)
    rows = unpacked(drawn["places"])
    assert drawn["points"] == moving_points(scene)
    for i, point in enumerate(moving_points(scene)):
        exact = motion.points[point].position.T
        level = np.max(np.abs(exact)) / 32767
        np.testing.assert_allclose(rows[2 * i : 2 * i + 2], exact, atol=level)
    named = {p for link in drawn["links"] for p in link["points"]}
    assert named <= {*drawn["points"], *drawn["ground"]}


@pytest.mark.parametrize("name", SCENES)
@pytest.mark.parametrize("shift_m", [1e-3, 1e-9])
def test_small_errors_are_kept_apart_from_large_places(name: str, shift_m: float) -> None:
    scene = load_scene(name)
    time_s = instants(scene)
    rows = rows_off(traced(scene, time_s, shift_m, turn_rad=2e-8), time_s, scene)
    points = len(moving_points(scene))
    np.testing.assert_allclose(rows[0 : 2 * points : 2], shift_m, rtol=1e-4)
    np.testing.assert_allclose(rows[1 : 2 * points : 2], 0.0, atol=1e-16)
    np.testing.assert_allclose(rows[2 * points :], 2e-8, rtol=1e-4)


def test_a_run_of_other_turns_is_shown_at_the_same_crank_angles() -> None:
    period, own = FOURBAR.driver.law.period_s, instants(FOURBAR, turns=4.0)
    trace = traced(FOURBAR, own)
    trace["x.C"] = trace["x.C"] + 1e-3 * np.sin(2 * np.pi * own / period)
    row = rows_off(trace, instants(FOURBAR, turns=2.0))[2 * moving_points(FOURBAR).index("C")]
    np.testing.assert_allclose(row, 1e-3 * np.sin(2 * np.pi * TIME_S / period), atol=1e-7)
    angles = np.asarray(drawing(FOURBAR, instants(FOURBAR, turns=3.0))["told"]["at"])
    assert angles[[0, -1]] == pytest.approx([90.0, 450.0])  # it starts in its first turn


def test_a_run_that_rounding_ends_early_is_drawn_to_its_end() -> None:
    assert np.isfinite(rows_off(traced(FOURBAR, TIME_S * (1.0 - 1e-14), 1e-3))).all()


def test_a_run_is_drawn_as_far_as_it_was_logged_and_cut_off_where_it_came_apart() -> None:
    assert np.isfinite(rows_off(traced(FOURBAR, TIME_S[:40], 1e-3))[0]).sum() == 40
    trace = traced(FOURBAR, TIME_S)
    trace["x.C"] = trace["x.C"] + np.linspace(0.0, 1e200, len(TIME_S))
    trace["y.C"] = np.full_like(TIME_S, math.nan)
    x, y = rows_off(trace)[2 * moving_points(FOURBAR).index("C") :][:2]
    assert np.max(x) == pytest.approx(20 * FOURBAR.longest_m, rel=1e-4)
    assert np.isnan(y).all()
    assert displacements(FOURBAR, {}, TIME_S) is None
    assert displacements(FOURBAR, {"time_s": TIME_S}, TIME_S) is None


@pytest.fixture(scope="module")
def course() -> ElasticCourse:
    scene = load_scene("fourbar-elastic")
    motion = DrivenElasticMotion(scene, 1.0, Modes(3), "periodic", stiffened=True)
    return elastic_course(motion, np.linspace(0.0, 0.8, 9))


def bent(course: ElasticCourse, factor: float) -> Magnified:
    return Magnified(course.scene, course.motion, course.rigid, course.bent, factor)


def test_at_true_scale_everything_is_where_it_is(course: ElasticCourse) -> None:
    own = bent(course, 1.0)
    outline = own.outline("coupler", 2)
    ends = [course.motion.points[pin].position[2] for pin in ("B", "C")]
    np.testing.assert_allclose(outline[[0, -1]], ends, rtol=0, atol=1e-15)
    chord, aside = ends[1] - ends[0], outline[20] - ends[0]
    off = (chord[0] * aside[1] - chord[1] * aside[0]) / np.hypot(*chord)
    assert off == pytest.approx(course.motion.elastic["coupler"].middle[2], rel=1e-9)
    np.testing.assert_allclose(own.outline("rocker", 2)[1], ends[1], rtol=0, atol=1e-15)


def test_displacements_are_magnified_and_what_nothing_moves_stays(course: ElasticCourse) -> None:
    own = bent(course, 1000.0)
    exact = course.rigid.points["C"].position[2]
    moved = course.motion.points["C"].position[2] - exact
    np.testing.assert_allclose(own.place("C", 2) - exact, 1000.0 * moved, rtol=1e-9)
    np.testing.assert_allclose(own.outline("crank", 2)[1], course.rigid.points["B"].position[2])


@pytest.mark.parametrize("size_m", [1e-3, 0.3, 1.0, 40.0])
def test_a_magnification_is_a_round_number_that_fits(course: ElasticCourse, size_m: float) -> None:
    factor = magnification(course.motion, course.rigid, course.bent, size_m)
    assert f"{factor:e}"[0] in "125"
    largest = np.max(np.abs(course.bent["coupler"]))
    assert factor == 1.0 or 0.02 < factor * largest / size_m <= 0.06
    assert magnification(course.rigid, course.rigid, {}, 1.0) == 1.0  # nothing bends
