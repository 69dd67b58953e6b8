"""`judge` and `assert_within`: of the log of a run they say what `verify` says of the run."""

from dataclasses import replace
from pathlib import Path
from traceback import walk_tb

import numpy as np
import pytest

import crankcheck
from crankcheck import Error, Errors
from crankcheck.testing import assert_within

SCENE = "fourbar-lecture-1"


def by_key(errors: Errors) -> dict[tuple[str, ...], Error]:
    return {(x.quantity, x.body_kind, x.body, x.source, x.kind): x for x in errors.rows}


def held_to_the_same(run: crankcheck.Simulation, found: Errors) -> None:
    """The errors of a log and of the run that wrote it are the same, to 1e-12 of their scale."""
    told = by_key(crankcheck.compare(run.mechanism, run).errors)
    logged = by_key(found)
    assert logged.keys() == told.keys()
    for key, error in logged.items():
        assert error.pure == pytest.approx(told[key].pure, rel=1e-12, abs=1e-12), key
        assert error.rms == pytest.approx(told[key].rms, rel=1e-12, abs=1e-12 * error.scale), key


@pytest.mark.parametrize("fixture", ["ran", "lagging"])
def test_the_log_of_a_run_has_its_errors(
    fixture: str, request: pytest.FixtureRequest, tmp_path: Path
) -> None:
    run: crankcheck.Simulation = request.getfixturevalue(fixture)
    path = tmp_path / "log.parquet"
    run.frame().to_parquet(path, index=False)
    judged = crankcheck.judge(run.mechanism, path, step_s=run.dt_s)
    assert judged.verdict == "within"
    for found in (judged, crankcheck.compare(run.mechanism, path, step_s=run.dt_s)):
        held_to_the_same(run, found.errors)


def test_a_frame_and_columns_by_name_are_judged_as_their_file(ran: crankcheck.Simulation) -> None:
    frame = ran.frame()
    by_name = {name: frame[name].to_numpy() for name in frame.columns}
    indexed = [frame.set_index(names) for names in ("time_s", ["rocker_theta_rad", "time_s"])]
    for log in (frame, by_name, *indexed):
        held_to_the_same(ran, crankcheck.judge(ran.scene, log, step_s=ran.dt_s).errors)


def test_a_motion_is_judged_as_its_frame() -> None:
    scene = crankcheck.load_scene("slider-crank-offset")
    solution = crankcheck.solve(scene, points=())
    moved = solution.each_series(lambda series: series + 1e-4)
    bare = crankcheck.Motion(moved.time_s, moved.links, moved.points, moved.sliders)
    judged = crankcheck.judge(scene, moved, target=1e-3)
    framed = crankcheck.judge(scene, bare, target=1e-3)
    assert by_key(judged.errors).keys() == by_key(framed.errors).keys()
    assert judged.errors.worst("angle").maximum == pytest.approx(1e-4)
    assert judged.verdict == "within"
    assert crankcheck.judge(scene, moved, target=1e-5).verdict == "out"


def test_what_an_engine_does_not_report_is_left_out_of_its_log_and_no_row_of_it_is_out(
    ran: crankcheck.Simulation, lagging: crankcheck.Simulation
) -> None:
    columns = set(lagging.frame().columns)
    assert {"velocity_time_s", "lever_omega_rad_s", "B_slider_speed_m_s", "B_gap_m"} <= columns
    assert not {"lever_alpha_rad_s2", "acceleration_time_s", "E_ax_m_s2"} & columns
    assert "rocker_alpha_rad_s2" in ran.frame().columns
    assert "velocity_time_s" not in ran.frame().columns
    later = replace(ran, acceleration_time_s=ran.acceleration_time_s - ran.dt_s)
    assert list(later.frame().columns[:2]) == ["time_s", "acceleration_time_s"]
    half = lagging.frame()["velocity_time_s"] - lagging.frame()["time_s"]
    np.testing.assert_allclose(half, lagging.dt_s / 2)
    judged = crankcheck.judge(lagging.scene, lagging.frame(), step_s=lagging.dt_s)
    assert judged.verdict == "within"
    assert "start" in set(judged.frame()["kind"])
    assert set(judged.frame()["verdict"]) == {"within"}


