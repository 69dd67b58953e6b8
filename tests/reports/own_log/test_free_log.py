"""The log of a mechanism that was let go is held to the motion of its masses and forces."""

from collections.abc import Mapping
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

import crankcheck
from models.errors import CrankcheckError
from models.files.reading import load_scene
from models.motion import Motion
from models.scene import Scene
from reports.compare.free_truth import kept_motion
from reports.judge.cell import Cell, check
from reports.own_log.table import footer, no_cause_text
from reports.page.log_page import log_page
from reports.requests.run import Simulation
from tests.worlds.tiers import slow, slowly

SWING = "fourbar-swing"
TIME_S = np.linspace(0.0, 0.4, 201)


@cache
def ran(name: str, engine: str, duration_s: float) -> Simulation:
    return crankcheck.run(name, engine, duration_s=duration_s)


def truth(name: str = SWING) -> Motion:
    return kept_motion(load_scene(name), 0.4).at(TIME_S)


def angles(motion: Motion, *names: str) -> dict[str, object]:
    return {f"{name}_rad": motion.links[name].theta for name in names}


def judged(
    columns: Mapping[str, object],
    scene: Scene | str = SWING,
    target: float | None = 1e-3,
    time_s: object = TIME_S,
    **asked: object,
) -> crankcheck.LogVerdict:
    return crankcheck.judge(scene, {"t": time_s, **columns}, target=target, **asked)  # type: ignore[call-overload, no-any-return]


def rules(one: crankcheck.LogVerdict) -> list[str]:
    return [finding.rule for finding in one.failures]


BACK = "only then has its driver turned back at a limit, at 0.42 s"


@pytest.mark.parametrize(
    ("name", "engine", "seconds"),
    [
        (SWING, "mujoco", 0.3),
        slowly("fourbar-double-rocker-swing", "pymunk", 1.0, reason=BACK),
    ],
)
def test_a_run_that_was_logged_has_the_numbers_of_its_verification(
    name: str, engine: str, seconds: float
) -> None:
    done = ran(name, engine, seconds)
    cell = Cell(done.mechanism, engine, "tuned", done.dt_s, done.steps, drive="free")
    verified = check(replace(cell, converge=False))
    log = crankcheck.judge(name, done.frame(), step_s=done.dt_s)
    found = {(e.quantity, e.body, e.source, e.kind): e.maximum for e in log.errors.rows}
    for row in verified.errors.rows:
        if row.quantity != "energy":  # which no column tells
            assert found[row.quantity, row.body, row.source, row.kind] == row.maximum
    assert log.limits == verified.limits
    assert log.verdict == verified.verdict
    assert f"energy of {name}" in log.not_judged


def test_a_run_itself_may_be_judged_and_compared() -> None:
    done = ran(SWING, "mujoco", 0.3)
    verdict = crankcheck.judge(SWING, done)
    assert verdict.verdict == "within"
    assert crankcheck.compare(SWING, done).worst("phase") == verdict.errors.worst("phase")
    found = crankcheck.judge(SWING, done.frame(), step_s=done.dt_s, target={"phase": 1e-12})
    assert "CC127" in rules(found)


def test_a_driven_scene_may_be_let_go_and_judged() -> None:
    name = "slider-crank-central"
    done = crankcheck.run(name, drive="free", duration_s=0.2)
    assert crankcheck.judge(name, done).verdict == "within"
    log = crankcheck.judge(name, done.frame(), step_s=done.dt_s, free=True)
    assert log.verdict == "within"
    assert log.errors.worst("phase") == crankcheck.compare(name, done).worst("phase")


def test_a_linkage_that_is_open_is_told_from_a_phase_that_runs_away() -> None:
    motion = truth()
    rocker = motion.links["rocker"].theta
    late = kept_motion(load_scene(SWING), 0.4).at(TIME_S * 0.98)
    phase = judged(angles(late, "crank", "rocker"))
    assert rules(phase) == ["CC103", "CC127"]
    assert any("the phase is off, and not the geometry" in note for note in phase.notes)
    bent = angles(motion, "crank") | {"rocker_rad": rocker + 0.01 * np.sin(9.0 * TIME_S)}
    opened = judged(bent)
    assert "CC128" in rules(opened)
    assert any("the geometry is off" in note for note in opened.notes)
    assert phase.causes == opened.causes == ()
    assert "causes are not searched" in no_cause_text(opened, ["rocker_rad"])
    assert "sensitivity" in footer(opened, {})[0]


