"""Periods of free motion by quadrature, beside the integrated motion."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq

from analytic.free.free_motion import FreeMotion
from analytic.free.period import period
from analytic.free.release import release
from models.characteristics import Constant
from models.errors import CrankcheckError
from models.files import parse_scene
from models.loads import Load
from models.scene import Scene
from tests.analytic.free.mechanisms import fourbar, past_limits, slider_crank
from tests.worlds.tiers import slowly


def on_top_of_its_swing() -> Scene:
    """A rod that starts 0.001 deg below the top."""
    text = """
        name = "rod"
        source = "a test"
        gravity_m_s2 = [0.0, -9.81]
        ground = { points = { A = [0.0, 0.0] } }
        links = { crank = { bar = ["A", "B"], length_m = 1.0 } }
        driver = { link = "crank", law = "free", start_deg = 89.999 }
    """
    return parse_scene(text, "rod")


def times_of(free: FreeMotion, level: float, until_s: float) -> list[float]:
    """When the driver passes an angle upwards."""
    time_s = np.linspace(0.0, until_s, 4001)
    off = free.law.at(time_s)[0] - level

    def after(t: float) -> float:
        return float(free.law.at(np.array([t]))[0][0]) - level

    found = np.flatnonzero((off[:-1] < 0.0) & (off[1:] >= 0.0))
    return [float(brentq(after, time_s[k], time_s[k + 1], xtol=1e-16)) for k in found]


@pytest.mark.parametrize(
    ("scene", "until_s"),
    [
        (fourbar(), None),
        (slider_crank(), None),
        *(
            slowly(swung, 4.0, reason="other swings, and that one takes as long as the last")
            for swung in (
                fourbar(),
                fourbar(start_deg=-85.0),
                fourbar(speed_rad_s=5.0),
                slider_crank(),
            )
        ),
    ],
)
def test_swings_take_the_period_that_quadrature_has(scene: Scene, until_s: float | None) -> None:
    one = period(scene)
    assert one.swing_rad is not None
    until_s = until_s or 2.2 * one.time_s
    times = times_of(release(scene, until_s), 0.5 * sum(one.swing_rad), until_s)
    assert len(times) > 1
    assert np.abs(np.diff(times) - one.time_s).max() < 1e-12


@pytest.mark.parametrize("count", [3, slowly(5, reason="errors that grow with time")])
def test_turns_take_the_period_that_quadrature_has(count: int) -> None:
    scene = fourbar(speed_rad_s=40.0)
    one = period(scene)
    assert one.swing_rad is None
    times = one.time_s * np.arange(count)
    theta = release(scene, times[-1]).law.at(times)[0]
    assert np.abs(theta - theta[0] - math.tau * np.arange(count)).max() < 1e-11


@pytest.mark.parametrize(
    ("scene", "said"),
    [
        (
            replace(fourbar(), loads={"motor": Load("motor", "crank", None, Constant(1.0))}),
            "loads, dampers or friction",
        ),
        (past_limits(), "comes to its limit"),
        (on_top_of_its_swing(), "narrower than 0.5 deg"),
    ],
)
def test_a_period_is_refused_where_there_is_none(scene: Scene, said: str) -> None:
    with pytest.raises(CrankcheckError, match=said):
        period(scene)
