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
STEPS = PERIOD / np.array([45, 90, 180, 360, 720, 1440])


ENDS = {"diverged": "diverges at every step", "crashed": "crashes at every step",
        "unsupported": "unsupported", "timeout": "timed out at every step"}  # fmt: skip


@pytest.mark.parametrize(
    ("errors", "statuses", "text"),
    [
        (STEPS**2, "", "order 2.0, no floor seen"),
        (7.5e-4 + 10.0 * STEPS**2, "", "converges to the wrong answer: floor 7.5e-4 rad"),
        (STEPS**2, "diverged", "order 2.0, no floor seen; diverges below 90 steps per turn"),
        (STEPS**2, "diverged locked", "order 2.0, no floor seen; locks below 180 steps per turn"),
        (STEPS**2, "ok ok ok ok ok branch-changed", "changes branch at 1440 steps per turn"),
        *(([math.nan] * 6, " ".join([status] * 6), text) for status, text in ENDS.items()),
        ([0.0] * 6, "", "at rounding"),
        ([1e-3, 1e-4], "", "2 steps: too few to tell"),
        ([1e-3], "", "1 step: too few to tell"),
        (1e-9 / STEPS, "", "does not shrink: grows to 4.0e-6 rad"),
        ([1e-3, 1e-5, 1e-3, 1e-5, 1e-3, 2e-5], "",
         "irregular: falls to 1.0e-5 rad, then rises to 2.0e-5"),
        ([1e-2, 1e-5, 1e-3, 1e-5, 1e-3, 1e-6], "",
         "irregular: follows no order, 1.0e-6 rad at the finest step"),
        ([8e-3, 1e-3, 2.2e-4], "", "order 2.6 +- 0.4, no floor seen"),
        ([4e-3, 3e-3, 2.4e-3], "", "order 0.4: slower than any integrator, a floor may be near"),
    ],
)  # fmt: skip
def test_a_line_says_what_it_does(errors: Sequence[float], statuses: str, text: str) -> None:
    """``statuses``: those of the coarsest steps; the others are ok."""
    ended = [*statuses.split(), *["ok"] * len(errors)][: len(errors)]
    assert words(fit_line(STEPS[: len(errors)], errors, statuses=ended), "rad", PERIOD) == text


def test_a_line_over_time_speaks_of_seconds() -> None:
    fit = fit_line([4e-3, 2e-3, 1e-3], [1e9, 1e-3, 1e-4], statuses=["diverged", "ok", "ok"])
    assert "steps per second" in words(fit, "rad", 1.0, "second")


@pytest.mark.parametrize(
    ("number", "text"), [(7.5e-4, "7.5e-4"), (12.0, "1.2e1"), (1e-12, "1.0e-12"), (math.inf, "inf")]
)
def test_short_numbers_have_no_padded_power(number: float, text: str) -> None:
    assert short(number) == text
