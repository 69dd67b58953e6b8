"""A chain of windows in an engine, against its closed form: what is measured, and what is seen."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from types import ModuleType
from typing import Any

import numpy as np
import pytest

from analytic.free.window_chain import ChainMotion
from analytic.kinematics import solve
from models.errors import CrankcheckError
from models.files import load_scene
from models.window_chain import Chain
from reports.compare.free_chain import ChainErrors, compared, hold
from sim.engine import Poses
from sim.run import run

CHAIN = Chain(2)


def held(
    fake_engine: ModuleType, disturb: Callable[[Poses], Poses] = lambda poses: poses, **given: Any
) -> ChainErrors:
    """The chain for 2 s in an engine that follows the closed form but for what is told."""
    exact = ChainMotion(CHAIN)
    fake = fake_engine.FakeEngine(lambda _, t: exact.motion(t), disturb=disturb, **given)
    return hold(CHAIN, fake, dt_s=1e-3, duration_s=2.0, every=5)


def test_an_exact_run_has_no_error_and_keeps_its_energy(fake_engine: ModuleType) -> None:
    found = held(fake_engine)
    assert found.run.drive == "free"
    np.testing.assert_array_equal(found.time_s, 5e-3 * np.arange(401))
    assert found.place_until(2.0) < 1e-14
    assert found.lean_rad.max() < 1e-14
    assert found.gap_m.max() < 1e-14
    assert found.energy_drift < 1e-14
    assert found.left is None


def test_velocities_half_a_step_late_are_no_drift_of_energy(fake_engine: ModuleType) -> None:
    said = held(fake_engine, velocity_shift=0.5)
    assert 1e-9 < said.energy_drift < 2e-6
    unsaid = held(fake_engine, lambda p: replace(p, lag_s=0.0), velocity_shift=0.5)
    assert unsaid.energy_drift > 1e-3


def turned(name: str, angle: Callable[[np.ndarray], np.ndarray]) -> Callable[[Poses], Poses]:
    """One rod turned on, about the pin that its frame is at."""

    def disturb(poses: Poses) -> Poses:
        rod = poses.bodies[name]
        theta = rod.theta + angle(poses.time_s)
        return replace(poses, bodies={**poses.bodies, name: replace(rod, theta=theta)})

    return disturb


@pytest.mark.parametrize("name", ["rocker0", "rocker2", "coupler1"])
def test_a_rod_that_leaves_the_others_is_seen_where_it_began(
    fake_engine: ModuleType, name: str
) -> None:
    apart = held(fake_engine, turned(name, lambda t: np.clip(t - 1.0, 0.0, 0.6)))
    assert apart.gap_m.max() == pytest.approx(2.0 * np.sin(0.3), abs=1e-3)
    assert apart.left is None  # its pins are open: it has not left its branch, but come apart
    shut = {pin: 0.0 * gap for pin, gap in apart.run.gaps.items()}
    found = compared(CHAIN, replace(apart.run, gaps=shut))
    assert found.left.link == name
    assert found.left.time_s == pytest.approx(1.02, abs=0.006)
    truth = ChainMotion(CHAIN).at(np.array([found.left.time_s]))[0]
    assert found.left.driver_rad == pytest.approx(truth[0], abs=0.03)


def test_a_rod_that_gives_way_a_little_has_not_left(fake_engine: ModuleType) -> None:
    found = held(fake_engine, turned("coupler0", lambda t: 0.1 * np.sin(9.0 * t)))
    assert found.left is None
    assert found.lean_rad.max() == pytest.approx(0.1, abs=1e-3)


def test_energy_that_is_lost_is_measured_over_what_a_turn_exchanges(
    fake_engine: ModuleType,
) -> None:
    def slowed(poses: Poses) -> Poses:
        def less(rod: Any) -> Any:
            return replace(rod, velocity=0.99 * rod.velocity, omega=0.99 * rod.omega)

        return replace(poses, bodies={name: less(rod) for name, rod in poses.bodies.items()})

    turning, found = ChainMotion(CHAIN), held(fake_engine, slowed)
    kinetic = 0.5 * turning.inertia * turning.at(found.time_s)[1] ** 2
    lost = (1.0 - 0.99**2) * kinetic.max()
    assert found.energy_drift == pytest.approx(lost / turning.exchanged_j, rel=1e-9)
    assert found.energy_j[-1] < 0.0
    wanted = 0.01 * CHAIN.length_m * np.abs(turning.at(found.time_s)[1])
    assert found.speed_m_s == pytest.approx(wanted, rel=1e-9)


def test_the_error_of_b0_is_the_largest_so_far_and_none_after_the_end(
    fake_engine: ModuleType,
) -> None:
    def shifted(poses: Poses) -> Poses:
        rod = poses.bodies["rocker0"]
        aside = np.stack([1e-3 * poses.time_s, np.zeros_like(poses.time_s)], axis=-1)
        moved = replace(rod, origin=rod.origin + aside)
        return replace(poses, bodies={**poses.bodies, "rocker0": moved})

    found = held(fake_engine, shifted, diverges_after=1500)
    assert found.run.status == "diverged"
    assert found.place_until(1.0) == pytest.approx(1e-3)
    assert found.place_until(1.5) == pytest.approx(1.5e-3)
    assert np.isnan(found.place_until(2.0))


def test_a_run_that_was_driven_or_never_started_is_not_compared(fake_engine: ModuleType) -> None:
    scene = load_scene("fourbar-lecture-1")
    start = solve(scene, np.array([0.0])).state(0)
    driven = run(scene, start, fake_engine.FakeEngine(solve), dt_s=1e-3, steps=10)
    with pytest.raises(CrankcheckError, match=r"no free motion .* under the drive prescribed"):
        compared(CHAIN, driven)
    with pytest.raises(CrankcheckError, match="no free motion to compare: not today"):
        held(fake_engine, refuses="not today")


def test_mujoco_tuned_falls_through_both_flat_positions_with_the_rods_parallel() -> None:
    found = hold(CHAIN, "mujoco", dt_s=1e-3, duration_s=2.0, every=10)
    assert ChainMotion(CHAIN).period_s < 2.0
    assert (found.run.status, found.left) == ("ok", None)
    assert found.place_until(2.0) < 1e-4
    assert found.energy_drift < 1e-5
    assert found.gap_m.max() < 1e-6


def test_pymunk_as_shipped_loses_energy_in_them_but_keeps_the_rods_parallel() -> None:
    found = hold(CHAIN, "pymunk", "as-shipped", dt_s=1e-3, duration_s=2.0, every=10)
    assert found.left is None
    assert found.energy_j[-1] < -1e-3
    assert 1e-4 < found.energy_drift < 0.1


def test_a_rod_alone_and_a_chain_without_weight_are_measured_too() -> None:
    assert hold(Chain(0), "pymunk", dt_s=1e-3, duration_s=0.5).energy_drift < 1e-3
    weightless = hold(Chain(1, gravity_m_s2=0.0), "mujoco", dt_s=1e-3, duration_s=0.5)
    assert weightless.energy_drift < 1e-6
    assert weightless.place_until(0.5) < 1e-6
