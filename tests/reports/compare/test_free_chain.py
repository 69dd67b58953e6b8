"""A chain of windows in an engine, against its closed form: what is measured, and what is seen."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from analytic.free.exact_motions import ChainMotion
from analytic.kinematics import solve
from models.array import Array
from models.errors import CrankcheckError
from models.files.reading import load_scene
from models.scene.hard import WindowChain
from reports.compare.hard_runs import ChainErrors, compared, hold
from sim.engine import BodyPose, Poses
from sim.run import run
from tests.worlds.fake.engine import FakeEngine, turned_link

CHAIN = WindowChain(2)


def held(disturb: Callable[[Poses], Poses] = lambda poses: poses, **given: Any) -> ChainErrors:
    """The chain for 2 s in an engine that follows the closed form but for what is told."""
    exact = ChainMotion(CHAIN)
    fake = FakeEngine(lambda _, t: exact.motion(t), disturb=disturb, **given)
    return hold(CHAIN, fake, dt_s=1e-3, duration_s=2.0, every=5)


def changed(change: Callable[[BodyPose, Array], BodyPose], *names: str) -> Callable[[Poses], Poses]:
    def disturb(poses: Poses) -> Poses:
        own = {name: poses.bodies[name] for name in names or poses.bodies}
        other = {name: change(body, poses.time_s) for name, body in own.items()}
        return replace(poses, bodies={**poses.bodies, **other})

    return disturb


def test_an_exact_run_has_no_error_and_keeps_its_energy() -> None:
    found = held()
    assert found.run.drive == "free"
    np.testing.assert_array_equal(found.time_s, 5e-3 * np.arange(401))
    assert found.place_until(2.0) < 1e-14
    assert np.max([found.lean_rad.max(), found.gap_m.max(), found.energy_drift]) < 1e-14
    assert found.left is None


def test_velocities_half_a_step_late_are_no_drift_of_energy() -> None:
    assert 1e-9 < held(velocity_shift=0.5).energy_drift < 2e-6
    unsaid = held(lambda poses: replace(poses, lag_s=0.0), velocity_shift=0.5)
    assert unsaid.energy_drift > 1e-3


def test_a_rod_that_leaves_the_others_is_seen_where_it_began() -> None:
    apart = held(turned_link("rocker2", lambda t: np.clip(t - 1.0, 0.0, 0.6)))
    assert apart.gap_m.max() == pytest.approx(2.0 * np.sin(0.3), abs=1e-3)
    assert apart.left is None  # its pins are open: it has not left its branch, but come apart
    shut = {pin: 0.0 * gap for pin, gap in apart.run.gaps.items()}
    left = compared(CHAIN, replace(apart.run, gaps=shut)).left
    assert left.link == "rocker2"
    assert left.time_s == pytest.approx(1.02, abs=0.006)
    truth = ChainMotion(CHAIN).at(np.array([left.time_s]))[0]
    assert left.driver_rad == pytest.approx(truth[0], abs=0.03)
    # One that gives way a little has not left.
    little = held(turned_link("coupler0", lambda t: 0.1 * np.sin(9.0 * t)))
    assert little.left is None
    assert little.lean_rad.max() == pytest.approx(0.1, abs=1e-3)


def test_energy_that_is_lost_is_measured_over_what_a_turn_exchanges() -> None:
    def less(rod: BodyPose, _: Array) -> BodyPose:
        return replace(rod, velocity=0.99 * rod.velocity, omega=0.99 * rod.omega)

    turning, found = ChainMotion(CHAIN), held(changed(less))
    speed = turning.at(found.time_s)[1]
    lost = (1.0 - 0.99**2) * (0.5 * turning.inertia * speed**2).max()
    assert found.energy_drift == pytest.approx(lost / turning.exchanged_j, rel=1e-9)
    assert found.energy_j[-1] < 0.0
    assert found.speed_m_s == pytest.approx(0.01 * CHAIN.length_m * np.abs(speed), rel=1e-9)


def test_the_error_of_b0_is_the_largest_so_far_and_none_after_the_end() -> None:
    def aside(rod: BodyPose, time_s: Array) -> BodyPose:
        return replace(rod, origin=rod.origin + np.outer(time_s, (1e-3, 0.0)))

    found = held(changed(aside, "rocker0"), diverges_after=1500)
    assert found.run.status == "diverged"
    assert found.place_until(1.0) == pytest.approx(1e-3)
    assert found.place_until(1.5) == pytest.approx(1.5e-3)
    assert np.isnan(found.place_until(2.0))


def test_a_run_that_was_driven_or_never_started_is_not_compared() -> None:
    scene = load_scene("fourbar-lecture-1")
    start = solve(scene, np.array([0.0])).state(0)
    driven = run(scene, start, FakeEngine(solve), dt_s=1e-3, steps=10)
    with pytest.raises(CrankcheckError, match=r"no free motion .* under the drive prescribed"):
        compared(CHAIN, driven)
    with pytest.raises(CrankcheckError, match="no free motion to compare: not today"):
        held(refuses="not today")


def test_mujoco_tuned_falls_through_both_flat_positions_with_the_rods_parallel() -> None:
    found = hold(CHAIN, "mujoco", dt_s=1e-3, duration_s=2.0, every=10)
    assert ChainMotion(CHAIN).period_s < 2.0
    assert (found.run.status, found.left) == ("ok", None)
    assert found.place_until(2.0) < 1e-4
    assert found.energy_drift < 1e-5
    assert found.gap_m.max() < 1e-6
