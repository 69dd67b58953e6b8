"""A model of the user's own in MuJoCo, as it is: only the driven hinge is given a flywheel.

The flywheel is an armature set at run time, so that nothing which MuJoCo works out when it compiles
changes with it, above all not how soft the loops are; the tolerance of the solver is divided by
its ratio, as MuJoCo's stopping rule feels it (and does not feel ``stat.meaninertia``).
"""

from __future__ import annotations

import copy
from typing import Any

import numpy as np

from models.array import Array
from models.errors import EngineError
from models.joints import bodies
from models.motion import State
from models.scene import Scene
from models.tree import Limb
from sim.engine import Drive, Facts, Log, Poses, Settings
from sim.mujoco.own_model.planar_model import PlanarModel, coordinates
from sim.mujoco.own_model.variants import applied, held
from sim.mujoco.settings import INTEGRATORS
from sim.mujoco.stepped import VERSION, SteppedModel
from sim.tree_poses import body_poses

FLYWHEEL_RATIO = 1e15
"""Of the flywheel over the largest inertia of the linkage. Measured, with the mean inertia in its
place, on a rod that is led 119 deg past a limit: from 1e10 to 1e16 no error of a link changes in
its third digit, and the crank is off by 7.7e-5 rad after twenty turns at 1e10, and by 7.7e-10 at
1e15."""

LOST_RAD = 1e-4
"""A driven joint that is off by more is not driven. Damping of 5e3 N s/m,
a spring of 1e7 N/m and an armature of 1e6 kg m^2 on other joints leave it within 1e-12 rad over two
turns, even while they diverge."""


class OwnModelSession(SteppedModel):
    """The model, from a state of the scene that was read off it."""

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
        _give_flywheel(model, int(model.jnt_dofadr[own.driven]), own.inertia_kg_m2)
        self._hold(model, own.keyframe)
        self._limbs: tuple[Limb, ...] = own.limbs.limbs
        self._senses = np.array(own.limbs.senses)
        self._place(scene, state)
        self._forward()

    def _place(self, scene: Scene, state: State) -> None:
        """Set all joints from the closed form, with the velocities that the integrator wants."""
        near = self._senses * self._own.qpos[list(self._own.limbs.positions)]
        q, rate, push = coordinates(self._own.limbs, scene, state, near)
        rate = rate + self._shift * self._dt * push
        self._data.qpos[list(self._own.limbs.positions)] = self._senses * q
        self._data.qvel[list(self._own.limbs.rates)] = self._senses * rate
        crank = int(self._model.jnt_dofadr[self._own.driven])
        self._data.qvel[crank] = float(scene.driver.law.at(np.array([state.time_s]))[1][0])

    def record(self, steps: int, every: int) -> Log:
        """As of any model. Raises EngineError where the driven joint has left its way."""
        log = super().record(steps, every)
        if not log.diverged:
            self._refuse_lost_drive(log.poses)
        return log

    def _refuse_lost_drive(self, poses: Poses) -> None:
        turned = poses.bodies[self._scene.driver.link].theta
        wanted = self._scene.driver.law.at(poses.time_s)[0]
        off = float(np.max(np.abs((turned - turned[0]) - (wanted - wanted[0]))))
        if off > LOST_RAD:
            raise EngineError(
                f"the driven joint is off by {off:.3g} rad, for all its flywheel, so that the line "
                "says nothing of the loops; take off what loads that joint (damping, friction), or "
                "please report it where nothing does"
            )

    def facts(self) -> Facts:
        """The model as MuJoCo holds it now."""
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

    def _placed(self, states: Array, at: Array, push: Array) -> Poses:
        q, rate = self._joints(states)
        limbs = self._own.limbs
        positions, rates = list(limbs.positions), list(limbs.rates)
        lag = self._shift * self._dt
        poses = body_poses(
            self._limbs,
            q[:, positions] * self._senses,
            rate[:, rates] * self._senses,
            push[:, rates] * self._senses,
            lag,
        )
        shown = {name: poses[limb] for name, limb in limbs.shown.items()}
        return Poses(self._start_s + self._dt * at, shown, lag)

    def _controls(self, steps: int) -> Array | None:
        """The controls stay as the keyframe has them, or 0."""
        return np.tile(self._data.ctrl, (steps, 1)) if self._model.nu else None

    def _control_at(self, at: Array) -> Array | None:
        return np.tile(self._data.ctrl, (len(at), 1)) if self._model.nu else None


def _give_flywheel(model: Any, crank: int, inertia_kg_m2: float) -> None:
    """Let a freedom keep its rate, in a linkage whose inertia is at most this."""
    flywheel = FLYWHEEL_RATIO * inertia_kg_m2
    model.dof_armature[crank] += flywheel
    # Of a leaf body whose centre of mass is on its hinge MuJoCo takes the inertia from here.
    model.dof_M0[crank] += flywheel
    model.opt.tolerance /= FLYWHEEL_RATIO
