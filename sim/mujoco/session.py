"""A model in MuJoCo: opened, stepped, and read back as poses."""

from __future__ import annotations

import os
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from models.array import Array

# Nothing is drawn here: without this, importing MuJoCo loads a window library by way of a process
# of its own, which takes longer than the rest and outlives a worker that is told to end.
os.environ.setdefault("MUJOCO_GL", "disable")

import mujoco  # type: ignore[import-untyped]  # ships no stubs
import numpy as np
from mujoco import rollout

from models.errors import EngineError
from models.mjcf import build
from models.mjcf_options import Writing, driver_joint, has_control
from models.motion import State
from models.scene import Point, Scene
from models.tree import Tree, plan
from sim import drive as drives
from sim.engine import Drive, Facts, Log, Poses, Settings, SettingValue
from sim.mujoco.settings import INTEGRATORS, OF_DRIVES, holds, velocity_shift, writing
from sim.settings import SettingError
from sim.tree_poses import body_poses

VERSION = str(mujoco.mj_versionString())
"""Of the C library."""
FULL = mujoco.mjtState.mjSTATE_FULLPHYSICS.value
DIVERGED = (
    mujoco.mjtWarning.mjWARN_BADQPOS,
    mujoco.mjtWarning.mjWARN_BADQVEL,
    mujoco.mjtWarning.mjWARN_BADQACC,
)


