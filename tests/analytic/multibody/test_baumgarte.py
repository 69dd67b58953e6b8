"""Baumgarte's terms: what they let decay, what they cost, and where they fail."""

from __future__ import annotations

import math

import numpy as np
import pytest

from analytic.multibody.baumgarte_table import STABLE, baumgarte_table
from analytic.multibody.multibody_motion import Baumgarte
from analytic.multibody.release_multibody import release_multibody
from models.errors import CrankcheckError
from tests.analytic.multibody.scenes import THESIS, scene
from tests.worlds.tiers import slowly

SWING = scene(THESIS.replace("start_deg", "speed_rad_s = 6.0\nstart_deg"))


@pytest.mark.parametrize("until_s", [0.15, slowly(0.3, reason="errors that grow with time")])
def test_without_error_of_the_steps_there_is_nothing_to_decay(until_s: float) -> None:
    time_s = np.linspace(0.0, until_s, 11)
    free = release_multibody(SWING, until_s, Baumgarte(20.0, 20.0))
    other = release_multibody(SWING, until_s)
    assert free.gap(time_s).max() < 1e-11
    for link, motion in free.at(time_s).links.items():
        assert motion.theta == pytest.approx(other.at(time_s).links[link].theta, abs=1e-10)


def test_the_table_shows_the_order_the_best_and_where_it_fails() -> None:
    step_s = 4e-3
    rows = baumgarte_table(SWING, 0.3, (0.0, 20.0, 800.0), (2 * step_s, step_s))
    errors = {(row.alpha, row.step_s): row.error for row in rows}
    assert 10.0 < errors[0.0, 2 * step_s] / errors[0.0, step_s] < 26.0  # order 4
    gaps = {(row.alpha, row.step_s): row.gap for row in rows}
    assert gaps[20.0, step_s] < 0.5 * gaps[0.0, step_s]
    for row in rows:
        assert row.stable == (row.alpha * row.step_s <= STABLE)
        assert math.isinf(row.error) == (not row.stable)


@pytest.mark.parametrize("wrong", [(-1.0, 0.0, None), (1.0, 1.0, 0.0), (math.nan, 0.0, 1e-3)])
def test_numbers_that_let_nothing_decay_are_refused(wrong: tuple[float, float, float]) -> None:
    with pytest.raises(CrankcheckError, match=r"give rates .* of 0 or more, and a step"):
        Baumgarte(*wrong)
