"""Every error that is put in is found in the right quantity, with the right size; and in the last
turn of a run, which is drawn."""

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from analytic.kinematics import solve
from analytic.structure.mobility import sides_of
from models.array import Array
from models.files.reading import load_scene
from models.motion import LinkMotion
from models.scene import Scene
from models.scene.moved import mirrored, moved, rotated, scaled
from reports.compare.compare import SETTLING, Truth, compare, incomplete
from reports.compare.errors import ErrorKind, Errors
from reports.compare.last_turn import trace
from reports.compare.tracks import angle_error, length, size
from reports.judge.cell import check
from reports.judge.tolerance import limits
from reports.quantities.quantity import Source
from sim.engine import Run
from sim.run import run as run_scene
from tests.worlds.fake.engine import FakeEngine, turned_link
from tests.worlds.other_way import sped_up
from tests.worlds.turns import of_turns

Find = Callable[..., Errors]
ROUNDING = 1e-12


def compared(scene: Scene, run: Run) -> Errors:
    return compare(Truth(scene).beside(run))


@pytest.fixture(scope="module")
def healthy(fourbar: Scene, disturbed: Callable[..., Run]) -> Run:
    return disturbed(fourbar)


def link_of(run: Run, name: str = "rocker") -> LinkMotion:
    return run.motion.links[name]


def with_motion(run: Run, **parts: Any) -> Run:
    return replace(run, motion=replace(run.motion, **parts))


def with_link(run: Run, name: str = "rocker", **series: Array) -> Run:
    return with_motion(run, links={**run.motion.links, name: replace(link_of(run, name), **series)})


def pure(
    errors: Errors, quantity: str, source: Source = "reported", kind: ErrorKind = "total"
) -> float:
    return errors.worst(quantity, source, kind).pure


def test_exact_runs_are_off_by_rounding(slider_crank: Scene, errors_of: Find) -> None:
    errors = errors_of(slider_crank)
    for quantity in ("drive", "angle", "displacement", "position", "gap", "velocity"):
        assert pure(errors, quantity) < ROUNDING
    assert pure(errors, "acceleration") < 1e-10
    assert pure(errors, "velocity", "differenced") < 1e-9
    assert pure(errors, "acceleration", "differenced") < 1e-6


def test_an_angle_error_shows_in_its_link_with_its_size(fourbar: Scene, errors_of: Find) -> None:
    period = fourbar.driver.law.period_s
    bump = turned_link("rocker", lambda t: 2e-5 * np.sin(np.pi * t / period))
    errors = errors_of(fourbar, bump)
    worst = errors.worst("angle")
    assert worst.body == "rocker"
    assert worst.maximum == pytest.approx(2e-5, rel=1e-6)
    assert worst.rms == pytest.approx(2e-5 / math.sqrt(2), rel=2e-3)
    assert abs(worst.final) < 1e-10
    assert worst.time_of_maximum_s == pytest.approx(period / 2)
    assert worst.driver_at_maximum_rad == pytest.approx(math.pi / 2 + math.pi)
    rocker_m = 0.2
    assert errors.worst("gap").body == "C"
    assert pure(errors, "gap") == pytest.approx(2e-5 * rocker_m / fourbar.longest_m, rel=1e-6)


def test_a_late_crank_is_in_drive_and_total_not_in_geometry(fourbar: Scene, healthy: Run) -> None:
    def lagging(lag_s: float) -> Errors:
        time_s = healthy.motion.time_s
        motion = replace(solve(fourbar, time_s - lag_s), time_s=time_s)
        errors = compared(fourbar, replace(healthy, motion=motion))
        assert pure(errors, "angle", kind="geometric") < ROUNDING
        assert pure(errors, "position", kind="geometric") < ROUNDING
        return errors

    errors = lagging(1e-6)
    assert pure(errors, "drive") == pytest.approx(1e-5, rel=1e-6)
    peak_ratio = 0.62  # of the rocker's speed to the crank's, largest over the turn
    assert pure(errors, "angle") == pytest.approx(1e-5 * peak_ratio, rel=0.05)
    late = lagging(healthy.dt_s)  # a clock off by one sample
    assert pure(late, "drive") == pytest.approx(late.of_scene.step_rad)


def test_velocities_half_a_step_late_show_in_themselves_alone(fourbar: Scene, healthy: Run) -> None:
    own = healthy.motion
    early = own.time_s - healthy.dt_s / 2
    there = solve(fourbar, early)
    motion = with_motion(
        healthy,
        links={n: replace(m, omega=there.links[n].omega) for n, m in own.links.items()},
        points={n: replace(m, velocity=there.points[n].velocity) for n, m in own.points.items()},
    )
    right = compared(fourbar, replace(motion, velocity_time_s=early))
    wrong = compared(fourbar, motion)
    alpha = 0.9  # about the largest pure acceleration of the four-bar's links
    assert pure(wrong, "velocity") == pytest.approx(wrong.of_scene.step_rad / 2 * alpha, rel=0.15)
    assert pure(wrong, "velocity") > limits(fourbar, wrong, {})["velocity"].number
    assert pure(right, "velocity") < ROUNDING
    assert pure(wrong, "angle") < ROUNDING
    assert pure(wrong, "velocity", "differenced") == pure(right, "velocity", "differenced")


