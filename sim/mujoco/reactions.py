"""Reactions in all pins and sliders and the driving torque, from MuJoCo's own forces."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import mujoco  # type: ignore[import-untyped]  # ships no stubs
import numpy as np

from models.array import Array
from models.mjcf.forces import SpringTendon, point_of_application, rubbing_freedom
from models.mjcf.tree import Limb, Tree
from models.motion import Forces, SliderForces
from models.scene import Point, Scene, Slider
from models.scene.joints import block_name, joined_at, local_point
from models.scene.loads import LineSpring, PinSpring, SlideSpring, Spring
from sim.engine import Poses, momentum_balance, ties
from sim.engine.measure import PointPath, body_paths, directions


@dataclass(frozen=True)
class JointWrench:
    """A ``force`` (T, 2) [N] and its ``moment`` (T,) [N m] about ``place`` (T, 2) [m]."""

    force: Array
    moment: Array
    place: Array

    def moment_about(self, place: Array) -> Array:
        """Return the moment about another place."""
        x, y = (self.place - place).T
        return np.asarray(self.moment + x * self.force[:, 1] - y * self.force[:, 0])

    def __neg__(self) -> JointWrench:
        return JointWrench(-self.force, -self.moment, self.place)

    def __sub__(self, other: JointWrench) -> JointWrench:
        """Subtract, about the place of the first."""
        moment = self.moment - other.moment_about(self.place)
        return JointWrench(self.force - other.force, moment, self.place)


PROBE = """<mujoco>
  <worldbody>
    <site name="still" pos="0 1 0"/>
    <body>
      <joint axis="0 0 1"/>
      <inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>
      <site name="moving" pos="1 0 0"/>
    </body>
  </worldbody>
  <tendon>
    <spatial stiffness="1" springlength="0">
      <site site="still"/>
      <site site="moving"/>
    </spatial>
  </tendon>
</mujoco>"""


@lru_cache
def springs_between_points_are_outside() -> bool:
    """True if springs of spatial tendons count as external forces, as in 4.0.0, and not as joint
    forces, like springs of fixed tendons; tested in the installed MuJoCo."""
    model = mujoco.MjModel.from_xml_string(PROBE)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    mujoco.mj_rnePostConstraint(model, data)
    return bool(data.cfrc_ext[1].any())


class Rows(list[Array]):
    """Numbers of many things at recorded states, a row a state."""

    def column(self, k: int) -> Array:
        """Return the numbers of one thing over the states."""
        return np.array([row[k] for row in self])


class JointForces:
    """Forces in the joints at recorded states, one row a state.

    After `mj_forward`, `mj_rnePostConstraint` has the force of the parent on each body
    (``cfrc_int``): inertia and gravity of its whole branch of the tree, less the share of the
    loops. The crank's force is without the flywheel, which is no body. The forces at the pins that
    close the loops are the multipliers of their connects, three rows each in the frame of the
    world, the first body's first.
    """

    def __init__(
        self,
        model: Any,
        limbs: tuple[Limb, ...],
        first_load: int,
        tendons: tuple[SpringTendon, ...],
    ) -> None:
        self._bodies = np.array([model.body(limb.body).id for limb in limbs])
        self._roots = model.body_rootid[self._bodies]
        self._limbs, self._first_load = limbs, first_load
        self._senses = np.array([tendon.sense for tendon in tendons])
        self._wrenches, self._centres = Rows(), Rows()
        self.loops, self.friction, self.loads, self.pulls = Rows(), Rows(), Rows(), Rows()
        """Force of each connect on its first body, friction along each coordinate, size of each
        load, and force or torque with which each spring pulls its q back."""

    def look(self, model: Any, data: Any) -> None:
        """Record the forces of a state, after `mj_forward`."""
        mujoco.mj_rnePostConstraint(model, data)
        self._wrenches.append(data.cfrc_int[self._bodies, 2:5])
        self._centres.append(data.subtree_com[self._roots, :2])
        loops = np.zeros((model.neq, 3))
        # Equalities come first among the rows of constraints; an inactive one has none. Friction
        # follows them, a row for each joint that has some.
        loops[data.efc_id[: data.ne : 3]] = data.efc_force[: data.ne].reshape(-1, 3)
        self.loops.append(loops[:, :2])
        friction = np.zeros(model.nv)
        rubbing = slice(data.ne, data.ne + data.nf)
        friction[data.efc_id[rubbing]] = data.efc_force[rubbing]
        self.friction.append(friction)
        self.loads.append(data.ctrl[self._first_load :].copy())
        longer = data.ten_length - model.tendon_lengthspring[:, 0]
        pulls = model.tendon_stiffness * longer + model.tendon_damping * data.ten_velocity
        self.pulls.append(self._senses * pulls)

    def from_parent(self, limb: Limb) -> JointWrench:
        """Return the wrench of the parent on a limb, about the place where MuJoCo has it: the
        centre of mass of the limb's tree."""
        k = self._limbs.index(limb)
        given = self._wrenches.column(k)
        return JointWrench(given[:, 1:], given[:, 0], self._centres.column(k))


