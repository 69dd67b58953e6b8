"""A motion that comes to an infinite speed in a finite time, and what is said of it."""

from __future__ import annotations

import re
from collections.abc import Callable

import numpy as np
import pytest

from analytic.free.release import release
from analytic.kinematics import solve
from analytic.multibody.release_multibody import release_multibody
from models.errors import CrankcheckError
from models.scene import Scene
from tests.analytic.multibody.scenes import ROTOR, ROTOR_J, SLIDER_CRANK, scene

SQUARE = (
    "start_deg = 60.0\nspeed_rad_s = 5.0\n"
    '[loads.motor]\nlink = "{}"\nlaw = "polynomial"\nover = "omega"\ntorque_n_m = [0.0, 0.0, {}]\n'
)
ROTOR_LOST_S = 0.2
"""omega' = c omega^2 has omega = 1 / (1 / 5 - c t), here with c = 1."""


def by_bodies(mechanism: Scene) -> None:
    near = solve(mechanism, np.zeros(1), bound=False).state()
    release_multibody(mechanism, 2.0, near=near).at(np.array([2.0]))


def by_its_equation(mechanism: Scene) -> None:
    release(mechanism, 2.0).at(np.array([2.0]))


@pytest.mark.parametrize("let_go", [by_bodies, by_its_equation])
def test_one_that_runs_away_is_told_until_when(let_go: Callable[[Scene], None]) -> None:
    rotor = scene(ROTOR + SQUARE.format("rod", ROTOR_J), 0.0)
    with pytest.raises(CrankcheckError, match=r"loads\.motor over omega drives it") as told:
        let_go(rotor)
    lost_s = re.search(r"runs away: at about (\S+) s", str(told.value))
    assert lost_s is not None
    assert float(lost_s[1]) == pytest.approx(ROTOR_LOST_S, rel=1e-3)
    assert "give a time of 0.18 s or less" in str(told.value)


def test_a_mechanism_that_turns_ever_faster_is_refused_soon(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """By a load that grows with the angle its turns never end, in less and less time."""
    monkeypatch.setattr("analytic.free.integration.MOST_WINDOWS", 5_000)
    steep = SQUARE.replace('"omega"', '"angle"').replace("[0.0", "[0.0, 0.0")
    with pytest.raises(CrankcheckError, match=r"loads\.motor over angle drives it"):
        by_its_equation(scene(SLIDER_CRANK + steep.format("crank", 0.1)))
