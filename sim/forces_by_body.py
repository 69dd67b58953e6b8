"""From what holds a mechanism to the forces of its pins and sliders, body by body."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from models.array import Array
from models.joints import block_name, joined_at, joints, riding_body
from models.motion import Forces, SliderForces
from models.scene import Scene
from sim.momentum_balance import JointPushes

OnBlocks = Mapping[str, Array]
"""What acts on slider blocks without mass beside their two joints, by slider: (T, 3), a force [N]
and a torque [N m]."""


def forces_by_body(
    scene: Scene,
    pushes: JointPushes,
    on_blocks: OnBlocks,
    friction: Mapping[str, Array],
    time_s: Array,
) -> Forces:
    """The forces that ``pushes`` are, at ``time_s``; of redundant links the torque alone.

    A block without mass only passes on what it is given: its pin pushes on it as its guide and
    what else acts on it do not, and its guide takes its torque.
    """
    if pushes.spare:
        return Forces(time_s, {}, {}, pushes.torque, undetermined=UNDETERMINED, friction=friction)
    samples = len(time_s)
    pins = {
        point: {body: np.zeros((samples, 2)) for body in names}
        for point, names in joined_at(scene).items()
    }
    for hinge, force in pushes.hinges.items():
        pins[hinge.point][hinge.other] += force
        pins[hinge.point][hinge.first] -= force
    moments = dict(pushes.moments)
    for slot in joints(scene).slots:
        name, point = slot.slider.name, slot.slider.point
        block = pins[point]
        own = on_blocks.get(name, np.zeros((samples, 3)))
        passed = pushes.normals[name][:, None] * pushes.across[name] + own[:, 0:2]
        block[riding_body(slot)] += passed
        block[block_name(slot.slider)] -= passed
        moments[name] = -own[:, 2]
        if point in friction and point not in scene.sliders:  # whose second body is the block
            moments[name] = moments[name] - friction[point]
    sliders = {name: SliderForces(pushes.normals[name], moments[name]) for name in scene.sliders}
    return Forces(time_s, pins, sliders, pushes.torque, friction=friction)


UNDETERMINED = (
    "redundant links share the load by their stiffness and fit: the momentum of rigid bodies "
    "leaves the reactions open, and determines the driving torque alone"
)
