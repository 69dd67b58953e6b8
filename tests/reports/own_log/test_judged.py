"""A user's log is judged for what it holds, by what moves it, within what he asks for."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from analytic.kinematics import solve
from models.array import Array
from models.errors import CrankcheckError
from models.files import load_scene
from reports.judge.rules import RULES
from reports.logs.columns import columns_of
from reports.logs.map_file import map_of
from reports.logs.meanings import understood
from reports.own_log import drives
from reports.own_log.drives import moved
from reports.own_log.judged import JudgedLog, LogRequest, judge_log
from reports.own_log.log_limits import EVERY
from tests.worlds.tiers import slowly

SCENE = load_scene("fourbar-lecture-1")
TIME_S = np.linspace(0.0, 1.2, 601)
MOTION = solve(SCENE, TIME_S)
ROCKER = MOTION.links["rocker"]


def judged(columns: dict[str, object], every: float | None = 1e-3, **asked: object) -> JudgedLog:
    log = understood(columns_of(pd.DataFrame({"t": TIME_S, **columns})), SCENE)
    told = {"target": {} if every is None else {EVERY: every}, **asked}
    return judge_log(log, LogRequest(**told))  # type: ignore[arg-type]


def rules(one: JudgedLog) -> list[str]:
    return [finding.rule for finding in one.failures]


def test_a_log_of_one_column_is_judged_for_it_and_the_rest_is_told() -> None:
    one = judged({"rocker": ROCKER.theta + 1e-4 * np.sin(TIME_S)})
    assert one.verdict == "within"
    assert [(row.quantity, row.body) for row in one.errors.rows] == [("angle", "rocker")]
    assert one.errors.rows[0].maximum == pytest.approx(1e-4 * np.sin(1.2), rel=1e-6)
    assert "drive of crank" in one.not_judged
    assert "velocity of rocker" in one.not_judged
    assert "angle of rocker" not in one.not_judged


def test_what_is_off_by_more_than_the_target_is_out() -> None:
    assert rules(judged({"rocker": ROCKER.theta * 1.001})) == ["CC103"]
    assert rules(judged({"rocker": ROCKER.theta * 1.001}, 1e-2)) == []


def test_one_coordinate_of_a_point_is_judged_by_itself() -> None:
    one = judged({"C.x_mm": 1e3 * MOTION.points["C"].position[:, 0] + 2.0 * np.sin(TIME_S)})
    assert rules(one) == ["CC113"]
    assert one.errors.rows[0].maximum == pytest.approx(2e-3 * np.sin(1.2), rel=1e-9)


def test_each_quantity_may_have_a_target_of_its_own() -> None:
    columns = {"rocker": ROCKER.theta * 1.0001, "rocker_rad_s": ROCKER.omega * 1.01}
    assert rules(judged(columns, 1e-3)) == ["CC106"]
    assert rules(judged(columns, None, target={EVERY: 1e-3, "velocity": 0.1})) == []


def test_without_a_step_every_quantity_needs_a_target() -> None:
    columns = {"rocker": ROCKER.theta, "rocker_rad_s": ROCKER.omega}
    with pytest.raises(CrankcheckError, match="no limit for velocity: no step of a log is known"):
        judged(columns, None, target={"angle": 1e-3})


def test_a_step_gives_the_budget_of_verify_and_differences_even_samples() -> None:
    one = judged({"rocker": ROCKER.theta}, None, step_s=0.002)
    assert {row.tolerance for row in one.errors.rows} == {
        "angle", "velocity-differenced", "acceleration-differenced"
    }  # fmt: skip
    assert one.limits["angle"].origin == "default"
    uneven = TIME_S + 1e-4 * np.sin(7 * np.arange(601))
    angle = solve(SCENE, uneven).links["rocker"].theta
    again = judged({"t": uneven, "rocker": angle}, None, step_s=0.001)
    assert {row.tolerance for row in again.errors.rows} == {"angle"}


@pytest.mark.parametrize("step_s", [-1.0, 0.1, float("nan")])
def test_a_step_that_can_not_be_is_refused(step_s: float) -> None:
    with pytest.raises(CrankcheckError, match="--step"):
        judged({"rocker": ROCKER.theta}, None, step_s=step_s)


def test_two_copies_of_a_pin_that_part_are_an_open_joint() -> None:
    x, y = MOTION.points["C"].position.T
    apart = 1e-3 * np.sin(TIME_S)
    one = judged({"coupler.C.x": x, "coupler.C.y": y, "rocker.C.x": x + apart, "rocker.C.y": y})
    assert rules(one) == ["CC105"]
    gap = one.errors.worst("gap")
    assert gap.maximum == pytest.approx(1e-3 * np.sin(1.2))


ALL = "all starts and rows: a fit that ends beside the best one is found in long logs first"


@pytest.fixture(params=[(6, 4), slowly((drives.STARTS, 1), reason=ALL)], ids=["few", "all"])
def time_s(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> Array:
    """The instants of a log whose drive is fitted. Start angles that are tried take the time of a
    fit, and so do rows: few of both are enough for what these logs hold."""
    starts, every = request.param
    monkeypatch.setattr(drives, "STARTS", starts)
    return TIME_S[::every]


@pytest.mark.parametrize("crank", [True, False])
def test_a_drive_is_fitted_with_its_doubt(crank: bool, time_s: Array) -> None:
    other = solve(moved(SCENE, 10.07, 0.35), time_s)
    noise = 1e-5 * np.random.default_rng(1).normal(size=(2, len(time_s)))
    columns = {"t": time_s, "rocker": other.links["rocker"].theta + noise[0]}
    if crank:
        columns["crank"] = np.mod(other.links["crank"].theta + noise[1], 2 * np.pi)
    assert judged(columns).verdict == "out"
    one = judged(columns, drive="fitted")
    assert one.verdict == "within"
    assert abs(one.fit.speed_rad_s - 10.07) < 4 * one.fit.speed_doubt < 1e-4
    turns = (one.fit.start_rad - 0.35) / (2 * np.pi)
    assert 2 * np.pi * abs(turns - round(turns)) < 4 * one.fit.start_doubt < 1e-4


@pytest.mark.parametrize(
    ("speed", "column"),
    [
        (-10.0, "C.x"),
        slowly(20.0, "rocker", reason="twice the speed of the scene, where fits start"),
        slowly(1.0, "rocker", reason="a fifth of a turn in all"),
    ],
)
def test_any_speed_is_found_without_the_crank(speed: float, column: str, time_s: Array) -> None:
    other = solve(moved(SCENE, speed, 0.7), time_s)
    places = {"rocker": other.links["rocker"].theta, "C.x": other.points["C"].position[:, 0]}
    one = judged({"t": time_s, column: places[column]}, drive="fitted")
    assert one.verdict == "within"
    assert one.fit.explains
    assert one.fit.speed_rad_s == pytest.approx(speed, rel=1e-9)


def test_a_log_that_no_speed_explains_is_out_and_says_so(time_s: Array) -> None:
    noise = np.random.default_rng(1).normal(size=len(time_s))
    one = judged({"t": time_s, "rocker": noise}, drive="fitted")
    assert one.verdict == "out"
    assert "no speed and start" in one.notes[0]
    assert one.causes == ()


def test_a_wrapped_crank_may_be_logged_seldom() -> None:
    time_s = np.linspace(0.0, 3.0, 10)
    motion = solve(SCENE, time_s)
    columns = {"t": time_s, "crank": motion.links["crank"].theta % (2 * np.pi)}
    one = judged({**columns, "rocker": motion.links["rocker"].theta}, drive="fitted")
    assert one.verdict == "within"
    assert one.fit.speed_rad_s == pytest.approx(10.0)


def test_a_crank_that_stands_still_has_no_speed() -> None:
    with pytest.raises(CrankcheckError, match="stands still"):
        judged({"crank_deg": np.full(601, 37.3)}, drive="fitted")


def test_the_geometry_alone_is_judged_at_the_logged_crank() -> None:
    wobbly = 10 * TIME_S + 0.2 * np.sin(9 * TIME_S)
    other = solve(SCENE, wobbly / 10)  # at 10 rad/s that is the angle of the crank
    angle = (
        other.links["crank"].theta - other.links["crank"].theta[0] + MOTION.links["crank"].theta[0]
    )
    columns = {"crank": angle, "rocker": other.links["rocker"].theta, "rocker_rad_s": ROCKER.omega}
    assert judged(columns).verdict == "out"
    one = judged(columns, drive="logged")
    assert one.verdict == "within"
    assert "velocity of rocker" in one.not_judged
    with pytest.raises(CrankcheckError, match="no angle of crank"):
        judged({"rocker": ROCKER.theta}, drive="logged")


def test_what_is_required_must_be_there() -> None:
    columns = {"rocker": ROCKER.theta}
    assert rules(judged(columns, require=["rocker.angle"])) == []
    assert rules(judged(columns, require=["velocity", "rocker.angle"])) == ["CC119"]
    assert rules(judged(columns, require=["coupler", "velocity"])) == ["CC119"]
    with pytest.raises(CrankcheckError, match="neither a quantity nor a body"):
        judged(columns, require=["velocities"])


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("crank.angle", "not in the log: angle of crank"),
        ("drive", "not in the log: drive (angle of crank)"),
        ("A", "not in the log: gap of A (a point of the ground is not judged else)"),
        ("coupler.velocity", "not in the log: velocity of coupler"),
    ],
)
def test_what_is_required_and_not_there_is_named_as_its_user_does(name: str, text: str) -> None:
    one = judged({"rocker": ROCKER.theta}, require=[name])
    assert [finding.text for finding in one.failures] == [text]
    assert RULES[one.failures[0].rule].title == "required"


@pytest.mark.parametrize(
    ("name", "why"),
    [
        ("A.position", "a point of the ground"),
        ("rocker.position", "rocker has none"),
        ("displacement", "fourbar-lecture-1 has none"),
    ],
)
def test_what_no_log_is_judged_for_is_not_to_be_required(name: str, why: str) -> None:
    with pytest.raises(CrankcheckError, match=f"--require {name}: {why}"):
        judged({"rocker": ROCKER.theta}, require=[name])


def test_another_assembly_is_named() -> None:
    other = solve(replace(SCENE, branch=dict.fromkeys(MOTION.conditioning, -1)), TIME_S)
    columns = {name: other.links[name].theta for name in ("crank", "coupler", "rocker")}
    one = judged(columns)
    assert one.verdict == "out"
    assert "CC101" in rules(one)


def test_the_reference_itself_is_within_and_says_so() -> None:
    one = judged({"rocker": ROCKER.theta})
    assert one.verdict == "within"
    assert "compared with itself" in one.notes[0]


def test_the_gap_of_a_link_is_named_where_nothing_is_judged() -> None:
    told = map_of({"channel": [{"column": "open", "of": "rocker", "kind": "gap"}]}, "map")
    frame = pd.DataFrame({"t": TIME_S, "open": 1e-6 * TIME_S})
    with pytest.raises(CrankcheckError, match=r"it holds gap of rocker .a gap is of a pin"):
        judge_log(understood(columns_of(frame), SCENE, told), LogRequest(target={EVERY: 1e-3}))
