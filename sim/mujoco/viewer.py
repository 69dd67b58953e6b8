"""MuJoCo's own viewer, for a person to look at a model."""

from __future__ import annotations

from typing import Any

import mujoco  # type: ignore[import-untyped]  # ships no types
import mujoco.viewer  # type: ignore[import-untyped]  # as above
import numpy as np

from models.laws import Law
from models.mjcf import build
from models.motion import State
from models.scene import Scene
from sim.viewing import Viewer


def show(scene: Scene, start: State) -> None:
    """Open a scene, assembled at the start; returns when the window is closed.

    Where the model has an actuator it is the motor of the crank, which gets the acceleration of
    the law at every step.
    """
    model = mujoco.MjModel.from_xml_string(build(scene, start))
    state = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, state, 0)
    if model.nu:
        mujoco.set_mjcb_control(driven(scene.driver.law))
    try:
        mujoco.viewer.launch(model, state)
    finally:
        mujoco.set_mjcb_control(None)


def driven(law: Law) -> Any:
    """The control callback that drives the crank by a law."""

    def control(_model: Any, data: Any) -> None:
        data.ctrl[0] = law.at(np.array([data.time]))[2][0]

    return control


VIEWER: Viewer = show
