"""Body poses from joint coordinates agree with MuJoCo's own kinematics at arbitrary coordinates."""

from __future__ import annotations

import mujoco  # type: ignore[import-untyped]  # ships no stubs
import numpy as np
import pytest

from analytic.kinematics import solve
from models.files import load_scene, shipped
from models.mjcf import build
from models.tree import plan
from sim.tree_poses import body_poses


@pytest.mark.parametrize("name", sorted(shipped()))
def test_positions_and_velocities_are_those_of_mujoco(name: str) -> None:
    scene = load_scene(name)
    start = solve(scene, np.array([0.0])).state(0)
    model = mujoco.MjModel.from_xml_string(build(scene, start))
    data = mujoco.MjData(model)
    random = np.random.default_rng(5)
    q, rate, push = random.normal(size=(3, 6, model.nv))
    found = body_poses(plan(scene, start).limbs, q, rate, push)
    for row in range(len(q)):
        data.qpos[:], data.qvel[:] = q[row], rate[row]
        mujoco.mj_forward(model, data)
        for body, pose in found.items():
            number = model.body(body).id
            np.testing.assert_allclose(pose.origin[row], data.xpos[number][:2], atol=1e-13)
            turn = data.xmat[number].reshape(3, 3)
            np.testing.assert_allclose(np.cos(pose.theta[row]), turn[0, 0], atol=1e-13)
            np.testing.assert_allclose(np.sin(pose.theta[row]), turn[1, 0], atol=1e-13)
            speed = np.empty(6)
            mujoco.mj_objectVelocity(model, data, mujoco.mjtObj.mjOBJ_XBODY, number, speed, 0)
            np.testing.assert_allclose(pose.omega[row], speed[2], atol=1e-12)
            np.testing.assert_allclose(pose.velocity[row], speed[3:5], atol=1e-12)


@pytest.mark.parametrize("name", ["fourbar-lecture-1", "slotted-lever", "shaper", "scotch-yoke"])
def test_accelerations_are_the_rates_of_the_velocities(name: str) -> None:
    scene = load_scene(name)
    start = solve(scene, np.array([0.0])).state(0)
    limbs = plan(scene, start).limbs
    count = sum(len(limb.freedoms) for limb in limbs)
    random = np.random.default_rng(6)
    q0, v0, a0 = random.normal(size=(3, count))
    time_s = np.array([-1e-4, 0.0, 1e-4])[:, None]
    found = body_poses(
        limbs, q0 + v0 * time_s + a0 * time_s**2 / 2, v0 + a0 * time_s, a0 + 0 * time_s
    )
    for pose in found.values():
        by_hand = (pose.velocity[2] - pose.velocity[0]) / 2e-4
        np.testing.assert_allclose(pose.origin_acceleration[1], by_hand, rtol=1e-5, atol=1e-6)
        np.testing.assert_allclose(pose.alpha[1], (pose.omega[2] - pose.omega[0]) / 2e-4, rtol=1e-8)


def test_coordinates_beyond_numbers_are_a_run_that_came_apart_and_no_warning() -> None:
    scene = load_scene("slider-crank-offset")
    start = solve(scene, np.array([0.0])).state(0)
    limbs = plan(scene, start).limbs
    q = np.full((2, sum(len(limb.freedoms) for limb in limbs)), 1e300)
    found = body_poses(limbs, q, q, q)
    assert not all(np.isfinite(pose.origin_acceleration).all() for pose in found.values())
