"""The reactions in all pins and sliders and the driving torque, from exudyn's multipliers.

exudyn solves M q'' + C' lambda = Q at the end of each step, C' the transposed derivatives of the
constraints: of a hinge the place of its second marker less that of its first, in the ground's
frame; of a prismatic joint the guide's distance from the point that slides, and the angle of what
slides; of the drive the angle of the crank.
"""

import math

import numpy as np

from models.array import Array
from models.motion import Forces, SliderForces
from models.scene import GROUND, Scene, Slider
from models.scene.joints import Prism, block_name, joined_at, joints, riding_body, sliding_angle
from models.scene.loads import ConstantFriction, Load, SlideSpring
from sim.engine import Poses
from sim.engine.measure import directions, motion
from sim.exudyn.passive import against, still_rad_s
from sim.exudyn.solver import Multipliers
from sim.exudyn.system import PlaneSystem


class BlockLoads:
    """Forces (T, 2) [N] and torques (T,) [N m] on blocks without mass, their guides' apart: read
    off the motion, as exudyn has no body for them. Nothing is left in such a block: what its guide,
    its loads, springs and friction give it goes to its pin."""

    def __init__(self, scene: Scene, poses: Poses) -> None:
        self._scene, self._poses = scene, poses
        self._motion = motion(scene, poses)

    def theta(self, body: str) -> Array:
        """The angle of a body or the ground."""
        zero = np.zeros(len(self._poses.time_s))
        return zero if body == GROUND else self._poses.bodies[body].theta

    def force(self, slider: Slider) -> Array:
        """All forces on the block, friction and springs of its line among them."""
        line = self.theta(slider.on) + slider.direction_rad
        total = np.zeros((len(line), 2))
        for load in self._of(slider):
            if load.point is not None:
                turned = line - slider.direction_rad + sliding_angle(slider)
                angle = load.direction_rad + (turned if load.frame == "body" else 0.0 * line)
                total += self._magnitude(load)[:, None] * directions(angle)
        for friction in self._rubbing(slider.name):
            still = still_rad_s(self._scene) * self._scene.longest_m
            speed = self._motion.sliders[slider.name].speed
            total += against(friction.size, speed, still)[:, None] * directions(line)
        for spring in self._scene.springs.values():
            if isinstance(spring, SlideSpring) and spring.slider == slider.name:
                slid = self._motion.sliders[slider.name]
                pull = spring.rate * (slid.displacement - spring.free)
                total -= (pull + spring.damping * slid.speed)[:, None] * directions(line)
        return total

    def torque(self, slider: Slider) -> Array:
        """All torques on the block, friction of its pin among them."""
        total = np.zeros(len(self._poses.time_s))
        for load in self._of(slider):
            if load.point is None:
                total += self._magnitude(load)
        if slider.point not in self._scene.sliders:  # else its friction is that of a line
            for friction in self._rubbing(slider.point):
                total += self._in_pin(slider, friction)
        return total

    def _in_pin(self, slider: Slider, friction: ConstantFriction) -> Array:
        block = block_name(slider)
        (other,) = (b for b in joined_at(self._scene)[slider.point] if b != block)
        rate = self._omega(slider.on) - self._omega(other)
        return against(friction.size, rate, still_rad_s(self._scene))

    def _omega(self, body: str) -> Array:
        """The rate of a body, or of the guide of a block without mass."""
        for slider in self._scene.sliders.values():
            if body == block_name(slider) and body not in self._poses.bodies:
                body = slider.on
                break
        zero = np.zeros(len(self._poses.time_s))
        return zero if body == GROUND else self._poses.bodies[body].omega

    def _of(self, slider: Slider) -> list[Load]:
        name = block_name(slider)
        return [load for load in self._scene.loads.values() if load.body == name]

    def _rubbing(self, joint: str) -> list[ConstantFriction]:
        """What rubs in a joint."""
        return [
            friction
            for friction in self._scene.friction.values()
            if isinstance(friction, ConstantFriction) and friction.joint == joint
        ]

    def _magnitude(self, load: Load) -> Array:
        x = {"time": self._poses.time_s, "angle": self.theta(self._scene.driver.link)}
        if load.over == "omega":
            return load.magnitude(self._poses.bodies[load.body].omega)
        slid = self._motion.sliders.get(load.slider or "")
        if slid is None:
            return load.magnitude(x[load.over])
        x |= {"displacement": slid.displacement, "speed": slid.speed}
        return load.magnitude(x[load.over], slid.speed)


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
        across = directions(blocks.theta(slider.on) + slider.direction_rad + 0.5 * math.pi)
        force = normal[:, None] * across + blocks.force(slider)
        pins[slider.point][riding_body(slide)] += force
        pins[slider.point][block_name(slider)] -= force
        sliders[slider.name] = SliderForces(normal, -blocks.torque(slider))
    in_order = {name: sliders[name] for name in scene.sliders}
    return Forces(poses.time_s, pins, in_order, torque)
