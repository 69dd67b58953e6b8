"""MuJoCo's own viewer, for a person to look at a model."""

from __future__ import annotations

import mujoco  # type: ignore[import-untyped]  # ships no types
import mujoco.viewer  # type: ignore[import-untyped]  # as above


def show(xml: str) -> None:
    """Open the model of an MJCF text at its first keyframe; returns when the window is closed."""
    model = mujoco.MjModel.from_xml_string(xml)
    state = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, state, 0)
    mujoco.viewer.launch(model, state)
