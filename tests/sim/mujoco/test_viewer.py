"""What the viewer plays keeps to the law of the driver, without a screen."""

from __future__ import annotations

from dataclasses import replace

import mujoco  # type: ignore[import-untyped]  # ships no stubs
import numpy as np
import pytest

from analytic.kinematics import solve
from models.characteristics import Sine
from models.files import load_scene
from models.friction import ConstantFriction
from models.loads import Load
from sim.mujoco import viewer as mujoco_viewer


@pytest.mark.parametrize("name", ["fourbar-double-rocker", "tangent", "fourbar-lecture-1"])
def test_a_model_played_for_a_period_stays_together(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    scene = load_scene(name)
    ends = []

    def play(model: object, data: object) -> None:
        steps = round(scene.driver.law.period_s / model.opt.timestep)  # type: ignore[attr-defined]  # MjModel
        mujoco.mj_step(model, data, steps)
        first, second = data.site_xpos[model.eq_obj1id[0]], data.site_xpos[model.eq_obj2id[0]]  # type: ignore[attr-defined]  # MjData
        ends.append((float(np.linalg.norm(first - second)), float(data.qpos[0])))  # type: ignore[attr-defined]  # MjData

    monkeypatch.setattr(mujoco.viewer, "launch", play)
    mujoco_viewer.show(scene, solve(scene, np.zeros(1)).state())
    (gap, angle), law = ends[0], scene.driver.law
    assert gap < 1e-5 * scene.longest_m
    assert angle == pytest.approx(law.at(np.array([law.period_s]))[0][0], abs=1e-3)
    assert mujoco.get_mjcb_control() is None


def test_what_is_played_has_its_loads_and_friction(monkeypatch: pytest.MonkeyPatch) -> None:
    """A load over the angle keeps its size up to date; the motor of the crank is another."""
    course = Sine(2.0, 2.0 * np.pi)
    scene = load_scene("fourbar-double-rocker")
    scene = replace(
        scene,
        loads={"cam": Load("cam", "rocker", None, course, "angle")},
        friction={"C": ConstantFriction("C", 0.01)},
    )
    seen = []

    def play(model: object, data: object) -> None:
        mujoco.mj_step(model, data, 200)
        mujoco.mj_forward(model, data)
        seen.append((float(data.ctrl[1]), float(data.qpos[0])))  # type: ignore[attr-defined]  # MjData

    monkeypatch.setattr(mujoco.viewer, "launch", play)
    mujoco_viewer.show(scene, solve(scene, np.zeros(1)).state())
    size, angle = seen[0]
    assert size == pytest.approx(2.0 * np.sin(angle))
    assert abs(size) > 0.1
