"""A line in words."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import pytest

from reports.output.numbers import short
from reports.results.fits.line import fit_line
from reports.results.fits.words import words

PERIOD = 0.36
PER_TURN = np.array([45, 90, 180, 360, 720, 1440])
STEPS = PERIOD / PER_TURN


def said(errors: Sequence[float], statuses: Sequence[str] | None = None) -> str:
    number = len(errors)
    return words(fit_line(STEPS[:number], errors, statuses=statuses), "rad", PERIOD)


def test_an_order_and_a_floor_read_as_the_users_of_the_tool_know_them() -> None:
    assert said(STEPS**2) == "order 2.0, no floor seen"
    assert said(7.5e-4 + 10.0 * STEPS**2) == "converges to the wrong answer: floor 7.5e-4 rad"


def test_steps_that_are_too_coarse_are_named_by_steps_per_turn() -> None:
    bad = ["diverged", "ok", "ok", "ok", "ok", "ok"]
    assert said(STEPS**2, bad) == (
        "order 2.0, no floor seen; diverges below 90 steps per turn"
    )  # fmt: skip
    bad[1] = "locked"
    assert said(STEPS**2, bad).endswith("; locks below 180 steps per turn")


def test_a_line_that_never_ends_well_says_how() -> None:
    nothing = [math.nan] * 6
    assert said(nothing, ["diverged"] * 6) == "diverges at every step"
    assert said(nothing, ["crashed"] * 6) == "crashes at every step"
    assert said(nothing, ["unsupported"] * 6) == "unsupported"
    assert said(nothing, ["timeout"] * 6) == "timed out at every step"
    assert (
        said(STEPS**2, ["ok"] * 5 + ["branch-changed"]) == "changes branch at 1440 steps per turn"
    )


@pytest.mark.parametrize(
    ("errors", "text"),
    [
        ([0.0] * 6, "at rounding"),
        ([1e-3, 1e-4], "2 steps: too few to tell"),
        ([1e-3], "1 step: too few to tell"),
        (1e-9 / STEPS, "does not shrink: grows to 4.0e-6 rad"),
        (
            [1e-3, 1e-5, 1e-3, 1e-5, 1e-3, 2e-5],
            "irregular: falls to 1.0e-5 rad, then rises to 2.0e-5",
        ),
        (
            [1e-2, 1e-5, 1e-3, 1e-5, 1e-3, 1e-6],
            "irregular: follows no order, 1.0e-6 rad at the finest step",
        ),
    ],
)
def test_other_lines_say_what_they_do(errors: Sequence[float], text: str) -> None:
    assert said(errors) == text


def test_a_vague_order_is_told_with_its_uncertainty() -> None:
    assert said([8e-3, 1e-3, 2.2e-4]) == "order 2.6 +- 0.4, no floor seen"


def test_what_falls_slower_than_any_integrator_is_no_plain_order() -> None:
    assert said([4e-3, 3e-3, 2.4e-3]) == (
        "order 0.4: slower than any integrator, a floor may be near"
    )  # fmt: skip


@pytest.mark.parametrize(
    ("number", "text"), [(7.5e-4, "7.5e-4"), (12.0, "1.2e1"), (1e-12, "1.0e-12"), (math.inf, "inf")]
)
def test_short_numbers_have_no_padded_power(number: float, text: str) -> None:
    assert short(number) == text