class TreeReactions:
    """Builder of the reactions, joint by joint."""

    def __init__(self, scene: Scene, tree: Tree, poses: Poses, joint_forces: JointForces) -> None:
        self._scene, self._tree, self._joint_forces = scene, tree, joint_forces
        self._time_s, self._paths = poses.time_s, body_paths(poses)
        count = len(poses.time_s)
        self._pins = momentum_balance.PinForces(scene, count)
        self._sliders: dict[str, SliderForces] = {}
        self._torque = np.full(count, np.nan)
        self._loads = [self._load(k) for k in range(len(scene.loads))]
        self._springs = [
            end
            for k, spring in enumerate(scene.springs.values())
            if not (isinstance(spring, LineSpring) and springs_between_points_are_outside())
            for end in self._ends(spring, joint_forces.pulls.column(k))
        ]

    def forces(self) -> Forces:
        """Return the forces at the states of the poses; they act at the positions' instants."""
        for limb in self._tree.limbs:
            if limb.slider is None:
                self._hinge(limb)
            else:
                self._slide(limb, limb.slider)
        for k, closure in enumerate(self._tree.closures):
            taker, giver = closure.bodies
            self._pins.add(closure.point, giver, taker, self._joint_forces.loops.column(k))
        sliders = {name: self._sliders[name] for name in self._scene.sliders}
        friction = self._friction()
        self._torque = self._torque - self._of_driven_joint(friction)
        return Forces(self._time_s, self._pins, sliders, self._torque, friction=friction)

    def _friction(self) -> dict[str, Array]:
        """Return the friction: in pins the couple of the first body on the second, in sliders the
        force of the guide along the line."""
        found = {}
        freedoms = [(limb, freedom) for limb in self._tree.limbs for freedom in limb.freedoms]
        for one in self._scene.friction.values():
            for k, (limb, freedom) in enumerate(freedoms):
                if rubbing_freedom(self._scene, limb, one.joint) is freedom:
                    sign = self._sense(limb, one.joint) if freedom.kind == "hinge" else 1.0
                    found[one.joint] = sign * self._joint_forces.friction.column(k)
        return found

    def _of_driven_joint(self, friction: Mapping[str, Array]) -> Array | float:
        """Return the friction on the driver in its joint, which MuJoCo adds to the drive."""
        driver, pivot = self._scene.driver, self._scene.driver_pivot
        if driver.slider is not None:
            return friction.get(driver.slider, 0.0)
        if pivot not in friction or pivot in self._scene.sliders:
            return 0.0
        on_second = driver.link == joined_at(self._scene)[pivot][1]
        return friction[pivot] if on_second else -friction[pivot]

    def _sense(self, limb: Limb, point: str) -> float:
        """Return 1 if the limb turns with the second body of a pin, -1 with the first."""
        turning = limb.body
        slider = limb.slider
        if slider is not None and slider.on == limb.body:  # a block turns with its guide
            turning = block_name(slider)
        return 1.0 if joined_at(self._scene)[point][1] == turning else -1.0

    def _hinge(self, limb: Limb) -> None:
        given = self._from_parent(limb)
        self._pins.add(limb.point, limb.parent, limb.body, given.force)
        if self._is_driven(limb):
            torque = given.moment_about(self._point(limb.body, limb.point))
            self._torque = torque if limb.body == self._scene.driver.link else -torque

    def _is_driven(self, limb: Limb) -> bool:
        """True if the pin between a limb and its parent is driven."""
        driver = self._scene.driver
        if driver.is_crank:
            return limb.body == driver.link
        return limb.point == driver.pin and {limb.body, limb.parent} == {driver.base, driver.link}

    def _slide(self, limb: Limb, slider: Slider) -> None:
        """Compute a slider; its guide is the parent of the sliding body, or else its child."""
        rides = limb.parent == slider.on
        rider = limb.body if rides else limb.parent
        given = self._from_parent(limb) if rides else -self._from_parent(limb)
        moment = given.moment_about(self._point(rider, slider.point))
        if slider.link is None and slider.mass_kg == 0.0:
            moment = moment + self._block(slider, rider, given.force)
        line = self._theta(slider.on) + slider.direction_rad
        normal = (given.force * directions(line + 0.5 * np.pi)).sum(axis=1)
        self._sliders[slider.name] = SliderForces(normal, moment)
        if slider.name == self._scene.driver.slider:
            self._torque = (given.force * directions(line)).sum(axis=1)

    def _block(self, slider: Slider, rider: str, force: Array) -> Array:
        """Pass on the forces on a block without mass, which add up to nothing: the forces of its
        guide, loads and springs along its line go to the pin. Return the moment that its guide
        takes from loads."""
        block = block_name(slider)
        self._pins.add(slider.point, block, rider, force)
        for k, spring in enumerate(self._scene.springs.values()):
            if isinstance(spring, SlideSpring) and spring.slider == slider.name:
                pull = self._joint_forces.pulls.column(k)[:, None] * self._along(slider)
                self._pins.add(slider.point, block, rider, -pull)
        moment = np.zeros_like(self._torque)
        for (body, load), spec in zip(self._loads, self._scene.loads.values(), strict=True):
            if spec.body == block and spec.point is None:
                moment -= load.moment
            elif spec.body == block:
                self._pins.add(slider.point, block, body, load.force)
        return moment

    def _from_parent(self, limb: Limb) -> JointWrench:
        """Return the wrench of the parent on a limb: MuJoCo's, less the loads and springs on the
        limb's branch of the tree, which MuJoCo counts as joint forces."""
        given = self._joint_forces.from_parent(limb)
        hanging = {limb.body}
        for other in self._tree.limbs:  # parents before children
            if other.parent in hanging:
                hanging.add(other.body)
        for body, acting in (*self._loads, *self._springs):
            if body in hanging:
                given = given - acting
        return given

    def _load(self, k: int) -> tuple[str, JointWrench]:
        """Return the body of a load in MuJoCo, and its wrench there."""
        load = list(self._scene.loads.values())[k]
        size, at = self._joint_forces.loads.column(k), point_of_application(self._scene, load)
        place = self._place(at.body, at.place)
        if load.point is None:
            return at.body, JointWrench(np.zeros_like(place), size, place)
        angle = at.direction_rad + (self._theta(at.body) if at.turns else np.zeros_like(size))
        force = size[:, None] * directions(angle)
        return at.body, JointWrench(force, np.zeros_like(size), place)

    def _ends(self, spring: Spring, pull: Array) -> list[tuple[str, JointWrench]]:
        """Return the two bodies of a spring, and its wrench on each."""
        if isinstance(spring, PinSpring):
            first, second = spring.bodies
            place = self._point(second, spring.point)
            couple = JointWrench(np.zeros_like(place), -pull, place)
            return [(first, -couple), (second, couple)]
        (first, a), (second, b) = ties.spring_ends(self._scene, spring)
        end = self._place(second, b)
        if isinstance(spring, LineSpring):
            start = self._place(first, a)
            way = end - start
            length = np.hypot(*way.T)[:, None]
            axis = np.divide(way, length, out=np.zeros_like(way), where=length > 0.0)
        else:
            start, axis = end, self._along(self._scene.sliders[spring.slider])
        force, none = pull[:, None] * axis, np.zeros_like(pull)
        return [(first, JointWrench(force, none, start)), (second, JointWrench(-force, none, end))]

    def _along(self, slider: Slider) -> Array:
        """Return the direction of the line of a slider, (T, 2)."""
        return directions(self._theta(slider.on) + slider.direction_rad)

    def _point(self, body: str, point: str) -> Array:
        return self._place(body, local_point(self._scene, body, point))

    def _place(self, body: str, local: Point) -> Array:
        """Return the position of a place of a body's frame, (T, 2)."""
        return PointPath(self._paths[body], local).position

    def _theta(self, body: str) -> Array:
        return self._paths[body].pose.theta
