"""Runs of free motion whose errors are known: a phase that lags, a linkage that is open, a truth
that ends, another assembly."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from analytic.kinematics import solve_driven
from models.files import load_scene
from models.motion import Motion
from models.scene import Scene
from reports.compare.compare import compare, places
from reports.compare.errors import Errors
from reports.compare.free.free_truth import FreeTruth, free_truth
from sim.engine import Run
from sim.run import run

DT_S, STEPS = 1e-3, 160


@pytest.fixture(scope="module")
def scene() -> Scene:
    return load_scene("fourbar-swing")


@pytest.fixture(scope="module")
def truth(scene: Scene) -> FreeTruth:
    return free_truth(scene, STEPS, DT_S)


@pytest.fixture(scope="module")
def done(scene: Scene, truth: FreeTruth) -> Run:
    return run(scene, truth.start, "pymunk", dt_s=DT_S, steps=STEPS, drive="free")


def found(truth: FreeTruth, of: Run) -> Errors:
    return compare(truth.beside(of))


def moved(of: Run, motion: Motion) -> Run:
    """The run, as if it had logged a motion whose rates belong to the instants of its places."""
    times = motion.time_s
    return replace(of, motion=motion, velocity_time_s=times, acceleration_time_s=times)


def late(truth: FreeTruth, by_s: float) -> Motion:
    times = DT_S * np.arange(STEPS + 1.0)
    return replace(truth.at(times * (1.0 - by_s / times[-1])), time_s=times, bound=None)


def test_a_phase_that_lags_is_told_from_a_linkage_that_is_open(truth: FreeTruth, done: Run) -> None:
    errors = found(truth, moved(done, late(truth, 2e-4)))
    phase, raw = errors.worst("phase"), errors.worst("phase", kind="raw")
    geometry = errors.worst("geometry")
    assert errors.free
    assert None not in (phase, raw, geometry)
    speed = truth.at(np.array([DT_S * STEPS])).links["crank"].omega[0]
    assert raw.maximum == pytest.approx(2e-4 * abs(speed), rel=1e-2)
    growth = errors.free.sensitivity
    assert raw.maximum / growth <= phase.maximum <= raw.maximum
    assert geometry.maximum < 1e-12
    assert errors.departure is None


def test_a_linkage_that_is_open_is_told_from_a_phase_that_lags(truth: FreeTruth, done: Run) -> None:
    motion = late(truth, 0.0)
    rocker = motion.links["rocker"]
    bent = replace(rocker, theta=rocker.theta + 1e-5)
    errors = found(truth, moved(done, replace(motion, links={**motion.links, "rocker": bent})))
    geometry, phase = errors.worst("geometry"), errors.worst("phase", kind="raw")
    assert None not in (geometry, phase)
    assert (geometry.body, geometry.maximum) == ("rocker", pytest.approx(1e-5, rel=1e-6))
    assert phase.maximum < 1e-14


def test_errors_at_the_same_time_are_over_the_growth_of_their_own_time(
    truth: FreeTruth, done: Run
) -> None:
    growing = replace(
        truth, free=_Steeper(truth.free, lambda time_s: 1.0 + 1e3 * time_s), known_rad=1.0
    )
    plain, over = (found(each, moved(done, late(truth, 2e-4))) for each in (truth, growing))
    assert over.free
    assert over.free.sensitivity == pytest.approx(1.0 + 1e3 * DT_S * STEPS)
    for name in ("phase", "angle", "position", "velocity"):
        before, after = plain.worst(name), over.worst(name)
        assert None not in (before, after)
        assert after.maximum < 0.1 * before.maximum, name
    for name in ("geometry", "gap"):
        assert plain.worst(name) == over.worst(name), name
    raw = [each.worst("phase", kind="raw") for each in (plain, over)]
    assert raw[0] == raw[1]


def test_samples_that_the_truth_does_not_know_well_enough_are_left_out_and_counted(
    truth: FreeTruth, done: Run
) -> None:
    unsure = replace(truth, free=_Unsure(truth.free, from_s=0.1))
    errors = found(unsure, done)
    assert errors.free
    assert errors.free.until_s == pytest.approx(0.099)
    assert errors.free.left_out == STEPS + 1 - 100
    assert any("truth ends at t = 0.099 s" in note for note in errors.notes)
    assert all(row.samples <= 100 for row in errors.rows)
    assert errors.incomplete == ""


def test_horizons_are_the_times_to_which_a_class_holds(truth: FreeTruth, done: Run) -> None:
    facts = found(truth, moved(done, late(truth, 2e-4))).free
    assert facts
    assert facts.horizon_s(1.0) == DT_S * STEPS
    assert facts.horizon_s(0.0) == 0.0
    held = facts.horizon_s(1e-4)
    assert 0.0 < held < DT_S * STEPS
    assert held < facts.horizon_s(2e-4) <= facts.judged_horizon_s(2e-4)


def test_an_assembly_that_the_truth_is_not_in_is_a_departure(
    scene: Scene, truth: FreeTruth, done: Run
) -> None:
    right = late(truth, 0.0)
    theta, still = right.links["crank"].theta, np.zeros(STEPS + 1)
    other = replace(truth.scene, branch={"C": -1})
    wrong = solve_driven(other, theta, still, still, right.time_s, bound=False)
    half = right.each_series(lambda series: series.copy())
    for name, link in half.links.items():
        link.theta[80:] = wrong.links[name].theta[80:]
    errors = found(truth, replace(moved(done, half), gaps=dict.fromkeys(done.gaps, still)))
    assert errors.departure.time_s == pytest.approx(0.079)


def test_velocities_from_before_the_start_have_a_truth(scene: Scene, truth: FreeTruth) -> None:
    times = DT_S * np.array([-0.5, 0.0, 0.5])
    motion = truth.at(times)
    crank = motion.links["crank"]
    # From rest the motion is the same to both sides.
    assert crank.omega[0] == pytest.approx(-crank.omega[2], rel=2e-5)
    assert crank.theta[0] == pytest.approx(crank.theta[2], abs=1e-9)
    assert np.all(np.isfinite(motion.points["C"].velocity))


def test_places_alone_have_the_rows_of_the_whole_comparison(truth: FreeTruth, done: Run) -> None:
    whole = found(truth, done).rows
    alone = places(truth.beside(done))
    assert alone
    assert all(row in whole for row in alone)


class _Changed:
    """A free motion of which something else is said."""

    def __init__(self, motion: object) -> None:
        self._motion = motion

    def __getattr__(self, name: str) -> object:
        return getattr(self._motion, name)


class _Steeper(_Changed):
    def __init__(self, motion: object, growth: object) -> None:
        super().__init__(motion)
        self.sensitivity = growth


class _Unsure(_Changed):
    def __init__(self, motion: object, from_s: float) -> None:
        super().__init__(motion)
        self._from_s = from_s

    def error_rad(self, time_s: np.ndarray) -> np.ndarray:
        return np.where(time_s < self._from_s - 1e-9, 0.0, 1.0)
