"""The reactions in all pins and sliders and the driving torque, from exudyn's multipliers.

exudyn solves M q'' + C' lambda = Q at the end of each step, C' the transposed derivatives of the
constraints: of a hinge the place of its second marker less that of its first, in the ground's
frame; of a prismatic joint the guide's distance from the point that slides, and the angle of what
slides; of the drive the angle of the crank.
"""

from __future__ import annotations

import math

import numpy as np

from models.array import Array
from models.joints import Prism, block_name, joined_at, joints, riding_body
from models.motion import Forces, SliderForces
from models.scene import Scene
from sim.engine import Poses
from sim.exudyn.blocks import BlockLoads, unit
from sim.exudyn.plane_system import PlaneSystem
from sim.exudyn.step_multipliers import Multipliers


def reactions(
    scene: Scene,
    made: PlaneSystem,
    multipliers: Multipliers,
    lambdas: Array,
    poses: Poses,
    torque: Array,
) -> Forces:
    """The forces at the states of ``poses``, of the multipliers there, a row each."""
    count = len(poses.time_s)
    pins = {
        point: {body: np.zeros((count, 2)) for body in names}
        for point, names in joined_at(scene).items()
    }
    for point, hinges in made.hinge.items():
        for (first, second), joint in hinges.items():
            force = lambdas[:, multipliers.rows(joint)]
            pins[point][first] += force
            pins[point][second] -= force
    sliders = {}
    for slide in joints(scene).slides:
        slider = slide.slider
        normal, moment = lambdas[:, multipliers.rows(made.prismatic[slider.name])].T
        if isinstance(slide, Prism):
            sliders[slider.name] = SliderForces(normal, -moment)
            continue
        blocks = BlockLoads(scene, poses)
        across = unit(blocks.theta(slider.on) + slider.direction_rad + 0.5 * math.pi)
        force = normal[:, None] * across + blocks.force(slider)
        pins[slider.point][riding_body(slide)] += force
        pins[slider.point][block_name(slider)] -= force
        sliders[slider.name] = SliderForces(normal, -blocks.torque(slider))
    in_order = {name: sliders[name] for name in scene.sliders}
    return Forces(poses.time_s, pins, in_order, torque)