def test_a_trembling_position_shows_in_differenced_rates(fourbar: Scene, errors_of: Find) -> None:
    def tremble(time_s: Array) -> Array:
        return np.asarray(1e-7 * (-1.0) ** np.arange(time_s.size) * (time_s > 0.0))

    errors = errors_of(fourbar, turned_link("rocker", tremble))
    (rocker,) = (
        row.pure
        for row in errors.rows
        if (row.quantity, row.source, row.kind, row.body)
        == ("acceleration", "differenced", "total", "rocker")
    )
    assert rocker == pytest.approx(4 * 1e-7 / errors.of_scene.step_rad**2, rel=1e-3)
    assert pure(errors, "velocity") < ROUNDING


@pytest.mark.parametrize(
    ("part", "quantity", "at"),
    [("theta", "angle", -1), ("omega", "velocity", SETTLING // 2), ("alpha", "acceleration", -1)],
)
def test_a_number_that_is_missing_is_a_failure_wherever_it_stands(
    fourbar: Scene, healthy: Run, part: str, quantity: str, at: int
) -> None:
    series = vars(link_of(healthy))[part].copy()
    series[at] = np.nan
    errors = compared(fourbar, with_link(healthy, **{part: series}))
    assert any(row.body == "rocker" and not row.finite for row in errors.rows)
    short = compared(fourbar, with_link(healthy, **{part: series[:1]}))
    assert math.isnan(pure(short, quantity))


def test_a_crank_angle_that_is_missing_or_out_of_range_leaves_a_note_and_no_geometry(
    fourbar: Scene, healthy: Run, disturbed: Callable[..., Run]
) -> None:
    theta = link_of(healthy, "crank").theta.copy()
    theta[5] = np.nan
    errors = compared(fourbar, with_link(healthy, "crank", theta=theta))
    assert "logged crank angle is not finite" in errors.notes[0]
    assert not any(row.kind == "geometric" for row in errors.rows)
    assert math.isnan(pure(errors, "drive"))
    scene = load_scene("fourbar-double-rocker")
    run = disturbed(scene)
    errors = compared(scene, with_link(run, "driver", theta=link_of(run, "driver").theta + 2.0))
    assert "left its range" in errors.notes[0]
    assert pure(errors, "drive") == pytest.approx(2.0)


def test_accelerations_not_reported_are_named_and_no_failure(fourbar: Scene, healthy: Run) -> None:
    def without(parts: dict[str, Any], name: str) -> dict[str, Any]:
        return {n: replace(p, **{name: getattr(p, name) * np.nan}) for n, p in parts.items()}

    links = without(healthy.motion.links, "alpha")
    points = without(healthy.motion.points, "acceleration")
    silent = with_motion(healthy, links=links, points=points)
    errors = compared(fourbar, replace(silent, reports_accelerations=False))
    assert "acceleration of link rocker" in errors.not_reported
    assert all(row.finite for row in errors.rows)
    # Neither may one that reports them lack all, nor one that does not those of some links only.
    some = with_link(healthy, alpha=links["rocker"].alpha)
    for accused in (silent, replace(some, reports_accelerations=False)):
        errors = compared(fourbar, accused)
        assert errors.not_reported == ()
        assert math.isnan(pure(errors, "acceleration"))


@pytest.mark.parametrize(("kind", "name"), [("links", "crank"), ("points", "C")])
def test_what_is_left_out_is_missed(fourbar: Scene, healthy: Run, kind: str, name: str) -> None:
    kept = {n: part for n, part in vars(healthy.motion)[kind].items() if n != name}
    errors = compared(fourbar, with_motion(healthy, **{kind: kept}))
    assert errors.missing == (f"{kind[:-1]} {name}",)
    assert any(row.body == name and not row.finite for row in errors.rows)


def test_every_pin_and_slider_needs_its_gap(disturbed: Callable[..., Run]) -> None:
    scene = load_scene("shaper")
    run = disturbed(scene)
    whole, silent = compared(scene, run), compared(scene, replace(run, gaps={}))
    assert whole.missing == ()
    kinds = {row.body: row.body_kind for row in whole.rows if row.quantity == "gap"}
    assert kinds == {x: "slider" if x in scene.sliders else "point" for x in run.gaps}
    assert set(silent.missing) == {f"gap of {joint}" for joint in run.gaps}
    assert math.isnan(pure(silent, "gap"))


@pytest.mark.parametrize("keep", [slice(1), slice(720), slice(1, None), slice(0, None, 2)])
def test_a_log_that_lacks_samples_is_incomplete(fourbar: Scene, healthy: Run, keep: slice) -> None:
    motion = healthy.motion.each_series(lambda series: series[keep])
    cut = replace(
        with_motion(replace(healthy, motion=motion), time_s=motion.time_s[keep]),
        gaps={name: gap[keep] for name, gap in healthy.gaps.items()},
        velocity_time_s=healthy.velocity_time_s[keep],
        acceleration_time_s=healthy.acceleration_time_s[keep],
    )
    assert compared(fourbar, replace(healthy, motion=None)) is None
    assert compared(fourbar, healthy).incomplete == ""
    assert "not the 721 of 720 steps logged every 1" in compared(fourbar, cut).incomplete


def test_time_stamps_off_the_commanded_grid_are_found(fourbar: Scene, healthy: Run) -> None:
    time_s = healthy.motion.time_s.copy()
    time_s[7:] += 1e-9 * healthy.dt_s
    errors = compared(fourbar, with_motion(healthy, time_s=time_s))
    assert "sample 7 is stamped" in errors.incomplete
    assert "714 of 721" in errors.incomplete


@pytest.mark.parametrize(("steps", "every"), [(720, 7), (9000, 4)])
def test_a_whole_log_is_complete_however_thin_it_is(fourbar: Scene, steps: int, every: int) -> None:
    state = solve(fourbar, np.array([0.3])).state()
    engine = FakeEngine(exact=solve)
    run = run_scene(fourbar, state, engine, dt_s=1e-3, steps=steps, every=every)
    assert incomplete(run) == ""


@pytest.mark.parametrize("engine", ["mujoco", "pymunk"])
def test_pure_errors_are_those_of_another_place_size_side_and_speed(
    engine: str, fourbar: Scene
) -> None:
    aside = moved(rotated(fourbar, 0.7), (3.0, -2.0))
    other = sped_up(scaled(mirrored(aside, sides_of(aside)), 10.0), -50.0)
    old, new = (check(of_turns(scene, engine, 720)).errors for scene in (fourbar, other))
    reported = ["acceleration"] if engine == "mujoco" else []
    for quantity in ("drive", "angle", "position", "gap", "velocity", *reported):
        pair = (old.worst(quantity).pure, new.worst(quantity).pure)
        assert max(pair) <= max(2.0 * min(pair), 1e-10), quantity


LINE, LONG = np.linspace(0.0, 1.0, 20), np.linspace(0.0, 20.0, 500)


def with_one(at: int, value: float) -> Array:
    series = LINE.copy()
    series[at] = value
    return series


@pytest.mark.parametrize(
    ("angle", "reference", "error"),
    [
        (LINE + 3 * math.tau + 1e-6, LINE, 1e-6),
        (np.remainder(LONG + 1e-5 + math.pi, math.tau) - math.pi, LONG, 3 * math.tau - 1e-5),
        *((with_one(at, LINE[at] + math.tau), LINE, math.tau) for at in (0, 7, 19)),
        (math.tau * LINE, 0.0 * LINE, math.tau),
    ],
    ids=["at the start", "wrapped", "first sample", "one sample", "last sample", "gained slowly"],
)
def test_whole_turns_are_errors_but_at_starts(angle: Array, reference: Array, error: float) -> None:
    assert size(angle_error(angle, reference)).maximum == pytest.approx(error)


def test_size_is_that_of_known_series_and_skips_no_sample_that_is_no_number() -> None:
    measured = size(np.array([3.0, -4.0, 0.0, 1.0]))
    assert (measured.maximum, measured.final, measured.index) == (4.0, 1.0, 1)
    assert measured.rms == pytest.approx(math.sqrt(26 / 4))
    assert size(np.array([1e200, 1e200])).rms == pytest.approx(1e200)  # does not overflow
    assert length(np.array([[3.0, 4.0], [0.0, -2.0]])).tolist() == [5.0, 2.0]
    for at, bad in ((0, math.nan), (7, -math.inf), (19, math.inf)):
        measured = size(with_one(at, bad))
        assert math.isnan(measured.maximum)
        assert math.isnan(measured.rms)
        assert measured.index == at


def traced(run: Run, scene: Scene) -> dict[str, Array]:
    return trace(Truth(scene, bound=False), run)


def test_the_last_turn_is_at_equal_parts(fourbar: Scene, disturbed: Callable[..., Run]) -> None:
    found = traced(disturbed(fourbar, steps=1440), fourbar)
    assert found["time_s"].size == 91
    turns = np.diff(found["driver_rad"]) * 90 / math.tau
    np.testing.assert_allclose(turns, 1.0, rtol=1e-12)
    assert found["time_s"][-1] == pytest.approx(2.0 * fourbar.driver.law.period_s)
    found = traced(disturbed(fourbar, steps=100), fourbar)
    assert 10 <= found["time_s"].size <= 14
    assert found["time_s"][0] == 0.0
    assert traced(replace(disturbed(fourbar), motion=None), fourbar) == {}


def test_errors_of_the_last_turn_keep_signs(fourbar: Scene, disturbed: Callable[..., Run]) -> None:
    run = disturbed(fourbar, turned_link("rocker", lambda _: -1e-3))
    found = traced(run, fourbar)
    np.testing.assert_allclose(found["angle.rocker"], -1e-3, rtol=1e-6)
    for name in ("angle.coupler", "drive"):
        np.testing.assert_allclose(found[name], 0.0, atol=1e-12)
    worst = compare(Truth(fourbar).beside(run)).worst("gap")
    assert 0.0 < np.max(found["gap"]) <= worst.maximum
