"""Logs of which nothing can be said, or nothing that needs more than they have, get no cause and no
failure; what is told of others is true."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from analytic.kinematics import solve, solve_driven
from models.files import load_scene
from reports.logs.columns import columns_of
from reports.logs.meanings import understood
from reports.own_log.judged import JudgedLog, LogRequest, judge_log
from reports.own_log.log_limits import EVERY
from tests.worlds.tiers import slowly

TIME_S = np.linspace(0.0, 0.6, 301)
FOURBAR = "fourbar-lecture-1"


def judged(scene: str, columns: dict[str, object]) -> JudgedLog:
    log = understood(columns_of(pd.DataFrame(columns)), load_scene(scene))
    return judge_log(log, LogRequest(target={EVERY: 1e-3}))


@pytest.mark.parametrize(
    ("scene", "column"),
    [
        (FOURBAR, "rocker_omega_rad_s"),
        (FOURBAR, "crank_deg"),
        ("tangent", "lever_theta_rad"),
        ("tangent", "sleeve_slider_speed_m_s"),
        ("slotted-lever", "lever_alpha_rad_s2"),
        ("sixbar-watt", "C_vx_m_s"),
    ],
)
@pytest.mark.parametrize("value", [slowly(0.0, reason="as without power; its mean is 0"), 37.3])
def test_a_sensor_that_stands_still_is_out_and_said_to_stand(
    scene: str, column: str, value: float
) -> None:
    one = judged(scene, {"time_s": TIME_S, column: np.full(TIME_S.size, value)})
    assert one.verdict == "out"
    assert [cause.name for cause in one.causes] == ["stuck"]


def test_of_a_gap_alone_nothing_is_said() -> None:
    one = judged(FOURBAR, {"time_s": TIME_S, "C_gap_mm": np.full(TIME_S.size, 5.0)})
    assert (one.verdict, one.causes) == ("out", ())


@pytest.mark.parametrize("rows", [2, 3, 7])
def test_of_a_few_rows_nothing_is_said(rows: int) -> None:
    noise = np.random.default_rng(rows).normal(size=rows)
    one = judged(FOURBAR, {"time_s": TIME_S[:rows], "rocker_deg": noise})
    assert (one.verdict, one.causes) == ("out", ())


def test_another_start_and_another_speed_are_both_told() -> None:
    crank = 10.05 * TIME_S + 0.3
    other = solve_driven(load_scene(FOURBAR), crank, 10.05, 0.0)
    rocker = other.links["rocker"].theta
    one = judged(FOURBAR, {"time_s": TIME_S, "crank_rad": crank, "rocker_rad": rocker})
    (cause,) = one.causes
    assert "10.05 rad/s, not 10 rad/s" in cause.text
    assert cause.left < 1e-6


@pytest.mark.parametrize("shift", [12, -12, 40])
@pytest.mark.parametrize("ends", ["held", "from the other end"])
def test_a_delay_is_one_whatever_stands_where_it_had_no_readings(shift: int, ends: str) -> None:
    rocker = solve(load_scene(FOURBAR), TIME_S).links["rocker"].theta
    places = np.arange(TIME_S.size) - shift
    late = rocker[np.clip(places, 0, TIME_S.size - 1) if ends == "held" else places % TIME_S.size]
    one = judged(FOURBAR, {"time_s": TIME_S, "rocker_rad": late})
    (cause,) = one.causes
    assert cause.name == "delay"
    assert f"{abs(shift)}.00 samples" in cause.text or f" {abs(shift)}.0 samples" in cause.text
    assert ("earlier" if shift > 0 else "later") in cause.text


def test_noise_has_no_cause() -> None:
    rocker = solve(load_scene(FOURBAR), TIME_S).links["rocker"].theta
    noise = 0.01 * np.random.default_rng(1).normal(size=TIME_S.size)
    one = judged(FOURBAR, {"time_s": TIME_S, "rocker_rad": rocker + noise})
    assert (one.verdict, one.causes) == ("out", ())
