"""The reactions in all pins and sliders and the driving torque, from what MuJoCo has of them."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from models.array import Array
from models.forces import Forces, SliderForces
from models.joints import block_name, joined_at, local_point
from models.scene import GROUND, Scene
from models.tree import Limb, Tree
from sim.engine import BodyPose, Poses
from sim.mujoco.joint_forces import JointForces


def reactions(scene: Scene, tree: Tree, poses: Poses, found: JointForces) -> Forces:
    """The forces at the states of ``poses``, which act at the instants of their positions."""
    return _Reactions(scene, poses, found).of(tree)


class _Reactions:
    """The reactions while they are put together, joint by joint."""

    def __init__(self, scene: Scene, poses: Poses, found: JointForces) -> None:
        self._scene, self._poses, self._found = scene, poses, found
        count = len(poses.time_s)
        self._pins = {
            point: {body: np.zeros((count, 2)) for body in names}
            for point, names in joined_at(scene).items()
        }
        self._sliders: dict[str, SliderForces] = {}
        self._torque = np.full(count, np.nan)

    def of(self, tree: Tree) -> Forces:
        for limb in tree.limbs:
            if limb.slider is None:
                self._hinge(limb)
            else:
                self._slide(limb)
        for k, closure in enumerate(tree.closures):
            self._pin(closure.point, closure.bodies[1], closure.bodies[0], self._found.at_loop(k))
        sliders = {name: self._sliders[name] for name in self._scene.sliders}
        return Forces(self._poses.time_s, self._pins, sliders, self._torque)

    def _pin(self, point: str, giver: str, taker: str, force: Array) -> None:
        """A body exerts a force on another by the pin that they share."""
        self._pins[point][taker] += force
        self._pins[point][giver] -= force

    def _hinge(self, limb: Limb) -> None:
        force, _, _ = self._found.from_parent(limb)
        self._pin(limb.point, limb.parent, limb.body, force)
        if limb.body == self._scene.driver.link:
            self._torque = self._moment(limb, limb.body)

    def _slide(self, limb: Limb) -> None:
        """The guide is the parent, or else the child of what slides on it."""
        slider = limb.slider
        assert slider is not None
        rides = limb.parent == slider.on
        rider, sign = (limb.body, 1.0) if rides else (limb.parent, -1.0)
        force = sign * self._found.from_parent(limb)[0]
        across = self._theta(slider.on) + slider.direction_rad + 0.5 * np.pi
        normal = force[:, 0] * np.cos(across) + force[:, 1] * np.sin(across)
        self._sliders[slider.name] = SliderForces(normal, sign * self._moment(limb, rider))
        if slider.link is None and slider.mass_kg == 0.0:
            # Nothing is left in a block without mass: what the guide exerts goes to the pin.
            self._pin(slider.point, block_name(slider), rider, force)

    def _moment(self, limb: Limb, carrier: str) -> Array:
        """The moment of what the parent exerts on a limb, about the point of its joint."""
        force, moment, centre = self._found.from_parent(limb)
        arm = centre - self._place(carrier, limb.point)
        return np.asarray(moment + arm[:, 0] * force[:, 1] - arm[:, 1] * force[:, 0])

    def _place(self, body: str, point: str) -> Array:
        """Where a body has one of its points, (T, 2)."""
        x, y = local_point(self._scene, body, point)
        theta, origin = self._theta(body), self._origin(body)
        c, s = np.cos(theta), np.sin(theta)
        return np.stack([origin[:, 0] + c * x - s * y, origin[:, 1] + s * x + c * y], axis=-1)

    def _theta(self, body: str) -> Array:
        return np.zeros_like(self._torque) if body == GROUND else self._pose(body).theta

    def _origin(self, body: str) -> Array:
        return np.zeros((len(self._torque), 2)) if body == GROUND else self._pose(body).origin

    def _pose(self, body: str) -> BodyPose:
        bodies: Mapping[str, BodyPose] = self._poses.bodies
        return bodies[body]
