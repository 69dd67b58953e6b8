"""What is proposed for random tasks meets every position, and has the defects that it is said to
have: seen by following the scene's own law, which knows nothing of circuits."""

from __future__ import annotations

import math

import numpy as np
import pytest

from analytic.kinematics import solve
from analytic.synthesis.examine import Examined
from analytic.synthesis.passing import passing_times
from models.errors import CrankcheckError, ReachError
from models.laws import Oscillating
from tests.analytic.synthesis.random_tasks import TASKS, random_solutions
from tests.worlds.tiers import at_length, slowly

MET = 1e-10
"""Of the size, over the square of the sine of the worst transmission in a position: near a limit
places are worse conditioned than anywhere else."""


def followed(one: Examined) -> tuple[float, float]:
    """How far the scene is from the positions when its driver goes through them [of the size], and
    the least sine there; inf where it can not, or meets them in another order."""
    law = one.scene.driver.law
    at_s = passing_times(law, [position.driver_rad for position in one.positions])
    if np.any(np.diff(at_s) <= 0.0) or np.ptp(at_s) > law.period_s * (1.0 + 1e-9):
        return math.inf, 1.0
    if isinstance(law, Oscillating):
        angles = np.array([position.driver_rad for position in one.positions])
        if np.max(np.abs(angles - law.centre_rad)) > abs(law.amplitude_rad) * (1.0 + 1e-9):
            return math.inf, 1.0
    try:
        on_the_way = np.linspace(0.0, at_s.max(), 200)
        motion = solve(one.scene, np.concatenate([at_s, on_the_way]), bound=False)
    except ReachError:
        return math.inf, 1.0
    size = one.scene.longest_m
    off = (each.off(motion, size)[k] for k, each in enumerate(one.positions))
    sine = min(float(np.min(s[: len(at_s)])) for s in motion.conditioning.values())
    return float(max(off)), min(1.0, sine)


def hold(kind: str, number: int) -> tuple[int, int]:
    """The solutions of a task: how many have no defect, of how many."""
    try:
        found = random_solutions(kind, number).examined
    except CrankcheckError:
        if kind != "four_positions":  # of others a mechanism is known
            raise
        return 0, 0
    for one in found:
        off, sine = followed(one)
        if one.defects:
            assert off > 1e-6, (kind, number, one.defects, one.text)
        else:
            assert off < MET / sine**2, (kind, number, off, one.off, one.text)
    return sum(not one.defects for one in found), len(found)


RARE = {"three_positions", "given_pivots", "four_positions"}
"""Of whose tasks few have a solution without a defect."""


@pytest.mark.parametrize(
    ("kind", "numbers"),
    [
        *((kind, range(4 if kind in RARE else 1)) for kind in TASKS),
        *(slowly(kind, range(44), reason="of forty, some are near a limit") for kind in TASKS),
        *(at_length(kind, range(4, 1004), reason="one circuit in a hundred") for kind in TASKS),
    ],
    ids=lambda one: one if isinstance(one, str) else str(len(one)),
)
def test_solutions_do_what_is_said_of_them(kind: str, numbers: range) -> None:
    sound = [hold(kind, number) for number in numbers]
    assert sum(some for some, _ in sound) > 0.05 * sum(every for _, every in sound)
