"""MuJoCo's own viewer, to look at a model."""

from typing import Any

import mujoco  # type: ignore[import-untyped]  # ships no stubs
import mujoco.viewer  # type: ignore[import-untyped]  # as above
import numpy as np

from models.mjcf import document, forces, options
from models.motion import State
from models.scene import Scene
from sim.engine import Drive
from sim.mujoco.loading import Loading
from sim.registry.offers import Viewer


def show(scene: Scene, start: State) -> None:
    """Open a scene, assembled at the start; returns when the window is closed.

    The motor of the crank, if any, gets the acceleration of the law at every step, and the loads
    their sizes.
    """
    writing = options.exact(scene)
    tree = forces.planned(scene, start, writing.close, delay_s=writing.delay_s)
    model = mujoco.MjModel.from_xml_string(document.build(scene, start, writing, tree))
    state = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, state, 0)
    if model.nu:
        drive: Drive = "free" if scene.is_free else "prescribed"
        loading = Loading(scene, model, tree.limbs, drive, 0.0)
        driven = options.has_control(scene, writing)

        def control(_model: Any, data: Any) -> None:
            if driven:
                data.ctrl[0] = scene.driver.law.at(np.array([data.time]))[2][0]
            for k, load in enumerate(loading.loads):
                data.ctrl[loading.first + k] = loading.size(load, data)

        mujoco.set_mjcb_control(control)
    try:
        mujoco.viewer.launch(model, state)
    finally:
        mujoco.set_mjcb_control(None)


VIEWER: Viewer = show
