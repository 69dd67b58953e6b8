"""From what holds a mechanism to the forces of its pins and sliders, body by body."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from models.array import Array
from models.forces import Forces, SliderForces
from models.joints import block_name, joints, riding_body
from models.scene import Scene
from sim.momentum_balance import JointPushes

OnBlocks = Mapping[str, Array]
"""What acts on slider blocks without mass beside their two joints, by slider: (T, 3), a force [N]
and a torque [N m]."""


def joint_forces(scene: Scene, pushes: JointPushes, on_blocks: OnBlocks, time_s: Array) -> Forces:
    """The forces that ``pushes`` are, at ``time_s``; of redundant links the torque alone.

    A block without mass only passes on what it is given: its pin pushes on it as its guide and
    what else acts on it do not, and its guide takes its torque.
    """
    if pushes.spare:
        return Forces(time_s, {}, {}, pushes.torque, undetermined=UNDETERMINED)
    samples = len(time_s)
    pins = {
        point: {body: np.zeros((samples, 2)) for body in names}
        for point, names in _pins(scene).items()
    }
    for hinge, force in pushes.hinges.items():
        pins[hinge.point][hinge.other] += force
        pins[hinge.point][hinge.first] -= force
    moments = dict(pushes.moments)
    for slot in joints(scene).slots:
        name, block = slot.slider.name, pins[slot.slider.point]
        own = on_blocks.get(name, np.zeros((samples, 3)))
        passed = pushes.normals[name][:, None] * pushes.across[name] + own[:, 0:2]
        block[riding_body(slot)] += passed
        block[block_name(slot.slider)] -= passed
        moments[name] = -own[:, 2]
    sliders = {name: SliderForces(pushes.normals[name], moments[name]) for name in scene.sliders}
    return Forces(time_s, pins, sliders, pushes.torque)


UNDETERMINED = (
    "redundant links share the load by their stiffness and fit: the momentum of rigid bodies "
    "leaves the reactions open, and determines the driving torque alone"
)


def _pins(scene: Scene) -> dict[str, tuple[str, ...]]:
    """The points that join at least two bodies, ground first, then links, then slider blocks with
    mass or without."""
    names = {point: list(bodies) for point, bodies in scene.pins.items()}
    for slider in scene.sliders.values():
        if slider.link is None:
            names.setdefault(slider.point, []).append(block_name(slider))
    return {point: tuple(bodies) for point, bodies in names.items() if len(bodies) > 1}
