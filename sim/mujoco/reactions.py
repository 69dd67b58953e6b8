"""Reactions in all pins and sliders and the driving torque, from MuJoCo's own forces."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, NamedTuple

import mujoco  # type: ignore[import-untyped]  # ships no stubs
import numpy as np

from models.array import Array
from models.mjcf.forces import SpringTendon, point_of_application
from models.mjcf.tree import Limb, Tree, driven_freedom
from models.motion import Forces, SliderForces
from models.scene import Point, Scene, Slider
from models.scene.joints import block_name, local_point
from models.scene.loads import LineSpring, PinSpring, SlideSpring, Spring
from sim.engine import Poses, momentum_balance, ties
from sim.engine.measure import PointPath, body_paths, directions
from sim.engine.tree_session import rubs


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


PROBE = """<mujoco>
  <worldbody>
    <site name="still" pos="0 1 0"/>
    <body><joint/><geom size="1"/><site name="moving" pos="1 0 0"/></body>
  </worldbody>
  <tendon>
    <spatial stiffness="1" springlength="0"><site site="still"/><site site="moving"/></spatial>
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


class JointForces(NamedTuple):
    """Forces of a state; over many states, each array has their number in front.

    By body, in the order of the limbs: ``wrenches`` (B, 3), moment and force of the parent on it,
    which are inertia and gravity of its whole branch of the tree less the share of the loops,
    about ``centres`` (B, 2), the centre of mass of its tree. The crank's is without the flywheel,
    which is no body. ``loops`` (neq, 2) are the forces of the connects on their first bodies,
    ``friction`` (nv,) acts along the coordinates, ``controls`` (nu,) end with the sizes of the
    loads, ``pulls`` (tendons,) shorten the tendons; ``turning`` (nv,) are the couples of gears
    along the coordinates.
    """

    wrenches: Array
    centres: Array
    loops: Array
    friction: Array
    controls: Array
    pulls: Array
    turning: Array


def joint_forces(model: Any, data: Any) -> JointForces:
    """Read the forces of a state, after `mj_forward`."""
    mujoco.mj_rnePostConstraint(model, data)
    loops, friction = np.zeros((model.neq, 3)), np.zeros(model.nv)
    # Equalities come first among the rows of constraints, in the order of the file: three for each
    # connect, in the frame of the world, then one for each gear and cam; an inactive one has none.
    # Friction follows, a row for each joint that has some.
    kinds = model.eq_type[data.efc_id[: data.ne]]
    gears = np.flatnonzero(kinds != mujoco.mjtEq.mjEQ_CONNECT)
    pins = data.ne - len(gears)
    loops[data.efc_id[:pins:3]] = data.efc_force[:pins].reshape(-1, 3)
    rubbing = slice(data.ne, data.ne + data.nf)
    friction[data.efc_id[rubbing]] = data.efc_force[rubbing]
    alone, turning = np.zeros(data.nefc), np.zeros(model.nv)
    alone[gears] = data.efc_force[gears]
    if gears.size:
        mujoco.mj_mulJacTVec(model, data, turning, alone)
    longer = data.ten_length - model.tendon_lengthspring[:, 0]
    return JointForces(
        wrenches=data.cfrc_int[1:, 2:5].copy(),
        centres=data.subtree_com[model.body_rootid[1:], :2],
        loops=loops[:, :2],
        friction=friction,
        controls=data.ctrl.copy(),
        pulls=model.tendon_stiffness * longer + model.tendon_damping * data.ten_velocity,
        turning=turning,
    )


