"""A user's own model in MuJoCo, unchanged: only the driven hinge gets a flywheel; and
contacts and limits that it meets on its way round.

The flywheel is an armature set at run time, so that it changes nothing that MuJoCo computes when it
compiles, above all not the softness of the loops; the tolerance of the solver is divided by its
ratio, as MuJoCo's stopping rule depends on it (and not on ``stat.meaninertia``).
"""

import copy
import math
from collections.abc import Mapping, Sequence
from typing import Any

import mujoco  # type: ignore[import-untyped]  # ships no stubs
import numpy as np

from models.array import Array
from models.errors import EngineError
from models.mjcf.tree import Limb
from models.motion import State
from models.scene import Scene
from models.scene.joints import bodies
from sim.engine import BodyPose, Drive, Facts, Log, Settings
from sim.engine.tree_poses import body_poses
from sim.mujoco.own_model.driven_loop import is_hinge, joint_name, rigid
from sim.mujoco.own_model.file import ModelError, body_name, name_of
from sim.mujoco.own_model.linkage import size
from sim.mujoco.own_model.planar_model import PlanarModel, coordinates
from sim.mujoco.own_model.variants import applied, held
from sim.mujoco.settings import INTEGRATORS
from sim.mujoco.stepped import VERSION, Look, SteppedModel, heard
from sim.registry.own_models import Tour

FLYWHEEL_RATIO = 1e15
"""Inertia of the flywheel over the largest of the linkage. Measured, with the mean inertia in its
place, on a rod driven 119 deg past a limit: from 1e10 to 1e16 no error of a link changes in its
third digit, and the crank is off by 7.7e-5 rad after twenty turns at 1e10, and by 7.7e-10 at
1e15."""

LOST_RAD = 1e-4
"""Largest error of a driven joint; with more it is not driven. Damping of 5e3 N s/m, a spring of
1e7 N/m and an armature of 1e6 kg m^2 on other joints leave it within 1e-12 rad over two turns, even
while they diverge."""


class OwnModelSession(SteppedModel):
    """A session of the model, from a state of its scene."""

    def __init__(
        self,
        own: PlanarModel,
        scene: Scene,
        state: State,
        settings: Settings,
        dt_s: float,
        drive: Drive,
    ) -> None:
        model = copy.copy(own.model)
        applied(model, own.loops, settings, dt_s)
        super().__init__(
            state.time_s, dt_s, 0.0 if INTEGRATORS[int(model.opt.integrator)] == "RK4" else -0.5
        )
        self._own, self._scene = own, scene
        self._settings = held(model, own.loops, settings)
        loop = own.linkage.component
        _give_flywheel(model, [int(model.jnt_dofadr[own.driven]), *loop.held], own.inertia_kg_m2)
        model.eq_active0[list(loop.idle)] = 0
        self._hold(model, own.keyframe)
        self._limbs: tuple[Limb, ...] = own.limbs.limbs
        self._place(scene, state)
        self._forward()

    def _place(self, scene: Scene, state: State) -> None:
        """Set all joints from the closed form, with velocities at the integrator's instant."""
        q, rate, push = self._own.start(scene, state)
        rate = rate + self._shift * self._dt * push
        self._own.put(self._data, q, rate)
        crank = int(self._model.jnt_dofadr[self._own.driven])
        self._data.qvel[crank] = float(scene.driver.law.at(np.array([state.time_s]))[1][0])
        loop = self._own.linkage.component
        self._data.qvel[list(loop.held)] = 0.0
        if loop.follows:
            own = np.isin(self._model.dof_bodyid, loop.ids)
            _let_follow(self._model, self._data, {*np.flatnonzero(own), *loop.held})

    def record(self, steps: int, every: int, look: Look | None = None) -> Log:
        """Advance and log. Raises EngineError where the driven joint has left its course."""
        log = super().record(steps, every, look)
        if log.diverged:
            return log
        turned = log.poses.bodies[self._scene.driver.link].theta
        wanted = self._scene.driver.law.at(log.poses.time_s)[0]
        off = np.max(np.abs((turned - turned[0]) - (wanted - wanted[0])))
        if off > LOST_RAD:
            raise EngineError(
                f"the driven joint is off by {off:.3g} rad in spite of its flywheel, so the "
                "line shows nothing of the loops; remove the loads of that joint (damping, "
                "friction), or report it if there are none"
            )
        return log

    def facts(self) -> Facts:
        """Read the model as MuJoCo holds it now."""
        matter = {name: self._own.matter(name) for name in bodies(self._scene)}
        return Facts(
            version=VERSION,
            mass_kg={name: each.mass_kg for name, each in matter.items()},
            inertia_kg_m2={name: each.inertia_kg_m2 for name, each in matter.items()},
            centre_m={},
            gravity_m_s2=self._scene.gravity_m_s2,
            start=self.read(),
            settings=self._settings,
            velocity_shift=self._shift,
            acceleration_shift=0.0,
        )

    def _placed(self, q: Array, rate: Array, push: Array, lag_s: float) -> Mapping[str, BodyPose]:
        poses = body_poses(self._limbs, *self._own.seen(q, rate, push), lag_s)
        return {name: poses[limb] for name, limb in self._own.limbs.shown.items()}


FOLLOWING = 20
"""Steps of Newton's method within which what hangs on a loop follows it."""


