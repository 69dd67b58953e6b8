"""The log of a run, judged as a stranger's, says what `verify` says of the run."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import crankcheck
from crankcheck import Error, Errors
from tests.worlds.tiers import slowly

WRITERS: dict[str, Callable[[pd.DataFrame, Path], None]] = {
    ".csv": lambda frame, path: frame.to_csv(path, index=False),
    ".parquet": lambda frame, path: frame.to_parquet(path, index=False),
}
Key = tuple[str, str, str, str, str]


def by_key(errors: Errors) -> dict[Key, Error]:
    return {
        (row.quantity, row.body_kind, row.body, row.source, row.kind): row for row in errors.rows
    }


def held_to_the_same(run: crankcheck.Simulation, found: Errors) -> None:
    """The errors of a log and of the run that wrote it are the same, to 1e-12 of their scale."""
    told = by_key(crankcheck.compare(run.mechanism, run).errors)
    logged = by_key(found)
    assert logged.keys() == told.keys()
    for key, error in logged.items():
        assert error.pure == pytest.approx(told[key].pure, rel=1e-12, abs=1e-12), key
        assert error.rms == pytest.approx(told[key].rms, rel=1e-12, abs=1e-12 * error.scale), key


@pytest.mark.parametrize("ending", WRITERS)
@pytest.mark.parametrize("fixture", ["ran", "lagging"])
def test_the_log_of_a_run_has_its_errors(
    fixture: str, ending: str, request: pytest.FixtureRequest, tmp_path: Path
) -> None:
    run: crankcheck.Simulation = request.getfixturevalue(fixture)
    path = tmp_path / f"log{ending}"
    WRITERS[ending](run.frame(), path)
    judged = crankcheck.judge(run.mechanism, path, step_s=run.dt_s)
    assert judged.verdict == "within"
    assert judged.errors is not None
    held_to_the_same(run, judged.errors)
    compared = crankcheck.compare(run.mechanism, path, step_s=run.dt_s)
    held_to_the_same(run, compared.errors)


def test_a_frame_and_columns_by_name_are_judged_as_their_file(ran: crankcheck.Simulation) -> None:
    frame = ran.frame()
    by_name = {name: frame[name].to_numpy() for name in frame.columns}
    indexed = [frame.set_index(names) for names in ("time_s", ["rocker_theta_rad", "time_s"])]
    for log in (frame, by_name, *indexed):
        judged = crankcheck.judge(ran.scene, log, step_s=ran.dt_s)
        assert judged.errors is not None
        held_to_the_same(ran, judged.errors)


@pytest.mark.parametrize(
    "name",
    ["slider-crank-offset", slowly("shaper", reason="a second: a block on a link that turns")],
)
def test_a_motion_is_judged_as_its_frame(name: str) -> None:
    scene = crankcheck.load_scene(name)
    solution = crankcheck.solve(scene)
    moved = solution.each_series(lambda series: series + 1e-4)
    judged = crankcheck.judge(scene, moved, target=1e-3)
    framed = crankcheck.judge(scene, crankcheck.Motion(**parts(moved)), target=1e-3)
    assert judged.errors is not None
    assert framed.errors is not None
    assert by_key(judged.errors).keys() == by_key(framed.errors).keys()
    assert judged.errors.worst("angle").maximum == pytest.approx(1e-4)  # type: ignore[union-attr]
    assert (judged.verdict, crankcheck.judge(scene, moved, target=1e-5).verdict) == (
        "within",
        "out",
    )


def parts(motion: crankcheck.Motion) -> dict[str, object]:
    return {name: getattr(motion, name) for name in ("time_s", "links", "points", "sliders")}


def test_what_an_engine_does_not_report_is_left_out_of_its_log(
    ran: crankcheck.Simulation, lagging: crankcheck.Simulation
) -> None:
    columns = set(lagging.frame().columns)
    assert {"velocity_time_s", "lever_omega_rad_s", "B_slider_speed_m_s", "B_gap_m"} <= columns
    assert not {"lever_alpha_rad_s2", "acceleration_time_s", "E_ax_m_s2"} & columns
    assert "rocker_alpha_rad_s2" in ran.frame().columns
    assert "velocity_time_s" not in ran.frame().columns
    later = replace(ran, acceleration_time_s=ran.acceleration_time_s - ran.dt_s)  # type: ignore[operator]
    assert list(later.frame().columns[:2]) == ["time_s", "acceleration_time_s"]
    half = lagging.frame()["velocity_time_s"] - lagging.frame()["time_s"]
    np.testing.assert_allclose(half, lagging.dt_s / 2)


def test_a_run_is_judged_by_its_own_step_and_a_failing_one_fails(
    ran: crankcheck.Simulation,
) -> None:
    verdict = crankcheck.judge(ran.scene, ran)
    checked = crankcheck.check(ran.scene, steps_per_turn=180, turns=1, converge=False)
    assert verdict.verdict == "within"
    assert verdict.errors == checked.errors
    assert verdict.limits == checked.limits
    assert crankcheck.judge(ran.scene, ran, target=1e-12).verdict == "out"
    some = crankcheck.judge(ran.scene, ran, target={"angle": 1e-12})
    assert {finding.rule for finding in some.failures} == {"CC103"}
    apart = replace(ran, status="diverged", reason="came apart at 0.1 s")
    assert "CC101" in {each.rule for each in crankcheck.judge(ran.scene, apart).failures}


@pytest.mark.parametrize("name", ["slider-crank-offset", "shaper", "scotch-yoke", "tangent"])
def test_a_frame_of_the_closed_form_is_judged_though_it_has_lengths_of_vectors(name: str) -> None:
    judged = crankcheck.judge(name, crankcheck.solve(name).frame(), target=1e-9)
    assert judged.verdict == "within"
    assert all("gap of" in each for each in judged.not_judged)


def test_no_row_of_a_log_within_tolerance_is_out(lagging: crankcheck.Simulation) -> None:
    judged = crankcheck.judge(lagging.scene, lagging.frame(), step_s=lagging.dt_s)
    frame = judged.frame()
    assert judged.verdict == "within"
    assert "start" in set(frame["kind"])
    assert set(frame["verdict"]) == {"within"}
