"""Tolerances and clearances, against closed forms and against a Monte Carlo."""

from __future__ import annotations

import functools
import math

import numpy as np
import pytest

from analytic.synthesis.examine import Examined
from analytic.synthesis.sensitivity import is_measured, monte_carlo, sensitivity
from analytic.synthesis.solutions import solutions_of
from models.tasks.files import load_task
from models.tasks.stroke import StrokeTask
from tests.worlds.tiers import slowly


@functools.cache
def best(kind: str, name: str) -> Examined:
    return solutions_of(load_task(kind, name)).examined[0]


@functools.cache
def central() -> Examined:
    task = StrokeTask(name="x", source="a test", stroke_m=0.1, rod_m=0.3)
    return solutions_of(task).examined[0]


def test_slopes_and_the_largest_clearance_of_a_central_slider_crank_are_known() -> None:
    """At the ends of its stroke s = l +- r: a length goes in whole, the pivot's height not at
    all."""
    found = sensitivity(central())
    slope = {one.words: abs(found.slopes[:, k]) for k, one in enumerate(found.dimensions)}
    for words in ("crank A x", "rod B x", "ground O2 x"):
        assert slope[words] == pytest.approx([1.0, 1.0], abs=1e-8)
    assert slope["ground O2 y"] == pytest.approx([0.0, 0.0], abs=1e-6)
    # The crank's pin moved across it: the rod is in line with the crank, the slider stays.
    assert slope["crank A y"] == pytest.approx([0.0, 0.0], abs=1e-6)
    assert found.worst(1e-4) == pytest.approx([3e-4, 3e-4], rel=1e-6)
    assert found.usual(1e-4) == pytest.approx([math.sqrt(3.0) * 1e-4] * 2, rel=1e-6)
    clearance, row = found.largest_clearance([3e-4, 6e-4])
    assert clearance == pytest.approx(1e-4, rel=1e-6)  # three pins in line
    assert row == 0
    measured = [one.words for one in found.dimensions if is_measured(central(), one)]
    assert measured == ["ground O2 x", "ground O2 y", "crank A x", "rod B x"]  # one of each bar


TASKS = [("coupler", "three-positions"), ("quick-return", "whitworth"), ("coupler", "driving-dyad")]
MORE = "of more dimensions and mechanisms"


@pytest.mark.parametrize(
    ("kind", "name", "count"),
    [*((*task, 40) for task in TASKS[:2]), *(slowly(*task, 200, reason=MORE) for task in TASKS)],
)
def test_a_monte_carlo_stays_within_the_worst_case_and_comes_near(
    kind: str, name: str, count: int
) -> None:
    one = best(kind, name)
    found, small = sensitivity(one), 1e-6
    worst = found.worst(small)
    spread = monte_carlo(one, small, (0.3 * worst).tolist(), count)
    moves = worst > 1e-9
    assert np.all(spread.largest <= worst * 1.001 + 1e-12)
    assert np.all(spread.largest[moves] > 0.25 * worst[moves])
    assert 0.0 < spread.share_within < 1.0
    assert spread.lost == 0


@pytest.mark.parametrize("count", [10, slowly(50, reason="more of them, drawn at random")])
def test_the_same_seed_gives_the_same(count: int) -> None:
    one = central()
    first, second = (monte_carlo(one, 1e-4, [1e-4, 1e-4], count) for _ in range(2))
    assert first.largest.tolist() == second.largest.tolist()
    other = monte_carlo(one, 1e-4, [1e-4, 1e-4], count, seed=1)
    assert other.largest.tolist() != first.largest.tolist()


@pytest.mark.parametrize("count", [40, slowly(100, reason="more of them, drawn at random")])
def test_mechanisms_that_can_not_be_assembled_are_counted(count: int) -> None:
    one = best("coupler", "three-positions")
    assert monte_carlo(one, 0.1, [1.0] * 9, count).lost > 5