def test_geometry_is_that_of_the_readings_where_the_phase_has_run_away() -> None:
    """One coordinate, and an angle relative to another link: the rest is not of the same time."""
    late = kept_motion(load_scene(SWING), 0.4).at(TIME_S * 0.98)
    turned = {name: link.theta for name, link in late.links.items()}
    one = judged(
        {"crank_rad": turned["crank"], "C.x_m": late.points["C"].position[:, 0],
         "coupler_rel_crank_rad": turned["coupler"] - turned["crank"]}, target=0.3,
    )  # fmt: skip
    rows = {row.body: row.maximum for row in one.errors.rows if row.quantity == "geometry"}
    assert set(rows) >= {"crank", "C"}
    assert max(rows.values()) < 1e-12


def test_a_log_that_begins_in_another_way_is_told_and_a_right_one_has_its_page() -> None:
    motion = truth()
    one = judged({"rocker_rad": motion.links["rocker"].theta + 0.1})
    assert any(
        ("does not begin with the start of fourbar-swing: rocker_rad by") in n for n in one.notes
    )
    later = judged({"rocker_rad": motion.links["rocker"].theta[50:] + 1e-9}, time_s=TIME_S[50:])
    assert later.verdict == "within"
    assert any("begins at t = 0.1 s" in note for note in later.notes)
    right = judged(angles(motion, "crank", "rocker"))
    assert not any("begin" in note for note in right.notes)
    page = log_page(right, {"made": "2026-01-02"})
    assert "geometry of rocker" in page
    assert "free motion of fourbar-swing" in page


@slow("0.4 s: rare, a driver that turns back at its limits")
def test_where_the_driver_does_not_tell_the_position_no_geometry_is_judged() -> None:
    motion = truth("fourbar-double-rocker-swing")
    one = judged(angles(motion, "driver", "rocker"), "fourbar-double-rocker-swing")
    assert one.verdict == "within"
    assert any("no geometry: the angle of driver alone" in note for note in one.notes)


def test_rows_of_which_the_truth_is_not_known_are_left_out_and_counted() -> None:
    chain = load_scene("fourbar-chain")
    time_s = np.linspace(0.0, 8.0, 81)
    motion = kept_motion(chain, 8.0).at(time_s)
    name = chain.driver.link
    one = judged({f"{name}_rad": motion.links[name].theta}, chain, 1e-12, time_s)
    assert one.errors.of_motion.left_out == 81 - one.log.time_s.size > 0
    assert any("later samples are not judged" in note for note in one.notes)


@pytest.mark.parametrize(
    ("time_s", "asked", "told"),
    [
        (
            TIME_S - 0.2,
            {},
            "begin at t = -0.2 s, and the free motion of fourbar-swing starts at t = 0",
        ),
        (TIME_S * 1e4, {}, "check the unit of its times"),
        (TIME_S, {"drive": "logged"}, "drive logged: fourbar-swing is in free motion"),
        (TIME_S, {"target": None}, "no limit for angle: the step of the log is unknown"),
    ],
)
def test_what_is_not_judged_is_told(time_s: object, asked: dict[str, object], told: str) -> None:
    with pytest.raises(CrankcheckError, match=told):
        judged({"rocker_rad": truth().links["rocker"].theta}, time_s=time_s, **asked)


def test_readings_half_a_step_before_the_start_are_read() -> None:
    """As of leapfrog, whose velocities are half a step behind its places."""
    early = TIME_S - 1e-3
    assert judged(angles(truth(), "crank"), time_s=early, step_s=2e-3, target=0.1).errors


def test_limits_of_the_other_kind_of_motion_are_refused_of_runs_too() -> None:
    with pytest.raises(CrankcheckError, match="drive: it is for"):
        crankcheck.judge(SWING, ran(SWING, "mujoco", 0.3), target={"drive": 1e-3})


def test_a_free_run_that_has_hardly_begun_is_not_judged() -> None:
    done = crankcheck.run(SWING, "mujoco", duration_s=5e-3)
    with pytest.raises(CrankcheckError, match="5 steps, and a judgement of free motion needs"):
        crankcheck.judge(SWING, done)
