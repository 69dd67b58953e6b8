"""Throws at a toggle: over, back, or neither, and how each is graded."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from benchmarks.toggle import LINES, RandomThrow, Thrown, right_from, threw, throws, told
from reports.compare.free.toggle_passage import toggle_passage
from reports.stability.catalogue import CATALOGUE
from reports.stability.grades import outcome
from reports.stability.grading import graded
from reports.stability.toggle import at_toggle, thrown_start
from sim.engine import Run
from sim.run import run

OVER, SHORT = (CATALOGUE[f"toggle-{name}"].trial(1e-2) for name in ("over", "short"))


@pytest.fixture(scope="module")
def runs() -> dict[str, Run]:
    """A run that gets over, and one that falls back."""
    return {
        name: run(
            trial.scene,
            thrown_start(trial),
            "mujoco",
            "tuned",
            dt_s=trial.dt_s,
            steps=trial.steps,
            drive="free",
        )
        for name, trial in (("over", OVER), ("short", SHORT))
    }


def test_a_run_does_what_its_energy_says(runs: dict[str, Run]) -> None:
    for name, trial in (("over", OVER), ("short", SHORT)):
        assert outcome(at_toggle(trial, runs[name]), 1e-2).outcome == "ok"


def test_getting_over_without_the_energy_is_a_change_of_branch(runs: dict[str, Run]) -> None:
    grade = outcome(at_toggle(SHORT, runs["over"]), 1e-2)
    assert grade.outcome == "branch-changed"
    assert grade.reason == "rocker went over to the other assembly"


def test_falling_back_with_the_energy_is_degraded_by_what_it_was_short_of(
    runs: dict[str, Run],
) -> None:
    errors = at_toggle(OVER, runs["short"])
    nearest = toggle_passage(OVER.throw.barrier, runs["short"]).nearest_rad
    assert outcome(errors, 1e-2).outcome == "degraded"
    assert 0.0 < nearest < 0.2 * abs(OVER.throw.barrier.open_rad)
    short = nearest + 0.5 * abs(OVER.throw.barrier.open_rad)
    assert errors.worst(errors.place)[0] == pytest.approx(short, rel=1e-12)


def test_a_run_that_ends_too_soon_is_undecided_and_one_that_comes_open_broken(
    runs: dict[str, Run],
) -> None:
    done, barrier = runs["over"], OVER.throw.barrier
    early = replace(
        done,
        motion=replace(
            done.motion.each_series(lambda series: series[:100]), time_s=done.motion.time_s[:100]
        ),
        gaps={name: gap[:100] for name, gap in done.gaps.items()},
    )
    assert toggle_passage(barrier, early).outcome == "undecided"
    assert outcome(at_toggle(OVER, early), 1e-2).outcome != "ok"
    assert toggle_passage(barrier, replace(early, status="diverged")).outcome == "broken"
    apart = replace(done, gaps={name: gap + 0.1 for name, gap in done.gaps.items()})
    assert toggle_passage(barrier, apart).outcome == "broken"


@pytest.mark.parametrize("name", ["toggle-over", "toggle-short"])
def test_every_engine_holds_a_margin_of_a_tenth(name: str) -> None:
    for engine, profile in LINES:
        assert graded(CATALOGUE[name], engine, profile, 0.1, draw=False)[0].outcome == "ok"


def test_throws_of_the_benchmark_are_told_from_their_truth() -> None:
    """A small version of `benchmarks/toggle.py`: a throw of which both truths agree."""
    few = list(throws(1))
    assert few == list(throws(2))[:1]
    for throw in few:
        result = threw(throw)
        assert result.gets_over == (result.truth == "over")
        tuned = [result.outcomes[k] for k, (_, profile) in enumerate(LINES) if profile == "tuned"]
        assert tuned[0] == result.truth
        assert set(result.outcomes) <= {"over", "back"}


def test_the_margin_from_which_all_are_right_ends_at_the_largest_that_is_not() -> None:
    lengths = (0.2, 0.25, 0.3, 0.5)
    results = [
        Thrown(RandomThrow(lengths, margin), margin > 0.0, (came,))
        for margin, came in ((0.05, "over"), (-2e-3, "back"), (1e-3, "back"), (1e-5, "over"))
    ]
    assert right_from(results, 0) == 2e-3
    assert right_from(results[2:], 0) == math.inf
    assert told(results, 0).split()[:6] == ["0/0", "1/1", "0/0", "1/2", "1/1", "3"]
    assert told(results, 0).endswith("over -> back: 1")
    assert np.isfinite(right_from(results[3:], 0))
