"""The search for the coarsest step, on errors whose law is known."""

from __future__ import annotations

import math
from collections.abc import Callable

import pytest

from reports.tune.coarsest import FINER, RESOLUTION, Found, coarsest

LEAST, MOST = 40, 50_000


def look(error: Callable[[int], float], target: float, start: int = 160, most: int = MOST) -> Found:
    """The search, which has to call for each step once only."""
    called: list[int] = []

    def counted(steps: int) -> float:
        called.append(steps)
        return error(steps)

    found = coarsest(counted, target, start, LEAST, most)
    assert len(called) == len(set(called)) == len(found.errors)
    assert min(called) >= LEAST
    assert max(called) <= math.ceil(FINER[-1] * most)
    return found


@pytest.mark.parametrize("order", [1.0, 2.0, 4.0])
@pytest.mark.parametrize("start", [40, 160, 20_000])
@pytest.mark.parametrize("exact", [97, 1000, 9000])
def test_finds_the_coarsest_step_of_a_power_law_in_few_runs(
    order: float, start: int, exact: int
) -> None:
    found = look(lambda n: (exact / n) ** order, 1.0, start)
    assert found.steps is not None
    assert exact <= found.steps <= max(exact + 1, RESOLUTION * exact)
    assert len(found.errors) <= (8 if start < 20_000 else 13)


def test_takes_the_fewest_steps_allowed_where_all_reach_the_target() -> None:
    assert look(lambda n: 1e-9, 1.0).steps == LEAST


def test_gives_up_at_a_floor_long_before_the_finest_step() -> None:
    found = look(lambda n: 1e-3 + 1.0 / n**2, 1e-6)
    assert found.steps is None
    assert max(found.errors) < MOST
    assert min(found.errors.values()) == pytest.approx(1e-3, rel=1e-3)


def test_gives_up_where_the_finest_step_allowed_is_too_coarse() -> None:
    found = look(lambda n: (9000 / n) ** 2, 1.0, most=5000)
    assert found.steps is None
    assert found.errors[5000] == min(found.errors.values()) == pytest.approx(3.24)


def test_does_not_take_a_step_at_which_errors_happen_to_cancel() -> None:
    def dip(n: int) -> float:
        return (2000 / n) ** 2 * (1e-3 if 150 <= n <= 170 else 1.0)

    found = look(dip, 1.0, start=160)
    assert found.steps is not None
    assert 2000 <= found.steps <= 2000 * RESOLUTION


def test_does_not_take_settings_that_break_at_finer_steps() -> None:
    def breaks(n: int) -> float:
        return math.nan if n > 300 else (200 / n) ** 2

    assert look(breaks, 1.0).steps is None


def test_counts_runs_that_came_apart_as_infinitely_wrong() -> None:
    found = look(lambda n: math.nan if n < 700 else (500 / n) ** 2, 1.0)
    assert found.steps is not None
    assert 700 <= found.steps <= 701 * RESOLUTION
