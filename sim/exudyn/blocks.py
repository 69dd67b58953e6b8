"""What acts on slider blocks without mass, which exudyn has no body for: read off the motion.

Nothing is left in such a block: what its guide, its loads, springs and friction give it goes to its
pin.
"""

from __future__ import annotations

import numpy as np

from models.array import Array
from models.joints import block_name, joined_at, sliding_angle
from models.loads import ConstantFriction, Load, SlideSpring
from models.scene import GROUND, Scene, Slider
from sim.engine import Poses
from sim.exudyn.friction import against, still_rad_s
from sim.measure import motion


class BlockLoads:
    """Forces (T, 2) [N] and torques (T,) [N m] on blocks without mass, their guides' apart."""

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
                total += self._magnitude(load)[:, None] * unit(angle)
        for friction in self._rubbing(slider.name):
            still = still_rad_s(self._scene) * self._scene.longest_m
            speed = self._motion.sliders[slider.name].speed
            total += against(friction.size, speed, still)[:, None] * unit(line)
        for spring in self._scene.springs.values():
            if isinstance(spring, SlideSpring) and spring.slider == slider.name:
                slid = self._motion.sliders[slider.name]
                pull = spring.rate * (slid.displacement - spring.free)
                total -= (pull + spring.damping * slid.speed)[:, None] * unit(line)
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


def unit(angle_rad: Array) -> Array:
    """Unit vectors (T, 2)."""
    return np.stack([np.cos(angle_rad), np.sin(angle_rad)], axis=-1)
