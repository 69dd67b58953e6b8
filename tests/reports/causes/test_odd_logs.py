"""Logs of which nothing can be said, or nothing that needs more than they have, get no cause and no
failure; what is told of others is true."""

from __future__ import annotations

import numpy as np
import pytest

import crankcheck
from analytic.kinematics import solve, solve_driven
from models.files import load_scene
from tests.worlds.tiers import slowly

TIME_S = np.linspace(0.0, 0.6, 301)
FOURBAR = "fourbar-lecture-1"
ROCKER = solve(load_scene(FOURBAR), TIME_S).links["rocker"].theta


def judged(column: str, values: object, scene: str = FOURBAR) -> crankcheck.LogVerdict:
    return crankcheck.judge(scene, {"time_s": TIME_S[: len(values)], column: values}, target=1e-3)  # type: ignore[arg-type]


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
    one = judged(column, np.full(TIME_S.size, value), scene)
    assert one.verdict == "out"
    assert [cause.name for cause in one.causes] == ["stuck"]


NOISE = {f"{n} rows": ("rocker_deg", np.random.default_rng(n).normal(size=n)) for n in (2, 3, 7)}
NOTHING = {
    **NOISE,
    "a gap": ("C_gap_mm", np.full(TIME_S.size, 5.0)),
    "noise": ("rocker_rad", ROCKER + 0.01 * np.random.default_rng(1).normal(size=TIME_S.size)),
}


@pytest.mark.parametrize("case", NOTHING)
def test_of_a_gap_of_a_few_rows_and_of_noise_nothing_is_said(case: str) -> None:
    one = judged(*NOTHING[case])
    assert (one.verdict, one.causes) == ("out", ())


def test_another_start_and_another_speed_are_both_told() -> None:
    crank = 10.05 * TIME_S + 0.3
    rocker = solve_driven(load_scene(FOURBAR), crank, 10.05, 0.0).links["rocker"].theta
    log = {"time_s": TIME_S, "crank_rad": crank, "rocker_rad": rocker}
    (cause,) = crankcheck.judge(FOURBAR, log, target=1e-3).causes
    assert "10.05 rad/s, not 10 rad/s" in cause.text
    assert cause.left < 1e-6


@pytest.mark.parametrize("shift", [12, -12, 40])
@pytest.mark.parametrize("ends", ["held", "from the other end"])
def test_a_delay_is_one_whatever_stands_where_it_had_no_readings(shift: int, ends: str) -> None:
    places = np.arange(TIME_S.size) - shift
    late = ROCKER[np.clip(places, 0, TIME_S.size - 1) if ends == "held" else places % TIME_S.size]
    (cause,) = judged("rocker_rad", late).causes
    assert cause.name == "delay"
    assert f"{abs(shift)}.00 samples" in cause.text or f" {abs(shift)}.0 samples" in cause.text
    assert ("earlier" if shift > 0 else "later") in cause.text
