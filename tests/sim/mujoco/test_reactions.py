"""The forces that MuJoCo reports: each body in equilibrium, and against the reference."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pytest

from analytic.forces import kinetostatics
from analytic.kinematics import solve
from models.array import Array
from models.files import load_scene, shipped
from models.forces import Forces
from models.joints import block_name, local_point
from models.poses import centre_of, mass_of
from models.scene import GROUND, Scene
from sim.engine import BodyPose, Drive, ForceSession, Log, Settings
from sim.registry import engine
from sim.settings import resolved
from tests.worlds.tiers import few

STEPS = 720
WITHIN: Mapping[str, float] = {
    "scotch-yoke": 4e-4,
    "shaper": 8e-4,
    "fourbar-double-crank": 3e-4,
    "slider-crank-offset": 1.2e-4,
    "slider-crank-central": 1.2e-4,
}
"""Of the largest reaction, and torque of the largest torque, where it is not 1e-4."""

KINDS = ("sixbar-watt", "slider-crank-excel-210", "shaper", "scotch-yoke", "slotted-lever")


def opened(
    scene: Scene,
    settings: Settings | None = None,
    *,
    steps: int = STEPS,
    drive: Drive = "prescribed",
    profile: str = "tuned",
) -> ForceSession:
    mujoco, state = engine("mujoco"), solve(scene, np.zeros(1)).state()
    chosen = resolved(mujoco.profiles[profile], settings)
    session = mujoco.open(scene, state, chosen, scene.driver.law.period_s / steps, drive)
    assert hasattr(session, "record_forces")
    return session  # type: ignore[return-value]


def acting(log: Log) -> Forces:
    assert log.forces is not None
    return log.forces


def turned(pose: BodyPose, local: tuple[float, float]) -> Array:
    c, s = np.cos(pose.theta), np.sin(pose.theta)
    return np.stack([c * local[0] - s * local[1], s * local[0] + c * local[1]], axis=-1)


def cross(a: Array, b: Array) -> Array:
    return np.asarray(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])


def left_over(scene: Scene, log: Log) -> float:
    """What is left of the equilibrium of the bodies in the engine's own motion, over the largest
    force and that times the longest link."""
    forces, poses = acting(log), log.poses.bodies
    largest = max(float(np.abs(f).max()) for by in forces.pins.values() for f in by.values())
    worst = 0.0
    for body, pose in poses.items():
        mass, inertia = mass_of(scene, body)
        arm = turned(pose, centre_of(scene, body))
        push = pose.origin_acceleration - arm * (pose.omega**2)[:, None]
        push = push + np.stack([-pose.alpha * arm[:, 1], pose.alpha * arm[:, 0]], axis=-1)
        force = mass * (np.array(scene.gravity_m_s2) - push)
        moment = -inertia * pose.alpha + cross(arm, force)  # about the body's origin
        for point, by_body in forces.pins.items():
            if body in by_body:
                force = force + by_body[body]
                moment = moment + cross(
                    turned(pose, local_point(scene, body, point)), by_body[body]
                )
        if body == scene.driver.link:
            moment = moment + forces.torque
        for slider in scene.sliders.values():
            rider = slider.link or block_name(slider)
            if body not in (rider, slider.on):
                continue
            sign = 1.0 if body == rider else -1.0
            guide = np.zeros_like(pose.theta) if slider.on == GROUND else poses[slider.on].theta
            line = guide + slider.direction_rad
            across = np.stack([-np.sin(line), np.cos(line)], axis=-1)
            own, by = forces.sliders[slider.name], forces.pins.get(slider.point, {})
            carrier = next(b for b in (rider, *by) if b in poses and b != slider.on)
            at = poses[carrier].origin + turned(
                poses[carrier], local_point(scene, carrier, slider.point)
            )
            force = force + sign * own.normal[:, None] * across
            moment = moment + sign * (
                cross(at - pose.origin, own.normal[:, None] * across) + own.moment
            )
        worst = max(worst, float(np.abs(force).max()) / largest)
        worst = max(worst, float(np.abs(moment).max()) / largest / scene.longest_m)
    return worst


def worst_of(scene: Scene, forces: Forces) -> tuple[float, float]:
    """The largest error of a reaction over the largest reaction, and that of the torque."""
    true = kinetostatics.forces(scene, forces.time_s, bound=False, skip_dead_points=True)
    pairs = [(forces.pins[p][b], f) for p, by in true.pins.items() for b, f in by.items()]
    normals = [(forces.sliders[s].normal, one.normal) for s, one in true.sliders.items()]
    largest = max(np.nanmax(np.hypot(*f.T)) for _, f in pairs)
    off = [np.nanmax(np.hypot(*(found - f).T)) for found, f in pairs]
    off += [np.nanmax(np.abs(found - f)) for found, f in normals]
    turning = [(forces.sliders[s].moment, one.moment) for s, one in true.sliders.items()]
    off += [np.nanmax(np.abs(found - m)) / scene.longest_m for found, m in turning]
    torque = np.nanmax(np.abs(forces.torque - true.torque)) / np.nanmax(np.abs(true.torque))
    return float(max(off) / largest), float(torque)


@pytest.mark.parametrize("name", few(sorted(shipped()), KINDS, "shapes of the same kinds"))
def test_forces_are_those_of_the_reference_and_of_each_bodys_equilibrium(name: str) -> None:
    scene = load_scene(name)
    log = opened(scene).record_forces(STEPS, 1)
    for by_body in acting(log).pins.values():
        assert np.abs(sum(by_body.values())).max() == pytest.approx(0.0, abs=1e-12)
    assert left_over(scene, log) < 1e-9
    reaction, torque = worst_of(scene, acting(log))
    assert max(reaction, torque) < WITHIN.get(name, 1e-4)


def test_forces_change_nothing_of_the_motion() -> None:
    scene = load_scene("whitworth")
    alone, with_forces = opened(scene).record(60, 3), opened(scene).record_forces(60, 3)
    for name, pose in alone.poses.bodies.items():
        for key, series in vars(pose).items():
            np.testing.assert_array_equal(series, vars(with_forces.poses.bodies[name])[key])
    assert len(acting(with_forces).time_s) == len(alone.poses.time_s) == 21


@pytest.mark.parametrize("close", ["B", "C", "D"])
def test_forces_do_not_depend_on_where_the_loop_is_closed(close: str) -> None:
    scene = load_scene("fourbar-lecture-1")
    log = opened(scene, {"close": close}).record_forces(STEPS, 4)
    assert left_over(scene, log) < 1e-9
    assert max(worst_of(scene, acting(log))) < 1e-4
