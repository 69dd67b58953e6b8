"""A user's log is judged for what it holds, by what moves it, within what he asks for; of what no
cause explains, he is told what part of the error it is, and how that goes on."""

from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import crankcheck
from analytic.kinematics import solve, solve_driven
from crankcheck import CrankcheckError, LogVerdict
from crankcheck.testing import assert_within
from models.array import Array
from models.errors import ReachError
from models.files.reading import load_scene
from models.scene import Scene
from reports.describe.free_motion import motion_frame
from reports.describe.with_forces import with_forces
from reports.judge.rules import RULES
from reports.own_log import drives
from reports.own_log.drives import moved
from reports.own_log.judged import log_rows
from reports.own_log.table import not_judged_lines
from tests.worlds.tiers import few, slow, slowly

SCENE = load_scene("fourbar-lecture-1")
TIME_S = np.linspace(0.0, 2.0, 601)
MOTION = solve(SCENE, TIME_S)
CRANK, COUPLER, ROCKER = (MOTION.links[name] for name in ("crank", "coupler", "rocker"))
C = MOTION.points["C"]
WOBBLE = 0.01 * (np.sin(3.3 * TIME_S) + np.sin(7.9 * TIME_S + 1.0))


def judged(columns: Mapping[str, object], target: object = 1e-3, **asked: object) -> LogVerdict:
    return crankcheck.judge(SCENE, {"t": TIME_S, **columns}, target=target, **asked)  # type: ignore[call-overload, no-any-return]


def rules(one: LogVerdict) -> list[str]:
    return [finding.rule for finding in one.failures]


def test_a_log_of_one_column_is_judged_for_it_and_the_rest_is_told() -> None:
    one = judged({"rocker": ROCKER.theta + 1e-4 * np.sin(TIME_S)})
    assert one.verdict == "within"
    assert [(row.quantity, row.body) for row in one.errors.rows] == [("angle", "rocker")]
    assert one.errors.rows[0].maximum == pytest.approx(1e-4 * np.sin(TIME_S).max(), rel=1e-6)
    assert {"drive of crank", "velocity of rocker"} <= set(one.not_judged)
    assert "angle of rocker" not in one.not_judged


def test_what_is_off_by_more_than_the_target_is_out_one_coordinate_by_itself_as_well() -> None:
    assert rules(judged({"rocker": ROCKER.theta * 1.001})) == ["CC103"]
    assert rules(judged({"rocker": ROCKER.theta * 1.001}, 1e-2)) == []
    one = judged({"C.x_mm": 1e3 * C.position[:, 0] + 2.0 * np.sin(TIME_S)})
    assert rules(one) == ["CC113"]
    assert one.errors.rows[0].maximum == pytest.approx(2e-3 * np.sin(TIME_S).max(), rel=1e-9)


def test_each_quantity_may_have_a_target_of_its_own_and_needs_one_without_a_step() -> None:
    columns = {"rocker": ROCKER.theta * 1.0001, "rocker_rad_s": ROCKER.omega * 1.01}
    assert rules(judged(columns)) == ["CC106"]
    assert rules(judged(columns, {"angle": 1e-3, "velocity": 0.1})) == []
    assert_within(SCENE, {"t": TIME_S, **columns}, target=1e-3, velocity=0.1)
    with pytest.raises(CrankcheckError, match="no limit for velocity: the step of the log is"):
        judged(columns, {"angle": 1e-3})


def test_a_step_gives_the_budget_of_verify_and_differences_even_samples() -> None:
    one = judged({"rocker": ROCKER.theta}, None, step_s=0.002)
    even = {"angle", "velocity-differenced", "acceleration-differenced"}
    assert {row.tolerance for row in one.errors.rows} == even
    assert one.limits["angle"].origin == "default"
    uneven = TIME_S + 1e-4 * np.sin(7 * np.arange(601))
    angle = solve(SCENE, uneven).links["rocker"].theta
    again = judged({"t": uneven, "rocker": angle}, None, step_s=0.001)
    assert {row.tolerance for row in again.errors.rows} == {"angle"}


def test_two_copies_of_a_pin_that_part_are_an_open_joint() -> None:
    x, y = C.position.T
    apart = 1e-3 * np.sin(TIME_S)
    one = judged({"coupler.C.x": x, "coupler.C.y": y, "rocker.C.x": x + apart, "rocker.C.y": y})
    assert rules(one) == ["CC105"]
    assert one.errors.worst("gap").maximum == pytest.approx(apart.max())


REL_CRANK, REL_COUPLER = ROCKER.theta - CRANK.theta, ROCKER.theta - COUPLER.theta
SEVERAL = [
    slowly(
        {"coupler.C.vx": C.velocity[:, 0], "rocker.C.vx": C.velocity[:, 0]},
        reason="a velocity of a pin by two links, as an angle by two others",
        id="coupler.C.vx+rocker.C.vx",
    ),
    {"rocker_rel_crank_rad": REL_CRANK, "rocker_rel_coupler_rad": REL_COUPLER},
]


