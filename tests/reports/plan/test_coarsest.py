"""The search for the coarsest step, on errors whose law is known."""

from __future__ import annotations

import math
from collections.abc import Callable

import pytest

from reports.plan.coarsest import FINER, RESOLUTION, coarsest

LEAST, MOST = 40, 50_000


def look(
    error: Callable[[int], float], target: float, start: int = 160, most: int = MOST
) -> tuple[int | None, dict[int, float]]:
    """The search, which has to call for each step once only, and all its errors."""
    errors: dict[int, float] = {}

    def kept(steps: int) -> float:
        assert steps not in errors
        errors[steps] = error(steps)
        return errors[steps]

    steps = coarsest(kept, target, start, LEAST, most)
    assert min(errors) >= LEAST
    assert max(errors) <= math.ceil(FINER[-1] * most)
    return steps, errors


@pytest.mark.parametrize("order", [1.0, 2.0, 4.0])
@pytest.mark.parametrize("start", [40, 160, 20_000])
@pytest.mark.parametrize("exact", [97, 1000, 9000])
def test_finds_the_step_of_a_power_law_in_few_runs(order: float, start: int, exact: int) -> None:
    steps, errors = look(lambda n: (exact / n) ** order, 1.0, start)
    assert exact <= steps <= max(exact + 1, RESOLUTION * exact)
    assert len(errors) <= (8 if start < 20_000 else 13)


def test_takes_the_fewest_steps_allowed_where_all_reach_the_target() -> None:
    assert look(lambda n: 1e-9, 1.0)[0] == LEAST


def test_gives_up_at_a_floor_long_before_the_finest_step_and_where_that_is_too_coarse() -> None:
    steps, errors = look(lambda n: 1e-3 + 1.0 / n**2, 1e-6)
    assert steps is None
    assert max(errors) < MOST
    assert min(errors.values()) == pytest.approx(1e-3, rel=1e-3)
    steps, errors = look(lambda n: (9000 / n) ** 2, 1.0, most=5000)
    assert steps is None
    assert errors[5000] == min(errors.values()) == pytest.approx(3.24)


def test_does_not_take_a_step_at_which_errors_happen_to_cancel() -> None:
    steps, _ = look(lambda n: (2000 / n) ** 2 * (1e-3 if 150 <= n <= 170 else 1.0), 1.0)
    assert 2000 <= steps <= 2000 * RESOLUTION


def test_counts_runs_that_came_apart_as_infinitely_wrong() -> None:
    """Also where they do at finer steps."""
    assert look(lambda n: math.nan if n > 300 else (200 / n) ** 2, 1.0)[0] is None
    steps, _ = look(lambda n: math.nan if n < 700 else (500 / n) ** 2, 1.0)
    assert 700 <= steps <= 701 * RESOLUTION