def test_a_run_is_judged_by_its_own_step_and_a_bad_one_fails(ran: crankcheck.Simulation) -> None:
    verdict = crankcheck.judge(ran.scene, ran)
    checked = crankcheck.check(ran.scene, steps_per_turn=180, turns=1, converge=False)
    assert verdict.verdict == "within"
    assert (verdict.errors, verdict.limits) == (checked.errors, checked.limits)
    assert crankcheck.judge(ran.scene, ran, target=1e-12).verdict == "out"
    some = crankcheck.judge(ran.scene, ran, target={"angle": 1e-12})
    assert {finding.rule for finding in some.failures} == {"CC103"}
    apart = replace(ran, status="diverged", reason="came apart at 0.1 s")
    assert "CC101" in {each.rule for each in crankcheck.judge(ran.scene, apart).failures}


@pytest.mark.parametrize("name", ["slider-crank-offset", "shaper"])
def test_a_frame_of_the_closed_form_is_judged_though_it_has_lengths_of_vectors(name: str) -> None:
    judged = crankcheck.judge(name, crankcheck.solve(name).frame(), target=1e-9)
    assert judged.verdict == "within"
    assert all("gap of" in each for each in judged.not_judged)


@pytest.fixture(scope="module")
def log() -> dict[str, np.ndarray]:
    """The angle of the rocker, off by half a degree from 0.3 s on."""
    time_s = np.linspace(0.0, 0.6, 301)
    theta = np.degrees(crankcheck.solve(SCENE, time_s).links["rocker"].theta)
    return {"time_s": time_s, "rocker_deg": theta + 0.5 * (time_s > 0.3)}


def test_what_is_within_comes_back(ran: crankcheck.Simulation, log: dict[str, np.ndarray]) -> None:
    assert isinstance(assert_within(SCENE, ran), crankcheck.CellVerdict)
    assert isinstance(assert_within(SCENE, log, angle=1e-2), crankcheck.LogVerdict)
    assert_within(SCENE, crankcheck.solve(SCENE), target=1e-12, velocity=1e-9)


def test_what_is_out_is_told_as_the_command_tells_it(log: dict[str, np.ndarray]) -> None:
    with pytest.raises(AssertionError) as told:
        assert_within(SCENE, log, angle=1e-3)
    hidden = [frame.f_locals.get("__tracebackhide__") for frame, _ in walk_tb(told.tb)]
    assert hidden == [None, True, True]  # pytest shows the line that asserts, and nothing below it
    text = str(told.value)
    assert text.startswith("\nOUT  the log, scene fourbar-lecture-1\n  CC103 angle: link rocker: ")
    assert "OUT rocker_deg   angle of rocker" in text
    assert "OUT OF TOLERANCE: 1 of 1 error over 301 samples" in text


def test_of_a_run_it_is_the_table_of_verify(ran: crankcheck.Simulation) -> None:
    with pytest.raises(AssertionError, match="CC107 velocity, differenced: link") as told:
        assert_within(SCENE, ran, velocity_differenced=1e-9)
    assert "\nOUT fourbar-lecture-1      mujoco " in str(told.value)
    with pytest.raises(AssertionError, match="1e-08 rad") as told:
        assert_within(SCENE, ran, target=1e-8, position=1.0)
    assert "CC113" not in str(told.value)


def test_what_moves_the_truth_is_said_as_of_judge(log: dict[str, np.ndarray]) -> None:
    time_s = log["time_s"]
    truth = crankcheck.solve(SCENE, 1.1 * time_s)
    quicker = {f"{name}_rad": truth.links[name].theta for name in ("crank", "rocker")}
    quicker["time_s"] = time_s
    for drive in ("fitted", "logged"):
        assert_within(SCENE, quicker, drive=drive, angle=1e-9, target={"drive": 1e-9})
    with pytest.raises(AssertionError, match="CC102 drive"):
        assert_within(SCENE, quicker, target=1e-3)
    with pytest.raises(crankcheck.CrankcheckError, match=r"drive: found 1e-09; give scene, fitted"):
        assert_within(SCENE, quicker, target=1e-3, drive=1e-9)  # type: ignore[arg-type]


def test_a_tolerance_is_asked_for_and_what_is_missing_is_out(log: dict[str, np.ndarray]) -> None:
    with pytest.raises(crankcheck.CrankcheckError, match=r"no limit for angle: .* give target"):
        assert_within(SCENE, log, velocity=1e-3)
    with pytest.raises(TypeError):
        assert_within(SCENE)
    with pytest.raises(AssertionError, match="not in the log: velocity of rocker"):
        assert_within(SCENE, log, angle=1e-2, require="rocker.velocity")
