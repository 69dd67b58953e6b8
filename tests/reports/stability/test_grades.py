"""How a hard run ends is decided by rules, each of which sees its own kind of end; and the value up
to which a case is held: the first that is not, from the easy end, closed in on."""

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from models.files.reading import load_scene
from reports.compare.errors import Departure
from reports.stability.case import Case, Trial
from reports.stability.error_series import ErrorSeries
from reports.stability.grades import MEANINGS, drift, outcome
from reports.stability.matrix import OUTCOMES, Critical, Graded, Outcome, label
from reports.stability.running import critical, line

WITHIN = 1e-2
TURNS, SAMPLES = 8, 60
TURN = np.arange(TURNS * SAMPLES + 1) / SAMPLES
"""Periods gone by at each sample."""
NOUGHT = 0.0 * TURN


def run(**changed: object) -> ErrorSeries:
    small = 1e-3 * (1.0 + np.sin(math.tau * TURN)) / 2.0
    driver = math.tau * TURN
    series = {"place": small, "gap": 0.5 * small, "drive": NOUGHT, "crank": driver}
    healthy = {"status": "ok", "reason": "", "time_s": 0.5 * TURN, "driver_rad": driver, **series}
    more = {"period_s": 0.5, "settled": 0, "departure": None, "sine": 0.5}
    return ErrorSeries(**{**healthy, **more, **changed})  # type: ignore[arg-type]


STANDS = np.minimum(math.tau * TURN, 3.0 * math.tau)
"""The crank stands after three turns, its joints closed."""
OTHER = Departure("rocker", 1.0, 0.0)


@pytest.mark.parametrize(
    ("errors", "name", "word", "sample"),
    [
        (run(status="diverged", reason="came apart at 1 s"), "diverged", "came apart", 480),
        (run(status="crashed", reason="ValueError: no"), "crashed", "ValueError", 480),
        (run(place=np.where(TURN == 2.0, np.inf, 0.0)), "diverged", "not finite", 120),
        (run(departure=OTHER), "branch-changed", "rocker", 120),
        (run(crank=STANDS, drive=math.tau * TURN - STANDS), "locked", "stands", 181),
        (run(gap=np.where(TURN > 2.0, 0.02, 0.0)), "silently-open", "open by 0.02", 121),
        (run(place=5e-3 * TURN), "drifts", "0.005 a turn", 121),
        (run(place=0.02 + NOUGHT), "degraded", "off by 0.02", 0),
        (run(drive=0.02 + NOUGHT), "degraded", "the crank", 0),
        (run(drive=0.02 + NOUGHT, gap=0.03 + NOUGHT), "degraded", "the crank", 0),
    ],
)
def test_every_end_has_its_own_rule(errors: ErrorSeries, name: str, word: str, sample: int) -> None:
    found = outcome(errors, WITHIN)
    assert found.outcome == name
    assert word in found.reason
    assert found.sample == sample


def test_an_end_that_explains_others_is_told_before_them_and_what_swings_does_not_drift() -> None:
    assert set(MEANINGS) == set(OUTCOMES)
    open_ = run(gap=0.02 + NOUGHT, place=0.03 * TURN, departure=OTHER)
    assert outcome(open_, WITHIN).outcome == "branch-changed"
    assert outcome(replace(open_, status="diverged"), WITHIN).outcome == "diverged"
    swinging = run(place=0.03 * np.abs(np.sin(math.pi * TURN / 4.0)))
    assert outcome(swinging, WITHIN).outcome == "degraded"


def test_growth_within_the_class_is_held_and_none_told_of_few_turns_or_before_it_settles() -> None:
    healthy, slow = run(), run(place=1e-4 * TURN)
    slope, doubt = drift(slow)
    assert slope == pytest.approx(1e-4, rel=1e-9)
    assert doubt < 1e-12
    for errors, word in ((healthy, "drift"), (slow, "1.0e-04")):
        found = outcome(errors, WITHIN)
        assert found.outcome == "ok"
        assert word in found.reason
    part = slice(0, 3 * SAMPLES)
    short = run(**{n: v[part] for n, v in vars(run()).items() if isinstance(v, np.ndarray)})
    assert all(math.isnan(number) for number in drift(short))
    early = run(place=np.where(TURN < 1.0, 0.5, 1e-3))
    assert outcome(early, WITHIN).outcome == "degraded"
    assert outcome(replace(early, settled=SAMPLES), WITHIN).outcome == "ok"


