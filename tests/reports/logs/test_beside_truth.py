"""A log of several readings of one place or rate: no right one hides a wrong one."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pandas as pd
import pytest

from analytic.kinematics import solve
from models.array import Array
from models.files import load_scene
from reports.logs.columns import columns_of
from reports.logs.meanings import understood
from reports.own_log.judged import JudgedLog, LogRequest, judge_log
from reports.own_log.log_limits import EVERY
from reports.own_log.rows import log_rows

SCENE = load_scene("fourbar-lecture-1")
TIME_S = np.linspace(0.0, 0.6, 601)
MOTION = solve(SCENE, TIME_S)
COUPLER, ROCKER = (MOTION.links[name].theta for name in ("coupler", "rocker"))
VX = MOTION.points["C"].velocity[:, 0]


def judged(columns: Mapping[str, Array], step_s: float = 0.0) -> JudgedLog:
    log = understood(columns_of(pd.DataFrame({"t": TIME_S, **columns})), SCENE)
    return judge_log(log, LogRequest(target={EVERY: 1e-3}, step_s=step_s))


@pytest.mark.parametrize("wrong", ["coupler.C.vx", "rocker.C.vx"])
def test_each_copy_of_a_rate_is_judged(wrong: str) -> None:
    columns: dict[str, Array] = {"coupler.C.vx": VX, "rocker.C.vx": VX}
    assert judged(columns).verdict == "within"
    out = judged({**columns, wrong: 9 * VX + 4})
    assert out.verdict == "out"
    assert log_rows(out)[0].columns == ("coupler.C.vx", "rocker.C.vx")


@pytest.mark.parametrize(
    ("name", "right"),
    [("rocker_rad", ROCKER), ("rocker_rel_crank_rad", ROCKER - MOTION.links["crank"].theta)],
)
def test_an_angle_relative_to_another_link_is_judged_beside_others(name: str, right: Array) -> None:
    columns: dict[str, Array] = {name: right, "rocker_rel_coupler_rad": ROCKER - COUPLER}
    assert judged(columns).verdict == "within"
    for wrong in columns:
        out = judged({**columns, wrong: columns[wrong] + 0.3 * np.sin(9 * TIME_S)})
        assert out.verdict == "out"
        assert log_rows(out)[0].columns == (name, "rocker_rel_coupler_rad")


def test_small_errors_of_either_sign_are_not_differenced_as_jumps() -> None:
    off = 1e-4 * np.sin(9 * TIME_S)
    columns = {"rocker_rad": ROCKER + off, "rocker_rel_coupler_rad": ROCKER - COUPLER - off}
    assert judged(columns, step_s=1e-3).verdict == "within"
