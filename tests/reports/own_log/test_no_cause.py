"""Of what no cause explains, a log is told what part of the error it is, and how that goes on."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from analytic.kinematics import solve
from models.errors import CrankcheckError
from models.files import load_scene
from reports.logs.columns import columns_of
from reports.logs.meanings import understood
from reports.own_log.judged import JudgedLog, LogRequest, judge_log
from reports.own_log.log_limits import EVERY

SCENE = load_scene("fourbar-lecture-1")
TIME_S = np.linspace(0.0, 2.0, 601)
MOTION = solve(SCENE, TIME_S)
CRANK, ROCKER = (MOTION.links[name].theta for name in ("crank", "rocker"))
WOBBLE = 0.01 * (np.sin(3.3 * TIME_S) + np.sin(7.9 * TIME_S + 1.0))


def judged(columns: dict[str, object], drive: str = "scene") -> JudgedLog:
    log = understood(columns_of(pd.DataFrame({"t": TIME_S, **columns})), SCENE)
    return judge_log(log, LogRequest(target={EVERY: 1e-3}, drive=drive))  # type: ignore[arg-type]


def test_a_drive_that_is_off_is_told_from_a_geometry_that_is() -> None:
    rocker = solve(SCENE, TIME_S + WOBBLE / 10.0, bound=False).links["rocker"].theta
    of_drive = judged({"crank": CRANK + WOBBLE, "rocker": rocker})
    of_geometry = judged({"crank": CRANK, "rocker": ROCKER + WOBBLE})
    assert (of_drive.causes, of_geometry.causes) == ((), ())
    assert "it is the drive that is off, and not the geometry" in of_drive.notes[0]
    assert "the drive does not explain it" in of_geometry.notes[0]
    assert "that angle of rocker is off by" in of_geometry.notes[0]


def test_the_joint_that_opens_most_is_told() -> None:
    x, y = MOTION.points["C"].position.T
    one = judged({"rocker": ROCKER + WOBBLE, "coupler.C.x": x, "coupler.C.y": y,
                  "rocker.C.x": x + 0.1 * WOBBLE, "rocker.C.y": y})  # fmt: skip
    assert "the joint that opens most, C, opens by" in one.notes[0]


@pytest.mark.parametrize(
    ("error", "words"),
    [
        (0.01 * np.sin(2.0 * CRANK) ** 3 + 0.002 * WOBBLE, "comes back every turn"),
        (WOBBLE, "does none of these"),
        (0.05 * TIME_S**1.5 + WOBBLE / 3.0, "grows or falls evenly"),
    ],
)
def test_how_an_error_goes_on_is_told(error: object, words: str) -> None:
    one = judged({"rocker": ROCKER + error})
    assert one.causes == ()
    assert words in one.notes[-1]
    assert "rocker" in one.notes[-1]


def test_nothing_is_told_of_a_log_that_is_within_or_explained() -> None:
    assert judged({"rocker": ROCKER + 1e-5 * WOBBLE}).notes == ()
    wrong_sign = judged({"rocker": -ROCKER})
    assert wrong_sign.causes
    assert wrong_sign.notes == ()


def test_a_wrapped_crank_that_is_logged_too_seldom_is_told_to_be() -> None:
    time_s = np.arange(20) * 0.2 * np.pi / 1.02
    turned = np.mod(solve(SCENE, time_s + 0.01).links["crank"].theta, 2.0 * np.pi)
    one = judged({"t": time_s, "crank": turned})
    assert "crank turns by 0.98 turns from row to row" in one.notes[0]
    often = judged({"crank": np.mod(CRANK + 0.1, 2.0 * np.pi)})
    assert often.verdict == "out"
    assert often.notes == ()


def test_a_crank_logged_once_a_turn_is_not_said_to_stand() -> None:
    time_s = np.arange(20) * 0.2 * np.pi
    columns = {"t": time_s, "crank": np.full(20, 1.7)}
    one = judged(columns)
    assert one.verdict == "out"
    assert "stuck" not in {cause.name for cause in one.causes}
    assert "turns by 1 turns from row to row" in one.notes[0]
    with pytest.raises(CrankcheckError, match="or goes round by whole turns between its rows"):
        judged(columns, drive="fitted")


def test_a_point_whose_coordinates_are_off_by_too_much_only_together_has_its_cause_too() -> None:
    place, longest = MOTION.points["C"].position, SCENE.longest_m
    slow = solve(SCENE, (1.0 + 1.28e-4) * TIME_S, bound=False).points["C"].position
    off = np.abs(slow - place) / longest
    assert np.max(off) < 1e-3 < np.max(np.hypot(*off.T))
    one = judged({"C.x_mm": 1e3 * slow[:, 0], "C.y_mm": 1e3 * slow[:, 1]})
    assert one.verdict == "out"
    assert [cause.name for cause in one.causes] == ["drift"]
