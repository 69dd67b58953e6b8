"""What can still move while the driven joint is held: the independent count of freedoms."""

from __future__ import annotations

from typing import Any

import mujoco  # type: ignore[import-untyped]  # ships no stubs
import numpy as np

from models.array import Array
from sim.mujoco.own_model.closures import Closure
from sim.mujoco.own_model.component import Component, joint_name

NOTHING = 1e-9
"""Singular values of the closures below this, over the largest, hold nothing; shares of a motion
below its root are rounding."""


def loose_joints(component: Component) -> list[str]:
    """The joints that move in some motion of the model as it is drawn, while the driven one stands:
    the null space of the Jacobian of its closures."""
    model = component.model
    joints = [
        joint.index
        for body in component.bodies
        for joint in body.joints
        if joint.index != component.driven
    ]
    columns = [int(model.jnt_dofadr[joint]) for joint in joints]
    rows = [_rows(component, each)[:, columns] for each in component.closures]
    if not joints:
        return []
    _, values, directions = np.linalg.svd(np.vstack(rows))
    held = int(np.count_nonzero(values > NOTHING * (values[0] or 1.0)))
    moving = np.abs(directions[held:]).max(axis=0, initial=0.0) > NOTHING**0.5
    return [joint_name(model, joint) for joint, moves in zip(joints, moving, strict=True) if moves]


def _rows(component: Component, closure: Closure) -> Array:
    """The speeds in the plane that a closure forbids, (2 or 3, nv)."""
    model, data, plane = component.model, component.data, component.plane
    ends = []
    for body, anchor in zip(closure.bodies, closure.anchors, strict=True):
        along, about = np.zeros((3, model.nv)), np.zeros((3, model.nv))
        mujoco.mj_jac(model, data, along, about, anchor, body)
        ends.append([plane.x @ along, plane.y @ along, plane.normal @ about])
    rows: Any = np.array(ends[1]) - np.array(ends[0])
    return np.asarray(rows if closure.kind == "weld" else rows[:2])
