"""What is said of an error when the step is halved twice."""

from __future__ import annotations

import math

import pytest

from reports.judge.three_steps import Convergence, convergence


def seen(*error: float) -> Convergence:
    return convergence((1e-3, 5e-4, 2.5e-4), error, "rad")


@pytest.mark.parametrize("order", [1.0, 1.5, 2.0, 4.0])
def test_an_error_that_falls_with_a_power_of_dt_shrinks_with_that_order(order: float) -> None:
    found = seen(*(1e-3 / 2 ** (order * k) for k in range(3)))
    assert (found.trend, found.words) == ("shrinks", f"order {order:.1f}")
    assert found.order == pytest.approx(order)
    assert math.isnan(found.floor)


def test_a_floor_under_a_second_order_error_is_found() -> None:
    found = seen(*(7.5e-4 + 1e-4 / 4**k for k in range(3)))
    assert found.trend == "does not shrink"
    assert found.floor == pytest.approx(7.5e-4)
    assert "does not shrink" in found.words
    assert "7.5e-04" in found.words


def test_an_error_that_falls_towards_a_floor_levels_off() -> None:
    found = seen(*(1e-4 + 1e-3 / 4**k for k in range(3)))
    assert found.trend == "levels off"
    assert found.floor == pytest.approx(1e-4)


def test_a_small_floor_far_below_the_error_is_not_claimed() -> None:
    assert seen(*(1e-8 + 1e-3 / 4**k for k in range(3))).trend == "shrinks"


def test_an_error_that_stays_the_same_does_not_shrink() -> None:
    found = seen(7e-4, 7e-4, 7e-4)
    assert (found.trend, found.floor) == ("does not shrink", 7e-4)


def test_an_error_that_grows_is_said_to_grow() -> None:
    found = seen(1e-6, 2e-6, 4e-6)
    assert (found.trend, found.words) == ("grows", "does not shrink: it grows")


def test_a_floor_that_wanders_a_little_upwards_is_still_a_floor() -> None:
    found = seen(7.5e-4, 8.3e-4, 8.7e-4)
    assert (found.trend, found.floor) == ("does not shrink", 8.7e-4)


def test_errors_of_rounding_are_not_read_as_orders() -> None:
    assert seen(3e-10, 4e-13, 6e-13).trend == "at rounding"
    assert seen(0.0, 0.0, 0.0).trend == "at rounding"


@pytest.mark.parametrize(
    ("errors", "trend"),
    [
        ((8e-5, 4e-5, 3e-5), "as the truth"),  # all of it may be the truth's
        ((8e-5, 3e-5, 4e-5), "as the truth"),
        ((3e-4, 1.0e-4, 5e-5), "shrinks"),  # down to a floor that may be
        ((3e-4, 2.5e-4, 2.4e-4), "does not shrink"),
    ],
)
def test_a_floor_that_the_truth_may_be_off_by_is_not_the_engines(
    errors: tuple[float, float, float], trend: str
) -> None:
    dt_s = (1e-3, 5e-4, 2.5e-4)
    assert convergence(dt_s, errors, "rad", known=4e-5).trend == trend
    assert convergence(dt_s, errors, "rad").trend in ("levels off", "shrinks", "does not shrink")


def test_an_error_that_grows_is_told_however_far_the_truth_may_be_off() -> None:
    errors = (1e-5, 2e-5, 3e-5)
    assert convergence((1e-3, 5e-4, 2.5e-4), errors, "rad", known=4e-5).trend == "grows"


@pytest.mark.parametrize("bad", [math.nan, math.inf])
def test_an_error_that_is_no_number_diverges(bad: float) -> None:
    assert seen(1e-3, 1e-4, bad).trend == "diverges"
    assert convergence((4.0, 2.0, 1.0), (1e-3, 1e-4, bad), "rad", known=1.0).trend == "diverges"


def test_two_steps_are_not_enough_for_a_floor() -> None:
    with pytest.raises(ValueError, match="a floor needs three"):
        convergence((1e-3, 5e-4), (1e-3, 1e-3), "rad")


@pytest.mark.parametrize(("solved", "trend"), [(4e-9, "as solved"), (2e-9, "grows")])
def test_an_error_that_grows_is_the_solvers_only_as_far_as_that_goes(
    solved: float, trend: str
) -> None:
    errors = (1e-9, 2e-10, 3e-9)
    assert convergence((1e-3, 5e-4, 2.5e-4), errors, "rad", solved=solved).trend == trend