@pytest.mark.parametrize("columns", SEVERAL, ids="+".join)
def test_no_right_reading_hides_a_wrong_one_of_the_same_thing(columns: dict[str, Array]) -> None:
    some = {"t": TIME_S, **columns}
    some = {name: each[::5] for name, each in some.items()}
    assert judged(some).verdict == "within"
    for wrong in columns:
        out = judged({**some, wrong: some[wrong] + 0.3 * np.sin(9 * some["t"])})
        assert out.verdict == "out"
        assert log_rows(out)[0].columns == tuple(columns)


def test_small_errors_of_either_sign_are_not_differenced_as_jumps() -> None:
    off = 1e-4 * np.sin(9 * TIME_S)
    columns = {"rocker_rad": ROCKER.theta + off, "rocker_rel_coupler_rad": REL_COUPLER - off}
    assert judged(columns, step_s=1e-3).verdict == "within"


ALL = "all starts and rows: a fit that ends beside the best one is found in long logs first"


@pytest.fixture(params=[(6, 4), slowly((drives.STARTS, 1), reason=ALL)], ids=["few", "all"])
def time_s(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> Array:
    """The instants of a log whose drive is fitted. Start angles that are tried take the time of a
    fit, and so do rows: few of both are enough for what these logs hold."""
    starts, every = request.param
    monkeypatch.setattr(drives, "STARTS", starts)
    return np.linspace(0.0, 1.2, 601)[::every]


@pytest.mark.parametrize("crank", [True, slowly(False, reason="a second: without the crank below")])
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


@pytest.mark.parametrize("speed", [-10.0, slowly(1.0, reason="a fifth of a turn in all")])
def test_any_speed_is_found_without_the_crank(speed: float, time_s: Array) -> None:
    other = solve(moved(SCENE, speed, 0.7), time_s)
    one = judged({"t": time_s, "C.x": other.points["C"].position[:, 0]}, drive="fitted")
    assert one.verdict == "within"
    assert one.fit.explains
    assert one.fit.speed_rad_s == pytest.approx(speed, rel=1e-9)


def test_a_log_that_no_speed_explains_is_out_and_says_so(time_s: Array) -> None:
    noise = np.random.default_rng(1).normal(size=len(time_s))
    one = judged({"t": time_s, "rocker": noise}, drive="fitted")
    assert (one.verdict, one.causes) == ("out", ())
    assert "no speed and start" in one.notes[0]


def test_the_geometry_alone_is_judged_at_the_logged_crank() -> None:
    wobbly = 10 * TIME_S + 0.2 * np.sin(9 * TIME_S)
    other = solve(SCENE, wobbly / 10)  # at 10 rad/s that is the angle of the crank
    turned = other.links["crank"].theta - other.links["crank"].theta[0]
    columns = {"crank": turned + CRANK.theta[0], "rocker": other.links["rocker"].theta,
               "rocker_rad_s": ROCKER.omega}  # fmt: skip
    assert judged(columns).verdict == "out"
    one = judged(columns, drive="logged")
    assert one.verdict == "within"
    assert "velocity of rocker" in one.not_judged
    with pytest.raises(CrankcheckError, match="no angle of crank"):
        judged({"rocker": ROCKER.theta}, drive="logged")
    lines = not_judged_lines(one)
    assert [("velocity of rocker" in line, "the log lacks" in line) for line in lines] == [
        (True, False), (False, True)
    ]  # fmt: skip
    for name in ("velocity", "rocker.velocity", "crank.angle"):
        with pytest.raises(CrankcheckError, match=r"the log has the .* drive logged judges the g"):
            judged(columns, drive="logged", require=name)


SHORT = """name = "short"
source = "own numbers: the crank swings between limits"
[ground]
points = {A = [0, 0], D = [0.5, 0]}
[links]
crank = {bar = ["A", "B"], length_m = 0.2}
coupler = {bar = ["B", "C"], length_m = 0.25}
rocker = {bar = ["D", "C"], length_m = 0.6}
[driver]
link = "crank"
speed_rad_s = -2.0
start_deg = 100.0
[branch]
C = 1
"""


def test_a_drive_that_leads_out_of_reach_names_that_which_judges_the_log(tmp_path: Path) -> None:
    (tmp_path / "short.toml").write_text(SHORT, encoding="utf-8")
    scene = load_scene(tmp_path / "short.toml")
    time_s = np.linspace(0.0, 2.0, 200)
    crank = np.radians(90.0 + 10.0 * np.cos(4.0 * time_s))
    still = solve_driven(scene, crank, 0.0 * crank, 0.0 * crank)
    columns = {"t": time_s, "rocker": still.links["rocker"].theta}
    for more, words in (({"crank": crank}, "judge it at its own"), ({}, "log the")):
        with pytest.raises(ReachError, match=f"{words} angle of crank: drive logged"):
            crankcheck.judge(scene, {**columns, **more}, target=1e-9)
    columns["crank"] = crank
    assert crankcheck.judge(scene, columns, target=1e-9, drive="logged").verdict == "within"


TURNED = np.degrees(CRANK.theta)
TABLES: dict[str, dict[str, object]] = {
    "degrees": {"crank_deg": TURNED},
    "a frame number": {"frame": np.arange(601), "crank_deg": TURNED % 360.0},
    "falling": {"crank_deg": TURNED},
    "to and fro": {"crank_deg": TURNED},
    "a motor's angle": {"No": np.arange(601), "motor [rad]": CRANK.theta},
}


@pytest.mark.parametrize("case", few(TABLES, [*TABLES][::2], "other tables"))
def test_a_table_over_the_angle_of_the_crank_needs_no_times(case: str) -> None:
    columns = TABLES[case] | {
        "rocker_deg": np.degrees(ROCKER.theta), "C_x": C.position[:, 0],
        "rocker_rad_s": ROCKER.omega,
        "coupler_rad_s2": COUPLER.alpha, "quality": np.sin(ROCKER.theta - COUPLER.theta),
    }  # fmt: skip
    rows = {"falling": slice(None, None, -7), "to and fro": np.r_[0:300:5, 300:0:-5]}.get(
        case, slice(0, None, 5)
    )
    columns = {name: np.asarray(each)[rows] for name, each in columns.items()}
    judge = partial(crankcheck.judge, SCENE, target=1e-9)
    one = judge(columns)
    assert one.verdict == "within"
    assert {(row.quantity, row.body) for row in one.errors.rows} == {
        ("angle", "rocker"), ("position", "C"), ("velocity", "rocker"), ("acceleration", "coupler"),
    }  # fmt: skip
    driver = next(name for name in columns if "deg" in name or "[rad]" in name)
    assert judge(pd.DataFrame(columns).set_index(driver)).verdict == "within"
    each = ("rocker_deg", "C_x", "rocker_rad_s", "coupler_rad_s2")
    for name in each[list(TABLES).index(case) :][:1]:
        wrong = {**columns, name: columns[name] * 1.001}
        out = judge(wrong)
        assert out.verdict == "out"
        assert [row.columns for row in log_rows(out) if row.verdict == "out"] == [(name,)]
        assert " at driver " in out.failures[0].text
    alone = judge(columns, drive="logged")
    assert {row.quantity for row in alone.errors.rows} == {"angle", "position"}
    for asked, words in (
        ({"drive": "fitted"}, "which a speed needs"),
        ({"step_s": 1e-3}, "which a step needs"),
    ):
        with pytest.raises(CrankcheckError, match=words):
            judge(columns, **asked)


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("drive", "drive (angle of crank)"),
        ("A", "gap of A (a point of the ground is not judged otherwise)"),
        ("coupler.velocity", "velocity of coupler"),
    ],
)
def test_what_is_required_and_not_there_is_named_as_its_user_does(name: str, text: str) -> None:
    (finding,) = judged({"rocker": ROCKER.theta}, require=[name, "rocker.angle"]).failures
    assert finding.text == f"not in the log: {text}"
    assert RULES[finding.rule].title == "required"


