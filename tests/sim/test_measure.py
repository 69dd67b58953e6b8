"""From poses to the motion of the mechanism: exact poses give the exact motion, faults show."""

from __future__ import annotations

from dataclasses import replace
from types import ModuleType

import numpy as np
import pytest

from analytic.kinematics import solve
from models.files import load_scene, shipped
from models.scene import Scene
from sim.engine import Poses
from sim.measure import gaps, motion


def exact(scene: Scene, fake_engine: ModuleType, samples: int = 97) -> Poses:
    """True poses over 1.2 periods."""
    time_s = np.linspace(0.0, 1.2 * scene.driver.law.period_s, samples)
    poses: Poses = fake_engine.exact_poses(scene, fake_engine.FakeEngine(solve), time_s, 1e-3)
    return poses


@pytest.mark.parametrize("name", sorted(shipped()))
def test_exact_poses_give_the_exact_motion_without_gaps(name: str, fake_engine: ModuleType) -> None:
    scene = load_scene(name)
    poses = exact(scene, fake_engine)
    found, wanted = motion(scene, poses), solve(scene, poses.time_s)
    assert set(found.points) == set(wanted.points)
    for kind in ("links", "points", "sliders"):
        for key, track in getattr(wanted, kind).items():
            for quantity, array in vars(track).items():
                got = getattr(getattr(found, kind)[key], quantity)
                scale = max(np.abs(array).max(), scene.longest_m)
                np.testing.assert_allclose(
                    got, array, atol=1e-11 * scale, err_msg=f"{key} {quantity}"
                )
    open_by = gaps(scene, poses)
    assert set(scene.sliders) <= set(open_by)
    assert max(gap.max() for gap in open_by.values()) < 1e-13


def test_a_pin_gap_is_the_largest_distance_of_two_copies(fake_engine: ModuleType) -> None:
    scene = load_scene("fourbar-lecture-1")
    poses = exact(scene, fake_engine)
    body = poses.bodies["rocker"]
    moved = replace(body, origin=body.origin + np.array([3e-4, 4e-4]))
    found = gaps(scene, replace(poses, bodies={**poses.bodies, "rocker": moved}))
    np.testing.assert_allclose(found["C"], 5e-4, rtol=1e-9)
    np.testing.assert_allclose(found["D"], 5e-4, rtol=1e-9)
    assert found["B"].max() < 1e-15


def test_a_slider_gap_is_the_distance_from_the_line_and_not_along_it(
    fake_engine: ModuleType,
) -> None:
    scene = load_scene("slider-crank-excel-350")
    poses = exact(scene, fake_engine)
    body = poses.bodies["rod"]
    moved = replace(body, origin=body.origin + np.array([3e-4, -4e-4]))
    found = gaps(scene, replace(poses, bodies={**poses.bodies, "rod": moved}))
    np.testing.assert_allclose(found["C"], 4e-4, rtol=1e-9)
    np.testing.assert_allclose(found["B"], 5e-4, rtol=1e-9)


def test_a_sliding_body_that_turns_against_its_line_is_a_gap(fake_engine: ModuleType) -> None:
    scene = load_scene("scotch-yoke")
    poses = exact(scene, fake_engine)
    yoke, block = poses.bodies["yoke"], poses.bodies["block B"]
    turned = replace(poses, bodies={**poses.bodies, "yoke": replace(yoke, theta=yoke.theta + 1e-5)})
    np.testing.assert_allclose(gaps(scene, turned)["Y"], 1e-5 * scene.longest_m, rtol=1e-6)
    tipped = replace(
        poses,
        bodies={**poses.bodies, "block B": replace(block, theta=block.theta - 2e-5 + 4 * np.pi)},
    )
    np.testing.assert_allclose(gaps(scene, tipped)["B"], 2e-5 * scene.longest_m, rtol=1e-6)


@pytest.mark.parametrize("off_rad", [0.0, 0.3])
def test_speed_and_acceleration_along_a_moving_line_are_rates_of_the_displacement(
    off_rad: float, fake_engine: ModuleType
) -> None:
    """Also for a point off its line, where the Coriolis term has a part along it."""
    scene = load_scene("slotted-lever")
    turned = fake_engine.turned_link("lever", lambda t: np.full_like(t, off_rad))
    poses = turned(exact(scene, fake_engine, 4001))
    found = motion(scene, poses).sliders["B"]
    for rate, of in ((found.speed, found.displacement), (found.acceleration, found.speed)):
        by_hand = np.gradient(of, poses.time_s, edge_order=2)
        np.testing.assert_allclose(rate, by_hand, atol=1e-4 * np.abs(rate).max())


def test_an_injected_error_comes_out_as_it_went_in(fake_engine: ModuleType) -> None:
    scene = load_scene("fourbar-lecture-1")
    poses = exact(scene, fake_engine)
    wrong = fake_engine.turned_link("rocker", lambda t: 1e-3 * t)(poses)
    off = motion(scene, wrong).links["rocker"].theta - motion(scene, poses).links["rocker"].theta
    np.testing.assert_allclose(off, 1e-3 * poses.time_s, atol=1e-15)
    np.testing.assert_allclose(
        gaps(scene, wrong)["C"], 0.2e-3 * poses.time_s, rtol=1e-6, atol=1e-15
    )


def lagging(scene: Scene, fake_engine: ModuleType, lag_s: float) -> Poses:
    """Positions and accelerations of each time with the velocities of ``lag_s`` later."""
    now = exact(scene, fake_engine)
    later: Poses = fake_engine.exact_poses(
        scene, fake_engine.FakeEngine(solve), now.time_s + lag_s, 1e-3
    )

    mixed = {
        name: replace(body, velocity=other.velocity, omega=other.omega)
        for (name, body), other in zip(now.bodies.items(), later.bodies.values(), strict=True)
    }
    return replace(now, bodies=mixed, lag_s=lag_s)


@pytest.mark.parametrize(
    "name", ["fourbar-lecture-1", "slotted-lever", "shaper", "slider-crank-offset"]
)
def test_velocities_that_lag_are_those_of_their_own_instant(
    name: str, fake_engine: ModuleType
) -> None:
    scene = load_scene(name)

    def worst(lag_s: float, level: int) -> float:
        poses = lagging(scene, fake_engine, lag_s)
        found = motion(scene, poses)
        wanted = solve(scene, poses.time_s + (lag_s if level == 1 else 0.0))
        errors = []
        for kind in ("points", "sliders"):
            for key, track in getattr(wanted, kind).items():
                quantity = list(vars(track))[level]
                got = getattr(getattr(found, kind)[key], quantity)
                errors.append(float(np.abs(got - getattr(track, quantity)).max()))
        return max(errors)

    period = scene.driver.law.period_s
    for level in (1, 2):
        coarse, fine = worst(period / 200, level), worst(period / 400, level)
        assert fine < 2e-3 * scene.longest_m * scene.driver.law.peak_speed_rad_s**level
        assert 3.5 < coarse / fine < 4.5, level
