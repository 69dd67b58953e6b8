"""What of the errors of a run counts, and in which way: of logs that look well at their end and are
not, of a machine that is in free motion, and of throws at a toggle."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from analytic.kinematics import solve
from benchmarks.toggle import LINES
from models.array import Array
from models.errors import CrankcheckError
from models.files.reading import load_scene
from reports.compare.hard_runs import toggle_passage
from reports.requests.stability import _cases
from reports.stability.case import Trial
from reports.stability.catalogue.free_motion import from_rest
from reports.stability.error_series import ErrorSeries, error_series
from reports.stability.grades import outcome
from reports.stability.grading import CATALOGUE, graded
from reports.stability.other_truths import at_limit, at_toggle, thrown_start
from reports.ways.free.series import free_error_series, free_start
from sim.engine import Energy, Run
from sim.run import run


def done(trial: Trial, start: Any = None, **other: Any) -> Run:
    """A run of MuJoCo, tuned; a healthy one, unless it is of something else."""
    asked = {"dt_s": trial.dt_s, "steps": trial.steps, "every": trial.every, "drive": trial.drive}
    scene = other.pop("scene", trial.scene)
    return run(scene, start or solve(scene, np.zeros(1)).state(), "mujoco", **{**asked, **other})


def with_link(found: Run, name: str, theta: Array) -> Run:
    links = {**found.motion.links, name: replace(found.motion.links[name], theta=theta)}
    return replace(found, motion=replace(found.motion, links=links))


def cut(found: Run, samples: int) -> Run:
    """Only the first samples are logged, and the engine says that all is well."""
    motion = found.motion.each_series(lambda series: series[:samples])
    short = replace(motion, time_s=motion.time_s[:samples])
    return replace(found, motion=short, gaps={n: gap[:samples] for n, gap in found.gaps.items()})


def test_a_crank_is_locked_only_at_its_limit_with_its_joints_closed_throughout() -> None:
    case = CATALOGUE["triple-rocker-limit"]
    trial = case.trial(10.0)
    found = done(trial)
    theta = found.motion.links["crank"].theta
    middle = np.arange(theta.size) == theta.size // 2
    stuck, overshot = np.full_like(theta, theta[0]), np.where(middle, theta + 1.0, theta)
    runs = [(found, "locked")]
    runs += [(with_link(found, "crank", other), "degraded") for other in (stuck, overshot)]
    for gap, ending in ((0.4, "degraded"), (np.inf, "diverged"), (np.nan, "diverged")):
        opened = np.where(middle, gap, found.gaps["C"])
        runs.append((replace(found, gaps={**found.gaps, "C": opened}), ending))
    endings = [outcome(at_limit(trial, each), case.within).outcome for each, _ in runs]
    assert endings == [ending for _, ending in runs]


def test_a_log_with_holes_is_not_held() -> None:
    trial = CATALOGUE["coarse-step"].trial(90.0)
    whole = done(trial)
    few = cut(whole, whole.motion.time_s.size // 5)
    for holes, word in ((few, "samples"), (replace(whole, gaps={}), "no gap of")):
        found = outcome(error_series(trial.scene, holes), 1e-2)
        assert found.outcome == "crashed"
        assert word in found.reason


def test_a_branch_left_before_the_run_has_settled_does_not_count() -> None:
    scene = CATALOGUE["open-joint"].trial(1e-3).scene
    strayed = done(Trial(scene))
    motion = strayed.motion
    other = replace(scene, branch={name: -sign for name, sign in scene.branch.items()})
    wrong = solve(other, motion.time_s, bound=False)
    at = np.arange(len(motion.time_s))
    for name, link in motion.links.items():
        early = np.where((at > 20) & (at < 100), wrong.links[name].theta, link.theta)
        strayed = with_link(strayed, name, early)
    assert outcome(error_series(scene, strayed), 1e-2).outcome == "branch-changed"
    assert outcome(error_series(scene, strayed, settled_turns=1.0), 1e-2).outcome == "ok"


@pytest.fixture(scope="module")
def trial() -> Trial:
    """One that is in free motion, long enough for means over windows."""
    return from_rest(load_scene("fourbar-swing"), 0.0, 0.5)


@pytest.fixture(scope="module")
def good(trial: Trial) -> Run:
    return done(trial, free_start(trial))


def worst(errors: ErrorSeries) -> float:
    return errors.worst(errors.place)[0]


def test_a_run_that_holds_is_ok_and_its_growth_told_over_the_time(trial: Trial, good: Run) -> None:
    errors = free_error_series(trial, good)
    assert worst(errors) < 1e-5
    assert outcome(errors, 1e-2).outcome == "ok"
    assert errors.per_turn == "in 0.5 s"
    assert replace(errors, drive=np.zeros_like(errors.place)).per_turn == "a turn"


def test_energy_lost_is_an_error_of_its_size_or_not_finite(trial: Trial, good: Run) -> None:
    kinetic = good.energy.kinetic_j
    lost = np.linspace(0.0, 0.1, kinetic.size) * np.max(kinetic)
    leaking = replace(good, energy=Energy(kinetic - lost, good.energy.potential_j))
    errors = free_error_series(trial, leaking)
    assert worst(errors) == pytest.approx(0.05, rel=0.05)  # between two halves
    reason = outcome(errors, 1e-2).reason
    assert reason == "the energy, over the largest kinetic one, is off by 0.05"
    theta = np.where(good.motion.time_s > 0.4, np.nan, good.motion.links["crank"].theta)
    assert (
        outcome(free_error_series(trial, with_link(good, "crank", theta)), 1e-2).outcome
        == "diverged"
    )


def test_a_phase_is_an_error_while_followed_and_places_after_it(trial: Trial, good: Run) -> None:
    """With a tenth less of gravity it is late, closed, and loses nothing."""
    light = replace(trial.scene, gravity_m_s2=(0.0, -0.9 * 9.81))
    slow = done(trial, free_start(trial), scene=light)
    followed = free_error_series(trial, slow)
    assert worst(followed) > 1e-2
    assert outcome(followed, 1e-2).outcome == "degraded"
    assert worst(free_error_series(replace(trial, followed_s=0.02), slow)) < 2e-3
    off = good.motion.links["rocker"].theta + np.where(good.motion.time_s > 0.3, 0.04, 0.0)
    errors = free_error_series(replace(trial, followed_s=0.1), with_link(good, "rocker", off))
    assert worst(errors) == pytest.approx(0.04, rel=1e-3)
    assert errors.time_s[errors.first(errors.place, 1e-2)] == pytest.approx(0.301, abs=2e-3)


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
    def named(*names: str, free: bool = False, elastic: bool = False) -> list[str]:
        return [case.name for case in _cases([*names], {"free": free, "elastic": elastic})]

    free, driven, elastic = named(free=True), named(), named(elastic=True)
    assert {*free} == {
        n for n, case in CATALOGUE.items() if case.judge in ("free-motion", "toggle")
    }
    assert {*elastic} == {case.name for case in CATALOGUE.values() if case.way == "elastic"}
    assert sorted(free + driven + elastic) == sorted(CATALOGUE)
    assert named("free-long") == ["free-long"]
    with pytest.raises(CrankcheckError, match="--free and kite: no case of free motion; those are"):
        named("free-long", "kite", free=True)


OVER, SHORT = (CATALOGUE[f"toggle-{name}"].trial(1e-2) for name in ("over", "short"))


@pytest.fixture(scope="module")
def runs() -> dict[str, Run]:
    thrown = {"over": OVER, "short": SHORT}
    return {name: done(one, thrown_start(one)) for name, one in thrown.items()}


def test_a_throw_is_graded_by_energy_or_undecided_if_it_ends_early(runs: dict[str, Run]) -> None:
    for trial, name in ((OVER, "over"), (SHORT, "short")):
        assert outcome(at_toggle(trial, runs[name]), 1e-2).outcome == "ok"
    grade = outcome(at_toggle(SHORT, runs["over"]), 1e-2)
    assert grade.outcome == "branch-changed"
    assert grade.reason == "rocker moved to the other assembly"
    errors, barrier = at_toggle(OVER, runs["short"]), OVER.throw.barrier
    nearest = toggle_passage(barrier, runs["short"]).nearest_rad
    assert outcome(errors, 1e-2).outcome == "degraded"
    assert 0.0 < nearest < 0.2 * abs(barrier.open_rad)
    assert worst(errors) == pytest.approx(nearest + 0.5 * abs(barrier.open_rad), rel=1e-12)
    over, barrier = runs["over"], OVER.throw.barrier
    early = cut(over, 100)
    apart = replace(over, gaps={name: gap + 0.1 for name, gap in over.gaps.items()})
    passages = [early, replace(early, status="diverged"), apart]
    found = [toggle_passage(barrier, each).outcome for each in passages]
    assert found == ["undecided", "broken", "broken"]
    assert outcome(at_toggle(OVER, early), 1e-2).outcome != "ok"


@pytest.mark.parametrize("name", ["toggle-over", "toggle-short"])
def test_every_engine_holds_a_margin_of_a_tenth(name: str) -> None:
    for engine, profile in LINES:
        assert graded(CATALOGUE[name], engine, profile, 0.1, draw=False)[0].outcome == "ok"
