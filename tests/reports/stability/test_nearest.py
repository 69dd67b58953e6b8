"""How near to a singular position a hard run is said to come."""

from __future__ import annotations

import numpy as np
import pytest

from analytic.kinematics import solve
from reports.stability.catalogue import CATALOGUE
from reports.stability.error_series import nearest


@pytest.mark.parametrize(
    ("case", "value", "least"),
    [("lever-through-pivot", 360.0, 0.01), ("swinging-lever", 1e-6, 0.01)],
)
def test_a_lever_whose_block_comes_to_its_pivot_is_said_to_be_near(
    case: str, value: float, least: float
) -> None:
    trial = CATALOGUE[case].trial(value)
    motion = solve(trial.scene, np.arange(1441) * trial.dt_s, bound=False)
    assert 0.0 <= nearest(trial.scene, motion) < least


def test_a_scene_far_from_singular_positions_is_said_to_be_far() -> None:
    trial = CATALOGUE["swinging-lever"].trial(1.0)
    motion = solve(trial.scene, np.arange(1441) * trial.dt_s, bound=False)
    assert nearest(trial.scene, motion) == pytest.approx(1.0 / 3.0, abs=1e-4)