class MujocoSession:
    """One model in MuJoCo. Velocities of all integrators but RK4 lag by half a step."""

    def __init__(
        self, scene: Scene, state: State, settings: Settings, dt_s: float, drive: Drive
    ) -> None:
        self._scene, self._dt, self._settings, self._drive = scene, dt_s, settings, drive
        self._start_s, self._done = state.time_s, 0
        self._shift = velocity_shift(settings, drive)
        chosen = writing(scene, settings, dt_s, drive)
        tree = _tree(scene, state, chosen)
        self._limbs = tree.limbs
        self._closed = ", ".join(dict.fromkeys(c.point for c in tree.closures))
        self._warnings: list[str] = []
        with self._quiet():
            self._model = _compiled(build(scene, state, chosen, tree))
        self._data = mujoco.MjData(self._model)
        mujoco.mj_resetDataKeyframe(self._model, self._data, 0)
        self._servo = chosen.servo_gain is not None
        self._controlled = has_control(scene, chosen)
        self._free = chosen.free
        self._crank = int(self._model.joint(driver_joint(scene)).dofadr[0])
        if not self._free:
            start = drives.start_speed(scene.driver.law, state.time_s, dt_s, self._shift)
            self._data.qvel[self._crank] = start
        self._pushes = np.empty(0)
        with self._quiet():
            mujoco.mj_forward(self._model, self._data)

    def facts(self) -> Facts:
        """The model as MuJoCo holds it now."""
        model = self._model
        names = [limb.body for limb in self._limbs]
        opt = model.opt
        unused = OF_DRIVES if self._free else ()
        settings: dict[str, SettingValue] = {
            name: value for name, value in self._settings.items() if name not in unused
        } | {
            **holds(self._settings, self._dt, self._drive),
            "close": self._closed,
            "timestep_s": float(opt.timestep),
            "tolerance": float(opt.tolerance),
            "iterations": int(opt.iterations),
            "integrator": INTEGRATORS[int(opt.integrator)],
        }
        if model.neq:
            settings["solref_timeconst_s"] = float(model.eq_solref[0, 0])
            settings["solref_dampratio"] = float(model.eq_solref[0, 1])
            impedance = ("solimp_dmin", "solimp_dmax", "solimp_width")
            settings |= zip(impedance, map(float, model.eq_solimp[0, :3]), strict=True)
        return Facts(
            version=VERSION,
            mass_kg={n: float(model.body(n).mass[0]) for n in names},
            inertia_kg_m2={n: self._inertia(n) for n in names},
            centre_m={n: _pair(model.body(n).ipos) for n in names},
            gravity_m_s2=(float(opt.gravity[0]), float(opt.gravity[1])),
            start=self._start(),
            settings=settings,
            velocity_shift=self._shift,
            acceleration_shift=0.0,
        )

    def _inertia(self, body: str) -> float:
        """Inertia about the centre of mass; a free crank has that of its hinge as well."""
        inertia = float(self._model.body(body).inertia[2])
        if self._free and body == self._scene.driver.link:
            inertia += float(self._model.dof_armature[self._crank])
        return inertia

    def step(self, steps: int) -> None:
        """Advance in C without logging."""
        if not steps:
            return
        with self._quiet():
            if self._controlled:
                self._roll(steps)
            else:
                mujoco.mj_step(self._model, self._data, steps)
        self._done += steps

    def record(self, steps: int, every: int) -> Log:
        """Advance in C, log every step, keep every ``every``-th."""
        first = self._full_state()[None]
        began = time.perf_counter()
        with self._quiet():
            states = self._roll(steps)
        wall = time.perf_counter() - began
        kept = np.concatenate([first, states[every - 1 :: every]])
        at = self._done + every * np.arange(len(kept), dtype=np.float64)
        good = np.abs(kept[:, 0] - kept[0, 0] - (at - self._done) * self._dt) < 0.5 * self._dt
        diverged = any(self._data.warning[kind].number for kind in DIVERGED)
        count = len(kept) if good.all() else int(np.argmin(good))
        with self._quiet():
            poses = self._poses(kept[:count], at[:count])
        self._done += steps
        return Log(poses, (count - 1) * every, diverged or count < len(kept), self.taken(), wall)

    def read(self) -> Poses:
        """The current state."""
        with self._quiet():
            return self._poses(self._full_state()[None], np.array([float(self._done)]))

    def _start(self) -> Poses:
        """The current state; the accelerations of the first are there from the opening."""
        if self._done or self._controlled:  # by what the law asks for, which the opening left out
            return self.read()
        return self._placed(self._full_state()[None], np.zeros(1), self._data.qacc[None].copy())

    def taken(self) -> tuple[str, ...]:
        """The warnings so far, each once."""
        return tuple(dict.fromkeys(self._warnings))

    def _roll(self, steps: int) -> Array:
        """States after each of the next steps, (steps, n)."""
        warm = self._data.qacc_warmstart[None].copy()
        control = self._controls(steps)
        given: dict[str, Any] = {} if control is None else {"control": control[None, :, None]}
        states, _ = rollout.rollout(
            self._model,
            self._data,
            self._full_state()[None],
            nstep=steps,
            initial_warmstart=warm,
            **given,
        )
        return np.asarray(states[0])

    def _controls(self, steps: int) -> Array | None:
        """The control of each of the next steps; None where the model has no actuator."""
        if not self._controlled:
            return None
        law, end = self._scene.driver.law, self._done + steps
        if self._servo:  # the speed that the step leads to is its mean speed
            return drives.chords(law, self._start_s, self._dt, self._done, end - 1)
        if len(self._pushes) < end + 1:
            longer = max(end + 1, 2 * len(self._pushes))
            self._pushes = drives.pushes(law, self._start_s, self._dt, longer, self._shift)
        return self._pushes[self._done : end]

    def _full_state(self) -> Array:
        """Time, positions and velocities as MuJoCo stores them."""
        state = np.empty(mujoco.mj_stateSize(self._model, FULL))
        mujoco.mj_getState(self._model, self._data, state, FULL)
        return state

    def _poses(self, states: Array, at: Array) -> Poses:
        """Poses of logged states; accelerations are those of `mj_forward` at each state."""
        return self._placed(states, at, self._accelerations(states, at))

    def _placed(self, states: Array, at: Array, push: Array) -> Poses:
        """Poses of states with their joint accelerations (T, nv)."""
        nq, nv = self._model.nq, self._model.nv
        q, rate = states[:, 1 : 1 + nq], states[:, 1 + nq : 1 + nq + nv]
        lag = self._shift * self._dt
        poses = body_poses(self._limbs, q, rate, push, lag)
        return Poses(self._start_s + self._dt * at, poses, lag)

    def _accelerations(self, states: Array, at: Array) -> Array:
        """Joint accelerations of the states (T, nv), computed on a copy of the data."""
        model, data = self._model, mujoco.MjData(self._model)
        rows = np.empty((len(states), model.nv))
        control = self._control_at(at)
        for row, state in enumerate(states):
            mujoco.mj_setState(model, data, state, FULL)
            if control is not None:
                data.ctrl[0] = control[row]
            mujoco.mj_forward(model, data)
            rows[row] = data.qacc
            data.qacc_warmstart[:] = data.qacc
        return rows

    def _control_at(self, at: Array) -> Array | None:
        """The law's own speed or acceleration at the steps, for the actuator."""
        if not self._controlled:
            return None
        _, omega, alpha = self._scene.driver.law.at(self._start_s + self._dt * at)
        return omega if self._servo else alpha

    @contextmanager
    def _quiet(self) -> Iterator[None]:
        """Collect MuJoCo's warnings instead of printing them and writing MUJOCO_LOG.TXT."""
        before = mujoco.get_mju_user_warning()
        mujoco.set_mju_user_warning(self._warnings.append)
        try:
            yield
        finally:
            mujoco.set_mju_user_warning(before)


def _pair(vector: Array) -> Point:
    """The first two of a vector, in the plane."""
    return float(vector[0]), float(vector[1])


def _tree(scene: Scene, state: State, chosen: Writing) -> Tree:
    """The tree; a fault that only the setting ``close`` causes is a fault of the setting."""
    try:
        return plan(scene, state, chosen.close, delay_s=chosen.delay_s)
    except EngineError as error:
        if not chosen.close:
            raise
        able = ", ".join(closure.point for closure in plan(scene, state).closures)
        raise SettingError(f"setting {error}; by default {able}") from None


def _compiled(xml: str) -> Any:
    """The compiled model. Raises EngineError with MuJoCo's own words."""
    try:
        return mujoco.MjModel.from_xml_string(xml)
    except ValueError as error:
        raise EngineError(f"MuJoCo refuses the model: {error}") from error