@pytest.mark.parametrize(
    ("name", "why"),
    [
        ("A.position", "a point of the ground"),
        ("rocker.position", "rocker has none"),
        ("displacement", "fourbar-lecture-1 has none"),
        ("velocities", "neither a quantity nor a body"),
    ],
)
def test_what_no_log_is_judged_for_is_not_to_be_required(name: str, why: str) -> None:
    with pytest.raises(CrankcheckError, match=f"^require '?{name}'?: {why}"):
        judged({"rocker": ROCKER.theta}, require=[name])


def test_the_reference_itself_is_within_and_says_so() -> None:
    one = judged({"rocker": ROCKER.theta})
    assert one.verdict == "within"
    assert "compared with itself" in one.notes[0]


def test_the_gap_of_a_link_is_named_where_nothing_is_judged() -> None:
    told = {"channel": [{"column": "open", "of": "rocker", "kind": "gap"}]}
    with pytest.raises(CrankcheckError, match=r"it holds gap of rocker .a gap is of a pin"):
        judged({"open": 1e-6 * TIME_S}, map=told)


def test_a_drive_that_is_off_is_told_from_a_geometry_that_is() -> None:
    rocker = solve(SCENE, TIME_S + WOBBLE / 10.0, bound=False).links["rocker"].theta
    of_drive = judged({"crank": CRANK.theta + WOBBLE, "rocker": rocker})
    of_geometry = judged({"crank": CRANK.theta, "rocker": ROCKER.theta + WOBBLE})
    assert (of_drive.causes, of_geometry.causes) == ((), ())
    assert "the drive is off, and not the geometry" in of_drive.notes[0]
    assert "the drive is not the cause" in of_geometry.notes[0]
    assert "angle of rocker is off by" in of_geometry.notes[0]


