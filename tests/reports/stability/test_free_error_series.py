"""A machine that is let go: what of its errors counts, and in which way."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from models.errors import CrankcheckError
from models.files import load_scene
from reports.cli.commands.stability import _cases
from reports.stability.case import Trial
from reports.stability.catalogue import CATALOGUE
from reports.stability.catalogue.free_motion import from_rest
from reports.stability.error_series import ErrorSeries
from reports.stability.free_error_series import free_error_series, free_start
from reports.stability.grades import outcome
from reports.stability.grading import graded
from sim.engine import Energy, Run
from sim.run import run


@pytest.fixture(scope="module")
def trial() -> Trial:
    """Long enough for means over windows."""
    return from_rest(load_scene("fourbar-swing"), 0.0, 0.5)


@pytest.fixture(scope="module")
def good(trial: Trial) -> Run:
    """A run that holds."""
    start = free_start(trial)
    return run(
        trial.scene, start, "mujoco", "tuned", dt_s=trial.dt_s, steps=trial.steps, drive="free"
    )


def worst(errors: ErrorSeries) -> float:
    return errors.worst(errors.place)[0]


def test_a_run_that_holds_is_ok(trial: Trial, good: Run) -> None:
    errors = free_error_series(trial, good)
    assert worst(errors) < 1e-5
    assert outcome(errors, 1e-2).outcome == "ok"


def test_energy_that_is_lost_is_an_error_of_its_size_and_named(trial: Trial, good: Run) -> None:
    kinetic = good.energy.kinetic_j
    lost = np.linspace(0.0, 0.1, kinetic.size) * np.max(kinetic)
    leaking = replace(good, energy=Energy(kinetic - lost, good.energy.potential_j))
    errors = free_error_series(trial, leaking)
    assert worst(errors) == pytest.approx(0.05, rel=0.05)  # between two halves
    reason = outcome(errors, 1e-2).reason
    assert reason == "the energy, over the largest kinetic one, is off by 0.05"


def test_a_phase_that_runs_away_is_an_error_as_long_as_it_is_followed(trial: Trial) -> None:
    """With a tenth less of gravity it is late, closed, and loses nothing."""
    light = replace(trial.scene, gravity_m_s2=(0.0, -0.9 * 9.81))
    start = free_start(trial)
    slow = run(light, start, "mujoco", "tuned", dt_s=trial.dt_s, steps=trial.steps, drive="free")
    followed = free_error_series(trial, slow)
    assert worst(followed) > 1e-2
    assert outcome(followed, 1e-2).outcome == "degraded"
    alone = free_error_series(replace(trial, followed_s=0.02), slow)
    assert worst(alone) < 2e-3


def test_places_at_the_runs_own_angle_count_after_the_phase(trial: Trial, good: Run) -> None:
    rocker = good.motion.links["rocker"]
    off = rocker.theta + np.where(good.motion.time_s > 0.3, 0.04, 0.0)
    links = {**good.motion.links, "rocker": replace(rocker, theta=off)}
    bent = replace(good, motion=replace(good.motion, links=links))
    errors = free_error_series(replace(trial, followed_s=0.1), bent)
    assert worst(errors) == pytest.approx(0.04, rel=1e-3)
    assert errors.time_s[errors.first(errors.place, 1e-2)] == pytest.approx(0.301, abs=2e-3)


def test_numbers_that_are_not_finite_have_diverged(trial: Trial, good: Run) -> None:
    crank = good.motion.links["crank"]
    theta = np.where(good.motion.time_s > 0.4, np.nan, crank.theta)
    links = {**good.motion.links, "crank": replace(crank, theta=theta)}
    errors = free_error_series(trial, replace(good, motion=replace(good.motion, links=links)))
    assert outcome(errors, 1e-2).outcome == "diverged"


def test_a_step_that_is_too_large_is_seen_and_nothing_said_of_a_crank_that_nobody_drives() -> None:
    """Of an open joint not what the crank shows, and of the crank no error of 0."""
    case = CATALOGUE["free-coarse-step"]
    coarse, _ = graded(case, "mujoco", "tuned", 5e-2, draw=False)
    fine, _ = graded(case, "mujoco", "tuned", 1e-2, draw=False)
    assert (fine.outcome, coarse.outcome) == ("ok", "silently-open")
    assert coarse.reason.startswith("a joint is open by")
    assert "crank" not in coarse.reason
    assert np.isnan(coarse.drive)


def test_cases_of_free_motion_are_run_when_asked_for() -> None:
    free = {case.name for case in _cases([], free=True, elastic=False)}
    driven = {case.name for case in _cases([], free=False, elastic=False)}
    elastic = {case.name for case in _cases([], free=False, elastic=True)}
    assert free == {name for name, case in CATALOGUE.items() if case.judge in ("let-go", "toggle")}
    assert elastic == {case.name for case in CATALOGUE.values() if case.elastic}
    assert len(free) + len(driven) + len(elastic) == len(CATALOGUE)
    assert free | driven | elastic == set(CATALOGUE)
    named = _cases(["free-long"], free=False, elastic=False)
    assert [case.name for case in named] == ["free-long"]
    with pytest.raises(CrankcheckError, match="--free and kite: no case of free motion; those are"):
        _cases(["free-long", "kite"], free=True, elastic=False)


def test_growth_is_told_over_the_time_and_not_over_turns(trial: Trial, good: Run) -> None:
    errors = free_error_series(trial, good)
    assert errors.per_turn == "in 0.5 s"
    assert replace(errors, drive=np.zeros_like(errors.place)).per_turn == "a turn"
