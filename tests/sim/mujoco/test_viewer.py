"""What the viewer plays, without a screen."""

from typing import Any

import mujoco  # type: ignore[import-untyped]  # ships no stubs
import numpy as np
import pytest

from models.files.reading import load_scene
from models.scene.characteristics import Sine
from models.scene.loads import ConstantFriction, Load
from sim.mujoco import viewer as mujoco_viewer
from tests.worlds.runs import acted_on, start_of


def test_it_stays_together_keeps_to_its_law_and_has_its_loads_and_friction(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A load over the angle keeps its size up to date; the motor of the crank is another."""
    cam = Load("cam", "rocker", None, Sine(2.0, 2.0 * np.pi), "angle")
    scene = acted_on(load_scene("fourbar-double-rocker"), cam, ConstantFriction("C", 0.01))
    law, seen = scene.driver.law, []

    def play(model: Any, data: Any) -> None:
        mujoco.mj_step(model, data, round(0.9 * law.period_s / model.opt.timestep))
        mujoco.mj_forward(model, data)
        seen.extend([model, data])

    monkeypatch.setattr(mujoco.viewer, "launch", play)
    mujoco_viewer.show(scene, start_of(scene))
    model, data = seen
    gap = data.site_xpos[model.eq_obj1id[0]] - data.site_xpos[model.eq_obj2id[0]]
    assert np.linalg.norm(gap) < 1e-5 * scene.longest_m
    assert data.qpos[0] == pytest.approx(law.at(np.array([0.9 * law.period_s]))[0][0], abs=1e-3)
    assert data.ctrl[1] == pytest.approx(2.0 * np.sin(data.qpos[0]))
    assert abs(data.ctrl[1]) > 0.1
    assert mujoco.get_mjcb_control() is None