def _let_follow(model: Any, data: Any, loop: set[int]) -> None:
    """Set the freedoms beside those of the loop so that every equality holds, in place and speed,
    as near as they can."""
    dense = copy.copy(model)
    dense.opt.jacobian = mujoco.mjtJacobian.mjJAC_DENSE.value
    others = [dof for dof in range(model.nv) if dof not in loop]
    for last in (*[False] * FOLLOWING, True):
        mujoco.mj_fwdPosition(dense, data)
        mine = np.array(data.efc_type) == EQUALITY
        rows = np.reshape(data.efc_J, (-1, model.nv))[mine]
        free = [dof for dof in others if np.any(rows[:, dof])]
        off = rows @ data.qvel if last else np.array(data.efc_pos)[mine]
        step = np.zeros(model.nv)
        step[free] = -np.linalg.lstsq(rows[:, free], off, rcond=None)[0]
        if last:
            data.qvel += step
        else:
            mujoco.mj_integratePos(dense, data.qpos, step, 1.0)


def _give_flywheel(model: Any, freedoms: Sequence[int], inertia_kg_m2: float) -> None:
    """Let freedoms keep their rates, in a linkage of at most this inertia."""
    flywheel = FLYWHEEL_RATIO * inertia_kg_m2
    model.dof_armature[freedoms] += flywheel
    # Of a leaf body whose centre of mass is on its hinge MuJoCo takes the inertia from here.
    model.dof_M0[freedoms] += flywheel
    model.opt.tolerance /= FLYWHEEL_RATIO


MISREAD = 1e-6
"""Largest loop gap in MuJoCo, over the size of the linkage; with more the model was misread."""
EQUALITY = mujoco.mjtConstraint.mjCNSTR_EQUALITY.value


def tour(own: PlanarModel, scene: Scene, states: Sequence[State]) -> Tour:
    """Put the model into each of the states, and record MuJoCo's contacts and limits.

    Raises
    ------
    ModelError
        MuJoCo sees a loop open that is closed in the closed form: the model was misread.
    """
    model, data = own.model, mujoco.MjData(own.model)
    if own.linkage.component.held:
        data.qpos[:] = own.qpos
    touching: dict[tuple[str, str], int] = {}
    low, high = np.full(model.nq, np.inf), np.full(model.nq, -np.inf)
    q = own.start(scene, states[0])[0]
    with heard(lambda _: None):
        for state in states:
            q = coordinates(own.limbs, scene, state, near=q)[0]
            own.put(data, q, np.zeros(len(q)))
            mujoco.mj_fwdPosition(model, data)
            _refuse_misread(own, data, state)
            low, high = np.fmin(low, data.qpos), np.fmax(high, data.qpos)
            for pair in _touching(own, data):
                touching[pair] = touching.get(pair, 0) + 1
    shares = {pair: count / len(states) for pair, count in touching.items()}
    most_first = sorted(shares.items(), key=lambda item: (-item[1], item[0]))
    return Tour(dict(most_first), _passed(own, low, high))


def _refuse_misread(own: PlanarModel, data: Any, state: State) -> None:
    """Compare with MuJoCo's own residual of each loop, in the plane."""
    plane, limit = own.linkage.component.plane, MISREAD * size(own.linkage)
    rows = np.flatnonzero(np.array(data.efc_type) == EQUALITY)
    for closure in own.linkage.component.closures:
        mine = [row for row in rows if int(data.efc_id[row]) == closure.index][:3]
        if not mine:  # MuJoCo leaves out idle ones, such as a pin in the axis of a hinge
            continue
        gap = abs(plane.flat(np.array([data.efc_pos[row] for row in mine])))
        if not gap <= limit:
            raise ModelError(
                f"loop {closure.name}: closed in the closed form at t = {state.time_s:.4g} s, and "
                f"open by {gap:.3g} m as MuJoCo sees it: the model was misread; please report it"
            )


def _touching(own: PlanarModel, data: Any) -> set[tuple[str, str]]:
    """Return the pairs of geoms that push one another, one of them on the linkage: a body beside it
    may rest on its floor."""
    model, pairs = own.model, set()
    moving = {body.id for body in own.linkage.component.bodies}
    for index in range(int(data.ncon)):
        contact = data.contact[index]
        bodies = {rigid(model, int(model.geom_bodyid[g])) for g in contact.geom if g >= 0}
        pushes = int(contact.exclude) == 0 and int(contact.efc_address) >= 0
        if pushes and not moving.isdisjoint(bodies):
            first, second = sorted(_geom(model, int(geom)) for geom in contact.geom)
            pairs.add((first, second))
    return pairs


def _geom(model: Any, geom: int) -> str:
    if geom < 0:
        return "a flex"
    name = name_of(model, "geom", geom)
    return name or f"a geom of {body_name(model, int(model.geom_bodyid[geom]))}"


ROUNDING = 1e-9
"""Distance beyond a limit [rad], or over the size of the linkage, that is rounding."""


def _passed(own: PlanarModel, low: Any, high: Any) -> list[str]:
    model, texts = own.model, []
    for joint in (each.index for each in own.limbs.joints if model.jnt_limited[each.index]):
        at = int(model.jnt_qposadr[joint])
        least, most = (float(end) for end in model.jnt_range[joint])
        past = max(least - float(low[at]), float(high[at]) - most)
        turns = is_hinge(model, joint)
        if past > ROUNDING * (1.0 if turns else size(own.linkage)):
            far = f"{math.degrees(past):.3g} deg" if turns else f"{past:.3g} m"
            texts.append(f"joint {joint_name(model, joint)} is led past its limit by {far}")
    return texts