class TreeReactions:
    """Builder of the reactions, joint by joint, from the forces of the states of ``poses``."""

    def __init__(
        self,
        scene: Scene,
        tree: Tree,
        poses: Poses,
        states: Iterable[JointForces],
        tendons: Sequence[SpringTendon],
    ) -> None:
        self._scene, self._tree = scene, tree
        self._time_s, self._paths = poses.time_s, body_paths(poses)
        self._given = given = JointForces(*map(np.array, zip(*states, strict=True)))
        self._none = np.zeros((len(poses.time_s), 2))
        self._pins = momentum_balance.PinForces(scene, len(poses.time_s))
        self._pulls = [(e.spring, e.sense * given.pulls[:, k]) for k, e in enumerate(tendons)]
        self._loads = [self._load(k) for k in range(len(scene.loads))]
        outside = springs_between_points_are_outside()
        inside = [each for each in self._pulls if not (outside and isinstance(each[0], LineSpring))]
        self._acting = [*self._loads, *(end for each in inside for end in self._ends(*each))]

    def forces(self) -> Forces:
        """Return the forces at the states of the poses; they act at the positions' instants."""
        scene, limbs = self._scene, self._tree.limbs
        driven, sense = driven_freedom(scene, limbs)
        sliders, torque = dict[str, SliderForces](), np.full(len(self._time_s), np.nan)
        row = 0
        for k, limb in enumerate(limbs):
            wrench, slider = self._from_parent(k, limb), limb.slider
            if slider is None:
                self._pins.add(limb.point, limb.parent, limb.body, wrench.force)
                if limb.freedoms[0].name == driven:
                    moment = wrench.moment_about(self._place(limb.body, limb.point))
                    torque = sense * (moment - self._given.turning[:, row])
                row += 1
                continue
            sliders[slider.name], along = self._slide(limb, slider, wrench)
            row += len(limb.freedoms)
            if slider.name == scene.driver.slider:
                torque = along
        for k, closure in enumerate(self._tree.closures):
            taker, giver = closure.bodies
            self._pins.add(closure.point, giver, taker, self._given.loops[:, k])
        friction = {}
        for rub in rubs(scene, limbs):
            own = rub.sense * self._given.friction[:, rub.row]
            friction[rub.joint] = own
            # MuJoCo adds the friction on the driver in its joint to the drive.
            if rub.joint == scene.driver.slider:
                torque = torque - own
            elif rub.joint == scene.driver_pivot and rub.joint not in scene.sliders:
                torque = torque - own if rub.second == scene.driver.link else torque + own
        ordered = {name: sliders[name] for name in scene.sliders}
        return Forces(self._time_s, self._pins, ordered, torque, friction=friction)

    def _slide(self, limb: Limb, slider: Slider, wrench: JointWrench) -> tuple[SliderForces, Array]:
        """Return the forces in a slider, and the force along its line; its guide is the parent of
        the sliding body, or else its child."""
        rides = limb.parent == slider.on
        rider, sign = (limb.body, 1.0) if rides else (limb.parent, -1.0)
        force = sign * wrench.force
        moment = sign * wrench.moment_about(self._place(rider, slider.point))
        if slider.link is None and slider.mass_kg == 0.0:
            moment = moment + self._block(slider, rider, force)
        line = self._theta(slider.on) + slider.direction_rad
        normal = (force * directions(line + 0.5 * np.pi)).sum(axis=1)
        return SliderForces(normal, moment), (force * directions(line)).sum(axis=1)

    def _block(self, slider: Slider, rider: str, force: Array) -> Array:
        """Pass on the forces on a block without mass, which add up to nothing: the forces of its
        guide, loads and springs along its line go to the pin. Return the moment that its guide
        takes from loads."""
        block = block_name(slider)
        self._pins.add(slider.point, block, rider, force)
        for spring, pull in self._pulls:
            if isinstance(spring, SlideSpring) and spring.slider == slider.name:
                self._pins.add(slider.point, block, rider, -(pull[:, None] * self._along(slider)))
        moment = np.zeros_like(self._time_s)
        for (body, load), spec in zip(self._loads, self._scene.loads.values(), strict=True):
            if spec.body == block and spec.point is None:
                moment -= load.moment
            elif spec.body == block:
                self._pins.add(slider.point, block, body, load.force)
        return moment

    def _from_parent(self, k: int, limb: Limb) -> JointWrench:
        """Return the wrench of the parent on a limb: MuJoCo's, less the loads and springs on the
        limb's branch of the tree, which MuJoCo counts as joint forces."""
        place = self._given.centres[:, k]
        moment, force = self._given.wrenches[:, k, 0], self._given.wrenches[:, k, 1:]
        hanging = {limb.body}
        for other in self._tree.limbs:  # parents before children
            if other.parent in hanging:
                hanging.add(other.body)
        for body, acting in self._acting:
            if body in hanging:
                force, moment = force - acting.force, moment - acting.moment_about(place)
        return JointWrench(force, moment, place)

    def _load(self, k: int) -> tuple[str, JointWrench]:
        """Return the body of a load in MuJoCo, and its wrench there."""
        load = list(self._scene.loads.values())[k]
        size = self._given.controls[:, k - len(self._scene.loads)]
        at = point_of_application(self._scene, load)
        place = self._place(at.body, at.place)
        if load.point is None:
            return at.body, JointWrench(self._none, size, place)
        angle = at.direction_rad + (self._theta(at.body) if at.turns else self._none[:, 0])
        return at.body, JointWrench(size[:, None] * directions(angle), self._none[:, 0], place)

    def _ends(self, spring: Spring, pull: Array) -> list[tuple[str, JointWrench]]:
        """Return the two bodies of a spring, and its wrench on each."""
        (first, a), (second, b) = ties.spring_ends(self._scene, spring)
        start, end = self._place(first, a), self._place(second, b)
        if isinstance(spring, PinSpring):
            ends = JointWrench(self._none, pull, start), JointWrench(self._none, -pull, end)
            return list(zip((first, second), ends, strict=True))
        if isinstance(spring, LineSpring):
            way = end - start
            length = np.hypot(*way.T)[:, None]
            axis = np.divide(way, length, out=np.zeros_like(way), where=length > 0.0)
        else:
            start, axis = end, self._along(self._scene.sliders[spring.slider])
        force, none = pull[:, None] * axis, self._none[:, 0]
        return [(first, JointWrench(force, none, start)), (second, JointWrench(-force, none, end))]

    def _along(self, slider: Slider) -> Array:
        """Return the direction of the line of a slider, (T, 2)."""
        return directions(self._theta(slider.on) + slider.direction_rad)

    def _place(self, body: str, at: str | Point) -> Array:
        """Return the position of a named point of a body, or a place of its frame, (T, 2)."""
        local = local_point(self._scene, body, at) if isinstance(at, str) else at
        return PointPath(self._paths[body], local).position

    def _theta(self, body: str) -> Array:
        return self._paths[body].pose.theta