def test_the_joint_that_opens_most_is_told() -> None:
    x, y = C.position.T
    one = judged({"rocker": ROCKER.theta + WOBBLE, "coupler.C.x": x, "coupler.C.y": y,
                  "rocker.C.x": x + 0.1 * WOBBLE, "rocker.C.y": y})  # fmt: skip
    assert "the joint that opens most, C, opens by" in one.notes[0]


@pytest.mark.parametrize(
    ("error", "words"),
    [
        (0.01 * np.sin(2.0 * CRANK.theta) ** 3 + 0.002 * WOBBLE, "repeats every turn"),
        slowly(WOBBLE, "has another shape", reason="what is neither"),
        slowly(0.05 * TIME_S**1.5 + WOBBLE / 3.0, "grows or falls linearly", reason="0.4 s"),
    ],
)
def test_how_an_error_goes_on_is_told(error: Array, words: str) -> None:
    one = judged({"rocker": ROCKER.theta + error})
    assert one.causes == ()
    assert words in one.notes[-1]
    assert "rocker" in one.notes[-1]


def test_nothing_is_told_of_a_log_that_is_within_or_explained() -> None:
    assert judged({"rocker": ROCKER.theta + 1e-5 * WOBBLE}).notes == ()
    wrong_sign = judged({"rocker": -ROCKER.theta})
    assert wrong_sign.causes
    assert wrong_sign.notes == ()


def test_a_wrapped_crank_that_is_logged_too_seldom_is_told_to_be() -> None:
    time_s = np.arange(20) * 0.2 * np.pi / 1.02
    turned = np.mod(solve(SCENE, time_s + 0.01).links["crank"].theta, 2.0 * np.pi)
    one = judged({"t": time_s, "crank": turned})
    assert "crank turns by 0.98 turns from row to row" in one.notes[0]
    often = judged({"crank": np.mod(CRANK.theta + 0.1, 2.0 * np.pi)})
    assert (often.verdict, often.notes) == ("out", ())


@slow("rare: a row a turn")
def test_a_crank_logged_once_a_turn_is_not_said_to_stand_as_one_that_has_no_speed_is() -> None:
    columns = {"t": np.arange(20) * 0.2 * np.pi, "crank": np.full(20, 1.7)}
    one = judged(columns)
    assert one.verdict == "out"
    assert "stuck" not in {cause.name for cause in one.causes}
    assert "turns by 1 turns from row to row" in one.notes[0]
    with pytest.raises(CrankcheckError, match="or goes round by whole turns between its rows"):
        judged(columns, drive="fitted")
    with pytest.raises(CrankcheckError, match="stands still"):
        judged({"crank_deg": np.full(601, 37.3)}, drive="fitted")


def written(scene: Scene) -> pd.DataFrame:
    """A turn with its forces, as we write it."""
    time_s = np.linspace(0.0, scene.driver.law.period_s, 200)
    return motion_frame(with_forces(scene, solve(scene, time_s)))


@slow("a second and a half: a triad; that of a dyad is planted in tests/reports/causes")
def test_a_log_of_another_assembly_of_a_triad_is_told_by_its_number() -> None:
    scene = load_scene("triad-platform")
    other = replace(scene, branch={"plate": 2})
    log = motion_frame(solve(other, np.linspace(0.0, scene.driver.law.period_s, 60)))
    angles = log[[c for c in log if c == "time_s" or c.endswith("_theta_rad")]]
    one = crankcheck.judge(scene, angles, target=1e-6)
    assert one.verdict == "out"
    assert "CC101" in rules(one)
    (cause,) = one.causes
    assert "the log is of another assembly at plate" in cause.text
    assert "plate = 2 under [branch]" in cause.text


def test_a_log_of_another_driver_is_within_with_its_forces_and_no_drive_is_fitted() -> None:
    name = "slider-crank-by-piston"
    log = written(load_scene(name))
    asked = {"forces": True, "require": "torque"}
    assert crankcheck.judge(name, log, target=1e-6, **asked).verdict == "within"  # type: ignore[call-overload]
    for drive in ("fitted", "logged"):
        with pytest.raises(CrankcheckError, match="this scene's is slider C"):
            crankcheck.judge(name, log, target=1e-6, drive=drive)
