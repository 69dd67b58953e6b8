"""MuJoCo: hinges and slides as joint coordinates, loops closed by soft `connect` constraints.

The crank is driven by its armature, or an actuator (`models.mjcf.options`, `models.mjcf.document`),
whose control comes from `sim.engine.drive`.
"""

import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from typing import ClassVar, Self

import numpy as np

from models.array import Array
from models.errors import EngineError
from models.mjcf import document, options
from models.mjcf.forces import SpringTendon, planned, spring_tendons
from models.mjcf.tree import Tree, driven_freedom, plan
from models.motion import State
from models.scene import Scene
from sim.engine import Batches, BodyPose, Drive, Facts, Log, Settings, SettingValue
from sim.engine import drive as drives
from sim.engine.settings import SettingError, shipped_engine
from sim.engine.tree_poses import body_poses
from sim.mujoco import settings as own
from sim.mujoco.cam_relations import CamRelations
from sim.mujoco.loading import Loading
from sim.mujoco.reactions import JointForces, TreeReactions, joint_forces
from sim.mujoco.stepped import VERSION, SteppedModel, compiled, heard


class MujocoSession(SteppedModel):
    """A scene in MuJoCo. Velocities of all integrators except RK4 lag by half a step."""

    _calls_back: ClassVar[bool] = True
    """True if it calls back in each evaluation of the forces, for loads that follow the motion."""

    def __init__(
        self, scene: Scene, state: State, settings: Settings, dt_s: float, drive: Drive
    ) -> None:
        super().__init__(state.time_s, dt_s, own.velocity_shift(settings, drive))
        self._scene, self._settings, self._drive = scene, settings, drive
        chosen = own.writing(scene, settings, dt_s, drive)
        self._chosen, self._tree = chosen, _tree(scene, state, chosen)
        with heard(self._warnings.append):
            model = compiled(document.build(scene, state, chosen, self._tree))
        self._weights = model.body_invweight0.copy()
        model.body_invweight0[:] *= own.weight_share(scene, settings, drive)
        self._hold(model, keyframe=0)
        self._stays = not model.nu
        self._controlled = options.has_control(scene, chosen)
        staged = chosen.free and self._calls_back and own.integrator(settings, drive) == "RK4"
        stages_dt_s = dt_s if staged else 0.0
        self._loading = Loading(scene, model, self._tree.limbs, drive, state.time_s, stages_dt_s)
        self._cams = CamRelations(scene, self._tree, model, dt_s)
        self._following, self._relate = self._follow, self._cams.set
        self._tendons = spring_tendons(scene, state, self._tree)
        driven, self._sense = driven_freedom(scene, self._tree.limbs)
        self._crank = int(model.joint(driven).dofadr[0])
        if not chosen.free:
            start = drives.start_speed(scene.driver.law, state.time_s, dt_s, self._shift)
            self._data.qvel[self._crank] = self._sense * start
        self._pushes = np.empty(0)
        self._forward()

    @contextmanager
    def _follow(self) -> Iterator[None]:
        with self._loading.following(), self._cams.following():
            yield

    def facts(self) -> Facts:
        """Read the model as MuJoCo holds it now."""
        model, opt = self._model, self._model.opt
        share = float(model.body_invweight0.sum() / self._weights.sum())
        counted = int(opt.iterations), float(f"{share:.12g}")
        settings: dict[str, SettingValue] = {
            **own.used(self._settings, self._drive),
            **own.holds(self._settings, self._dt, self._drive),
            "close": ", ".join(dict.fromkeys(c.point for c in self._tree.closures)),
            "timestep_s": float(opt.timestep),
            "tolerance": float(opt.tolerance),
            **own.held(self._scene, self._settings, self._drive, *counted),
            "integrator": own.INTEGRATORS[int(opt.integrator)],
        }
        if model.neq:
            found = (*model.eq_solref[0], *model.eq_solimp[0, :3])
            settings |= zip(own.OF_LOOPS, map(float, found), strict=True)
        bodies = {limb.body: model.body(limb.body) for limb in self._tree.limbs}
        return Facts(
            version=VERSION,
            mass_kg={name: float(body.mass[0]) for name, body in bodies.items()},
            inertia_kg_m2={name: self._inertia(name) for name in bodies},
            centre_m={n: (float(b.ipos[0]), float(b.ipos[1])) for n, b in bodies.items()},
            gravity_m_s2=(float(opt.gravity[0]), float(opt.gravity[1])),
            start=self.read(),
            settings=settings,
            velocity_shift=self._shift,
            acceleration_shift=0.0,
            springs={tendon.spring.name: self._spring(tendon) for tendon in self._tendons},
        )

    def record_forces(self, steps: int, every: int) -> Log:
        """Advance and log, as `record`, with the forces of `mj_forward` at each kept state."""
        states: list[JointForces] = []
        log = self.record(steps, every, lambda *at: states.append(joint_forces(*at)))
        built = TreeReactions(self._scene, self._tree, log.poses, states, self._tendons)
        return replace(log, forces=built.forces())

    def _spring(self, tendon: SpringTendon) -> tuple[float, float, float]:
        """Return rate, damping and slack length or angle of a spring, as in `Facts`."""
        model, k = self._model, int(self._model.tendon(tendon.name).id)
        slack = tendon.sense * float(model.tendon_lengthspring[k, 0]) + tendon.shift
        return float(model.tendon_stiffness[k]), float(model.tendon_damping[k]), slack

    def _inertia(self, body: str) -> float:
        """Return the inertia about the centre of mass; a free crank's hinge counts as well."""
        inertia = float(self._model.body(body).inertia[2])
        if self._chosen.free and body == self._scene.driver.link:
            inertia += float(self._model.dof_armature[self._crank])
        return inertia

    def _roll(self, steps: int) -> Array:
        with self._loading.in_stages(self._done, steps):
            return super()._roll(steps)

    @classmethod
    def _batch(
        cls, sessions: Sequence[Self], steps: int, threads: int
    ) -> Callable[[], Sequence[Array]]:
        one = sessions[0]
        if follow := [*one._loading.by_motion, *one._scene.cams]:
            raise EngineError(
                f"{one._scene.name}: {', '.join(follow)} follows the motion by calls from each "
                "step, which in a batch do not know their world; run it alone"
            )
        return super()._batch(sessions, steps, threads)

    def _controls(self, steps: int) -> Array:
        """Return the controls of each of the next steps.

        A load that is known ahead has in a step the size of the middle of the velocity's step; that
        of the start of a step of RK4 would be half a step late, and of first order. In free motion
        a step of RK4 sees it in its stages instead (`Loading.in_stages`).
        """
        middle = self._done + np.arange(steps, dtype=np.float64) + 0.5 + self._shift
        loads = self._loading.at_times(self._start_s + self._dt * middle)
        return np.hstack([self._driving(steps), loads]) if self._controlled else loads

    def _driving(self, steps: int) -> Array:
        """Return the control of the crank in each of the next steps, (steps, 1)."""
        law, end = self._scene.driver.law, self._done + steps
        if self._chosen.servo_gain is not None:
            # The speed at the end of the step is its mean.
            return drives.chords(law, self._start_s, self._dt, self._done, end - 1)[:, None]
        if len(self._pushes) < end + 1:
            longer = max(end + 1, 2 * len(self._pushes))
            self._pushes = drives.pushes(law, self._start_s, self._dt, longer, self._shift)
        return self._pushes[self._done : end, None]

    def _placed(self, q: Array, rate: Array, push: Array, lag_s: float) -> Mapping[str, BodyPose]:
        return body_poses(self._tree.limbs, q, rate, push, lag_s)

    def bodies_at(self, q: Array) -> Mapping[str, BodyPose]:
        """Return the bodies from joint coordinates (T, nq), at rest."""
        return body_poses(self._tree.limbs, q, 0.0 * q, 0.0 * q)

    def _control_at(self, at: Array) -> Array:
        """Return the law's own speed or acceleration at the steps, and the sizes of the loads."""
        time_s = self._start_s + self._dt * at
        loads = self._loading.at_times(time_s)
        if not self._controlled:
            return loads
        _, omega, alpha = self._scene.driver.law.at(time_s)
        driving = alpha if self._chosen.servo_gain is None else omega
        return np.column_stack([driving, loads])


def _tree(scene: Scene, state: State, chosen: options.Writing) -> Tree:
    """Plan the tree; a fault that only the setting ``close`` causes is a fault of the setting."""
    try:
        return planned(scene, state, chosen.close, delay_s=chosen.delay_s)
    except EngineError as error:
        if not chosen.close:
            raise
        able = ", ".join(closure.point for closure in plan(scene, state).closures)
        raise SettingError(f"setting {error}; by default {able}") from None


ENGINE = shipped_engine(
    own,
    VERSION,
    MujocoSession,
    of_states=True,
    holds=own.holds,
    in_seconds=own.in_seconds,
    applies_gears=True,
    applies_cams=True,
    applies_cams_by_contact=True,
    batches=Batches(MujocoSession.record_together, threads=os.cpu_count() or 1),
)