def case(*values: float, scale: str = "log", good: tuple[Outcome, ...] = ("ok",)) -> Case:
    words = dict.fromkeys(("group", "title", "source", "truth", "expected"), "words")
    words |= {"name": "made-up", "parameter": "margin", "unit": "m", "scale": scale}
    trial = Trial(load_scene("fourbar-lecture-1"))
    return Case(values=values, trial=lambda _: trial, good=good, **words)  # type: ignore[arg-type]


def held(given: Case, good: Callable[[float], bool]) -> tuple[Critical, list[Graded]]:
    """The runs of an engine that holds some values, and is off its branch at the others."""

    def grade(value: float, grid: bool) -> Graded:
        ending: Outcome = "ok" if good(value) else "branch-changed"
        names = (given.name, "mujoco", "tuned", value, label(value))
        return Graded(*names, ending, "", error=1e-3, grid=grid)

    runs = list(line(given, grade))
    return critical(given, runs), runs


@pytest.mark.parametrize(
    ("values", "scale", "at"),
    [
        ((1e-2, 1e-3, 1e-4, 1e-5), "log", 3.3e-4),
        ((1.0, 1e3, 1e6), "log", 3.3e4),
        ((0.0, 30.0, 90.0, 180.0), "linear", 71.0),
    ],
)
def test_bisection_finds_where_it_breaks(values: tuple[float, ...], scale: str, at: float) -> None:
    falling = values[-1] < values[0]
    found, runs = held(case(*values, scale=scale), lambda v: v >= at if falling else v <= at)
    low, high = sorted((found.holds, found.fails))
    assert low <= at <= high
    assert high - low <= (0.06 * max(values) if scale == "linear" else 0.1 * at)
    assert found.outcome == "branch-changed"
    assert ("down to" if falling else "up to") in found.words
    assert [run.value for run in runs if run.grid] == list(values)


def test_whole_numbers_are_told_apart_and_the_command_repeats_the_value_as_it_is_told() -> None:
    written = [label(value) for value in (99_999.0, 100_000.0, 112_000.0, 0.25)]
    assert written == ["99999", "1e5", "1.12e5", "0.25"]
    found, runs = held(case(100.0, 10.0, 1.0, scale="whole"), lambda v: v >= 7)
    assert (found.holds, found.fails) == (7.0, 6.0)
    assert all(run.value == round(run.value) for run in runs)
    found, runs = held(case(1e-2, 1e-4), lambda v: v >= 7.77e-4)
    assert float(found.command.rpartition(" ")[2]) == found.fails
    assert all(float(run.label) == run.value for run in runs)
    assert found.command.startswith("crankcheck stability made-up --engine mujoco --profile tuned")


@pytest.mark.parametrize(
    ("good", "holds", "fails", "words"),
    [
        (lambda _: True, 0.1, math.nan, "holds all, error up to 1e-03"),
        (lambda _: False, math.nan, 1.0, "branch-changed at once"),
        (lambda v: v != 1.0, math.nan, 1.0, "branch-changed at 1, holds 2 of 3"),
    ],
    ids=["everywhere", "nowhere", "but for the easiest"],
)
def test_a_line_that_holds_everywhere_or_not_at_once_is_not_bisected(
    good: Callable[[float], bool], holds: float, fails: float, words: str
) -> None:
    found, runs = held(case(1.0, 0.3, 0.1), good)
    assert len(runs) == 3
    assert (found.holds, found.fails) == pytest.approx((holds, fails), rel=0, abs=0, nan_ok=True)
    assert found.words == words


def test_values_before_the_first_that_does_not_end_as_the_case_names_count_as_held() -> None:
    found, _ = held(case(8.0, 4.0, 2.0, 1.0), lambda v: v not in (4.0, 5.66))
    assert found.holds > found.fails >= 4.0
    found, runs = held(case(1.0, 1e-3, 0.0), lambda v: v > 0.0)
    assert len(runs) == 3
    assert (found.holds, found.fails) == (1e-3, 0.0)
    found, _ = held(case(1.0, 0.1, good=("branch-changed",)), lambda v: v < 0.5)
    assert found.holds == pytest.approx(0.5, rel=0.05)
    assert found.fails < 0.5 <= found.holds
    assert found.outcome == "ok"
