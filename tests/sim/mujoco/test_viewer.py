"""What the viewer plays keeps to the law of the driver, without a screen."""

from __future__ import annotations

import mujoco  # type: ignore[import-untyped]  # ships no stubs
import numpy as np
import pytest

from analytic.kinematics import solve
from models.files import load_scene
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
