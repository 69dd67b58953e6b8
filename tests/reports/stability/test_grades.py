"""How a hard run ends is decided by rules: each one sees its own kind of end, and nothing else."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from reports.compare.errors import Departure
from reports.stability.error_series import ErrorSeries
from reports.stability.grades import MEANINGS, drift, outcome
from reports.stability.matrix import OUTCOMES

WITHIN = 1e-2
TURNS, SAMPLES = 8, 60
TURN = np.arange(TURNS * SAMPLES + 1) / SAMPLES
"""Periods gone by at each sample."""


def run(**changed: object) -> ErrorSeries:
    """A run without a fault, with some of it changed."""
    small = 1e-3 * (1.0 + np.sin(math.tau * TURN)) / 2.0
    driver = math.tau * TURN
    healthy = ErrorSeries(
        status="ok",
        reason="",
        time_s=0.5 * TURN,
        driver_rad=driver,
        place=small,
        gap=0.5 * small,
        drive=0.0 * TURN,
        crank=driver,
        period_s=0.5,
        settled=0,
        departure=None,
        sine=0.5,
    )
    return replace(healthy, **changed)  # type: ignore[arg-type]


def stands() -> ErrorSeries:
    """The crank stands after three turns, its joints closed."""
    crank = np.minimum(math.tau * TURN, 3.0 * math.tau)
    return run(crank=crank, drive=math.tau * TURN - crank)


def test_a_run_within_its_class_is_ok_and_tells_its_drift() -> None:
    found = outcome(run(), WITHIN)
    assert found.outcome == "ok"
    assert "drift" in found.reason


@pytest.mark.parametrize(
    ("errors", "name", "word", "sample"),
    [
        (run(status="diverged", reason="came apart at 1 s"), "diverged", "came apart", 480),
        (run(status="crashed", reason="ValueError: no"), "crashed", "ValueError", 480),
        (run(place=np.where(TURN == 2.0, np.inf, 0.0)), "diverged", "not finite", 120),
        (run(departure=Departure("rocker", 1.0, 0.0)), "branch-changed", "rocker", 120),
        (stands(), "locked", "stands", 181),
        (run(gap=np.where(TURN > 2.0, 0.02, 0.0)), "silently-open", "open by 0.02", 121),
        (run(place=5e-3 * TURN), "drifts", "0.005 a turn", 121),
        (run(place=0.02 + 0.0 * TURN), "degraded", "off by 0.02", 0),
        (run(drive=0.02 + 0.0 * TURN), "degraded", "the crank", 0),
        (run(drive=0.02 + 0 * TURN, gap=0.03 + 0 * TURN), "degraded", "the crank", 0),
    ],
)
def test_every_end_is_told_by_its_own_rule(
    errors: ErrorSeries, name: str, word: str, sample: int
) -> None:
    found = outcome(errors, WITHIN)
    assert found.outcome == name
    assert word in found.reason
    assert found.sample == sample


def test_an_end_that_explains_others_is_told_before_them() -> None:
    open_ = run(gap=0.02 + 0 * TURN, place=0.03 * TURN, departure=Departure("rocker", 1.0, 0.0))
    assert outcome(open_, WITHIN).outcome == "branch-changed"
    assert outcome(replace(open_, status="diverged"), WITHIN).outcome == "diverged"


def test_an_error_that_swings_does_not_drift() -> None:
    swinging = run(place=0.03 * np.abs(np.sin(math.pi * TURN / 4.0)))
    assert outcome(swinging, WITHIN).outcome == "degraded"


def test_growth_within_the_class_is_told_as_a_number_and_held() -> None:
    slow = run(place=1e-4 * TURN)
    slope, doubt = drift(slow)
    assert slope == pytest.approx(1e-4, rel=1e-9)
    assert doubt < 1e-12
    assert outcome(slow, WITHIN).outcome == "ok"
    assert "1.0e-04" in outcome(slow, WITHIN).reason


def test_a_run_of_few_turns_has_no_drift() -> None:
    part = slice(0, 3 * SAMPLES)
    short = run(**{n: v[part] for n, v in vars(run()).items() if isinstance(v, np.ndarray)})
    assert all(math.isnan(number) for number in drift(short))


def test_what_comes_before_the_run_has_settled_does_not_count() -> None:
    early = run(place=np.where(TURN < 1.0, 0.5, 1e-3))
    assert outcome(early, WITHIN).outcome == "degraded"
    assert outcome(replace(early, settled=SAMPLES), WITHIN).outcome == "ok"


def test_every_outcome_has_a_meaning() -> None:
    assert set(MEANINGS) == set(OUTCOMES)
