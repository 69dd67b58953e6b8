"""Logs that look well at their end, and are not: what is seen of them is not graded as good."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from analytic.kinematics import solve
from models.motion import Motion
from reports.stability.case import Trial
from reports.stability.catalogue import CATALOGUE
from reports.stability.error_series import error_series
from reports.stability.grades import outcome
from reports.stability.limit import at_limit
from sim.engine import Run
from sim.run import run


def done(trial: Trial) -> Run:
    """A healthy run of MuJoCo, tuned."""
    return run(
        trial.scene,
        solve(trial.scene, np.zeros(1)).state(),
        "mujoco",
        dt_s=trial.dt_s,
        steps=trial.steps,
        every=trial.every,
        drive=trial.drive,
    )


def moved(found: Run) -> Motion:
    return found.motion


def with_crank(found: Run, theta: np.ndarray) -> Run:
    motion = moved(found)
    links = {**motion.links, "crank": replace(motion.links["crank"], theta=theta)}
    return replace(found, motion=replace(motion, links=links))


def with_gap(found: Run, gap: float) -> Run:
    """One joint open in mid-run."""
    opened = found.gaps["C"].copy()
    opened[len(opened) // 2] = gap
    return replace(found, gaps={**found.gaps, "C": opened})


def stuck(found: Run) -> Run:
    """The crank never moves."""
    theta = moved(found).links["crank"].theta
    return with_crank(found, np.full_like(theta, theta[0]))


def overshot(found: Run) -> Run:
    """The crank goes a radian beyond its limit in mid-run, and comes back."""
    theta = moved(found).links["crank"].theta.copy()
    theta[len(theta) // 2] += 1.0
    return with_crank(found, theta)


@pytest.mark.parametrize(
    ("spoil", "ending"),
    [
        (lambda found: found, "locked"),
        (stuck, "degraded"),
        (overshot, "degraded"),
        (lambda found: with_gap(found, 0.4), "degraded"),
        (lambda found: with_gap(found, np.inf), "diverged"),
        (lambda found: with_gap(found, np.nan), "diverged"),
    ],
)
def test_a_crank_is_locked_only_at_its_limit_with_its_joints_closed_throughout(
    spoil: Callable[[Run], Run], ending: str
) -> None:
    case = CATALOGUE["triple-rocker-limit"]
    trial = case.trial(10.0)
    assert outcome(at_limit(trial, spoil(done(trial))), case.within).outcome == ending


def cut(found: Run) -> Run:
    """Only the first fifth is logged, and the engine says that all is well."""
    keep = slice(0, len(moved(found).time_s) // 5)
    motion = moved(found).each_series(lambda series: series[keep])
    short = replace(motion, time_s=motion.time_s[keep])
    return replace(found, motion=short, gaps={n: gap[keep] for n, gap in found.gaps.items()})


@pytest.mark.parametrize(
    ("spoil", "word"), [(cut, "samples"), (lambda found: replace(found, gaps={}), "no gap of")]
)
def test_a_log_with_holes_is_not_held(spoil: Callable[[Run], Run], word: str) -> None:
    trial = CATALOGUE["coarse-step"].trial(90.0)
    found = outcome(error_series(trial.scene, spoil(done(trial))), 1e-2)
    assert found.outcome == "crashed"
    assert word in found.reason


def test_a_branch_left_before_the_run_has_settled_does_not_count() -> None:
    case = CATALOGUE["open-joint"]
    scene = case.trial(1e-3).scene
    trial = Trial(scene)
    healthy = done(trial)
    other = replace(scene, branch={name: -sign for name, sign in scene.branch.items()})
    motion = moved(healthy)
    wrong = solve(other, motion.time_s, bound=False)
    at = np.arange(len(motion.time_s))
    early = (at > 20) & (at < 100)

    def mixed(name: str) -> np.ndarray:
        return np.where(early, wrong.links[name].theta, motion.links[name].theta)

    links = {name: replace(link, theta=mixed(name)) for name, link in motion.links.items()}
    strayed = replace(healthy, motion=replace(motion, links=links))
    assert outcome(error_series(scene, strayed), 1e-2).outcome == "branch-changed"
    assert outcome(error_series(scene, strayed, settled_turns=1.0), 1e-2).outcome == "ok"
