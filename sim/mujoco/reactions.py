"""The reactions in all pins and sliders and the driving torque, from what MuJoCo has of them."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from models.array import Array
from models.joints import block_name, joined_at, joints, line_ends, local_point, riding_body
from models.loads import LineSpring, PinSpring, SlideSpring, Spring
from models.mjcf.forces import point_of_application, rubbing_freedom
from models.motion import Forces, SliderForces
from models.scene import GROUND, Point, Scene, Slider
from models.tree import Limb, Tree
from sim.engine import Poses
from sim.mujoco.joint_forces import JointForces
from sim.mujoco.outside_forces import springs_between_points_are_outside
from sim.mujoco.wrench import Wrench


def reactions(scene: Scene, tree: Tree, poses: Poses, joint_forces: JointForces) -> Forces:
    """The forces at the states of ``poses``, which act at the instants of their positions."""
    return _Reactions(scene, tree, poses, joint_forces).forces()


class _Reactions:
    """The reactions while they are put together, joint by joint."""

    def __init__(self, scene: Scene, tree: Tree, poses: Poses, joint_forces: JointForces) -> None:
        self._scene, self._tree, self._poses, self._joint_forces = scene, tree, poses, joint_forces
        count = len(poses.time_s)
        self._pins = {
            point: {body: np.zeros((count, 2)) for body in names}
            for point, names in joined_at(scene).items()
        }
        self._sliders: dict[str, SliderForces] = {}
        self._torque = np.full(count, np.nan)
        self._loads = [self._load(k) for k in range(len(scene.loads))]
        self._springs = [
            end
            for k, spring in enumerate(scene.springs.values())
            if not (isinstance(spring, LineSpring) and springs_between_points_are_outside())
            for end in self._ends(spring, joint_forces.of_spring(k))
        ]

    def forces(self) -> Forces:
        for limb in self._tree.limbs:
            if limb.slider is None:
                self._hinge(limb)
            else:
                self._slide(limb, limb.slider)
        for k, closure in enumerate(self._tree.closures):
            taker, giver = closure.bodies
            self._pin(closure.point, giver, taker, self._joint_forces.at_loop(k))
        sliders = {name: self._sliders[name] for name in self._scene.sliders}
        friction = self._friction()
        self._torque = self._torque - self._of_driven_joint(friction)
        time_s = self._poses.time_s
        return Forces(time_s, self._pins, sliders, self._torque, friction=friction)

    def _friction(self) -> dict[str, Array]:
        """What rubs: in pins the couple of the first body on the second, in sliders the force of
        the guide along the line."""
        found = {}
        freedoms = [(limb, freedom) for limb in self._tree.limbs for freedom in limb.freedoms]
        for one in self._scene.friction.values():
            for k, (limb, freedom) in enumerate(freedoms):
                if rubbing_freedom(self._scene, limb, one.joint) is freedom:
                    sign = self._sense(limb, one.joint) if freedom.kind == "hinge" else 1.0
                    found[one.joint] = sign * self._joint_forces.of_friction(k)
        return found

    def _of_driven_joint(self, friction: Mapping[str, Array]) -> Array | float:
        """What rubs in the driven joint, on the driver: it is given that and the drive together."""
        driver, pivot = self._scene.driver, self._scene.driver_pivot
        if driver.slider is not None:
            return friction.get(driver.slider, 0.0)
        if pivot not in friction or pivot in self._scene.sliders:
            return 0.0
        on_second = driver.link == joined_at(self._scene)[pivot][1]
        return friction[pivot] if on_second else -friction[pivot]

    def _sense(self, limb: Limb, point: str) -> float:
        """1 where the limb turns with the second body of a pin, -1 where with the first."""
        turning = limb.body
        slider = limb.slider
        if slider is not None and slider.on == limb.body:  # a block turns with its guide
            turning = block_name(slider)
        return 1.0 if joined_at(self._scene)[point][1] == turning else -1.0

    def _pin(self, point: str, giver: str, taker: str, force: Array) -> None:
        """A body exerts a force on another by the pin that they share."""
        self._pins[point][taker] += force
        self._pins[point][giver] -= force

    def _hinge(self, limb: Limb) -> None:
        given = self._from_parent(limb)
        self._pin(limb.point, limb.parent, limb.body, given.force)
        if self._is_driven(limb):
            torque = given.moment_about(self._point(limb.body, limb.point))
            self._torque = torque if limb.body == self._scene.driver.link else -torque

    def _is_driven(self, limb: Limb) -> bool:
        """Whether the pin between a limb and its parent is the driven one."""
        driver = self._scene.driver
        if driver.is_crank:
            return limb.body == driver.link
        return limb.point == driver.pin and {limb.body, limb.parent} == {driver.base, driver.link}

    def _slide(self, limb: Limb, slider: Slider) -> None:
        """The guide is the parent of what slides on it, or else its child."""
        rides = limb.parent == slider.on
        rider = limb.body if rides else limb.parent
        given = self._from_parent(limb) if rides else -self._from_parent(limb)
        moment = given.moment_about(self._point(rider, slider.point))
        if slider.link is None and slider.mass_kg == 0.0:
            moment = moment + self._block(slider, rider, given.force)
        across = self._theta(slider.on) + slider.direction_rad + 0.5 * np.pi
        normal = given.force[:, 0] * np.cos(across) + given.force[:, 1] * np.sin(across)
        self._sliders[slider.name] = SliderForces(normal, moment)
        if slider.name == self._scene.driver.slider:
            along = self._theta(slider.on) + slider.direction_rad
            self._torque = given.force[:, 0] * np.cos(along) + given.force[:, 1] * np.sin(along)

    def _block(self, slider: Slider, rider: str, force: Array) -> Array:
        """Hand on what acts on a block without mass, in which nothing is left: what its guide, the
        loads and springs along its line exert goes to the pin. Gives the moment that its guide
        takes from loads."""
        block = block_name(slider)
        self._pin(slider.point, block, rider, force)
        for k, spring in enumerate(self._scene.springs.values()):
            if isinstance(spring, SlideSpring) and spring.slider == slider.name:
                pull = self._joint_forces.of_spring(k)[:, None] * self._along(slider)
                self._pin(slider.point, block, rider, -pull)
        moment = np.zeros_like(self._torque)
        for (body, load), spec in zip(self._loads, self._scene.loads.values(), strict=True):
            if spec.body == block and spec.point is None:
                moment -= load.moment
            elif spec.body == block:
                self._pin(slider.point, block, body, load.force)
        return moment

    def _from_parent(self, limb: Limb) -> Wrench:
        """What the parent exerts on a limb: what MuJoCo has, less the loads and springs on all that
        hangs on the limb, which it takes to come through the joint."""
        given = self._joint_forces.from_parent(limb)
        hanging = {limb.body}
        for other in self._tree.limbs:  # parents before children
            if other.parent in hanging:
                hanging.add(other.body)
        for body, acting in (*self._loads, *self._springs):
            if body in hanging:
                given = given - acting
        return given

    def _load(self, k: int) -> tuple[str, Wrench]:
        """The body on which a load acts in MuJoCo, and what it exerts there."""
        load = list(self._scene.loads.values())[k]
        size, at = self._joint_forces.of_load(k), point_of_application(self._scene, load)
        place = self._place(at.body, at.place)
        if load.point is None:
            return at.body, Wrench(np.zeros_like(place), size, place)
        angle = at.direction_rad + (self._theta(at.body) if at.turns else np.zeros_like(size))
        force = size[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=-1)
        return at.body, Wrench(force, np.zeros_like(size), place)

    def _ends(self, spring: Spring, pull: Array) -> list[tuple[str, Wrench]]:
        """The two bodies that a spring is between, and what it exerts on each."""
        if isinstance(spring, PinSpring):
            first, second = spring.bodies
            place = self._point(second, spring.point)
            couple = Wrench(np.zeros_like(place), -pull, place)
            return [(first, -couple), (second, couple)]
        if isinstance(spring, LineSpring):
            (first, a), (second, b) = line_ends(self._scene, spring)
            start, end = self._place(first, a), self._place(second, b)
            way = end - start
            length = np.hypot(*way.T)[:, None]
            axis = np.divide(way, length, out=np.zeros_like(way), where=length > 0.0)
        else:
            slide = next(s for s in joints(self._scene).slides if s.slider.name == spring.slider)
            first, second = slide.slider.on, riding_body(slide)
            start = end = self._point(second, slide.slider.point)
            axis = self._along(slide.slider)
        force, none = pull[:, None] * axis, np.zeros_like(pull)
        return [(first, Wrench(force, none, start)), (second, Wrench(-force, none, end))]

    def _along(self, slider: Slider) -> Array:
        """The direction of the line of a slider, (T, 2)."""
        angle = self._theta(slider.on) + slider.direction_rad
        return np.stack([np.cos(angle), np.sin(angle)], axis=-1)

    def _point(self, body: str, point: str) -> Array:
        return self._place(body, local_point(self._scene, body, point))

    def _place(self, body: str, local: Point) -> Array:
        """Where a body has a place of its frame, (T, 2)."""
        theta = self._theta(body)
        c, s = np.cos(theta), np.sin(theta)
        x, y = local
        arm = np.stack([c * x - s * y, s * x + c * y], axis=-1)
        return arm if body == GROUND else arm + self._poses.bodies[body].origin

    def _theta(self, body: str) -> Array:
        return np.zeros_like(self._torque) if body == GROUND else self._poses.bodies[body].theta
