"""Faults for a session of MuJoCo: changes of the compiled model and its state, in place."""

from collections.abc import Callable, Mapping
from typing import cast

import mujoco  # type: ignore[import-untyped]  # ships no stubs
import numpy as np

from models.array import Array
from models.mjcf import document
from sim.engine import Session, Settings
from sim.mujoco.engine import MujocoSession
from sim.mujoco.settings import writing
from sim.run.spoil import Opening, Post, Spoiler, WrongSetting, rounded


class MujocoSpoiler:
    """MuJoCo's faults: the loops are equality constraints; the rest is a tree."""

    wrong_settings: Mapping[WrongSetting, Callable[[float], Settings]] = {
        # Newton solves these loops in one iteration, so it is Gauss-Seidel.
        "few-iterations": lambda size: {"solver": "PGS", "iterations": round(1.0 / size)},
        "light-drive": lambda size: {"flywheel_ratio": 1.0 / size},
        "semi-implicit": lambda _: {"integrator": "Euler"},
    }

    def open_loop(self, session: Session) -> None:
        """Clear both flags: a rollout reads the model's, a step the state's."""
        own = _own(session)
        own._model.eq_active0[:] = 0
        own._data.eq_active[:] = 0

    def soften(self, session: Session, opening: Opening, share: float) -> None:
        """Lower the impedance, the constrained share of a joint's acceleration."""
        held = np.array([float(opening.settings[f"solimp_{end}"]) for end in ("dmin", "dmax")])
        _own(session)._model.eq_solimp[:, :2] = held - share

    def slip(self, session: Session, by_m: float) -> None:
        """Move the site of the second body; MuJoCo would ignore a place at the body's origin."""
        model = _own(session)._model
        site = model.eq_obj2id[0]
        model.site_sameframe[site] = mujoco.mjtSameFrame.mjSAMEFRAME_NONE
        model.site_pos[site, 0] += by_m

    def pull(self, session: Session, gravity_m_s2: float) -> None:
        _own(session)._model.opt.gravity[1] -= gravity_m_s2

    def load(self, session: Session, share: float) -> None:
        _own(session)._model.body_mass[-1] *= 1.0 + share

    def turn(self, session: Session, angle_rad: float) -> None:
        own = _own(session)
        own._data.qpos[-1] += angle_rad
        mujoco.mj_forward(own._model, own._data)

    def block(self, session: Session, opening: Opening, body: str, post: Post) -> None:
        """Write the post into the model and compile it again; post and bars of ``body`` are as hard
        as joints."""
        own = _own(session)
        chosen = writing(opening.scene, opening.settings, opening.dt_s, opening.drive)
        spec = mujoco.MjSpec.from_string(document.build(opening.scene, opening.state, chosen))
        spec.worldbody.add_geom(
            type=mujoco.mjtGeom.mjGEOM_SPHERE,
            size=[post.radius_m, 0.0, 0.0],
            pos=[*post.centre, 0.0],
        )
        for geom in (spec.worldbody.geoms[-1], *spec.body(body).geoms):
            geom.contype = geom.conaffinity = 1
            geom.solref, geom.solimp = own._model.eq_solref[0], own._model.eq_solimp[0]
        model = spec.compile()
        model.opt.disableflags &= ~int(mujoco.mjtDisableBit.mjDSBL_CONTACT)
        model.body_invweight0[:] = own._model.body_invweight0  # lowered in free motion
        data = mujoco.MjData(model)
        data.qpos[:], data.qvel[:] = own._data.qpos, own._data.qvel
        mujoco.mj_forward(model, data)
        own._model, own._data = model, data

    def round_state(self, session: Session, relative: float) -> None:
        data = _own(session)._data
        data.qpos[:] = rounded(np.array(data.qpos), relative)
        data.qvel[:] = rounded(np.array(data.qvel), relative)

    def damp(self, session: Session, per_s: float) -> None:
        """Add damping to each joint, over its inertia in the model's own configuration."""
        model = _own(session)._model
        model.dof_damping[:] += per_s * model.dof_M0

    def slow(self, session: Session, share: float) -> None:
        model = _own(session)._model
        model.dof_armature[-1] += share * model.dof_M0[-1]

    def spin(self, session: Session, by_rad_s: float) -> None:
        own = _own(session)
        own._data.qvel[-1] += by_rad_s
        mujoco.mj_forward(own._model, own._data)

    def quicken(self, session: Session, share: float) -> None:
        _own(session)._data.qvel[:] *= 1.0 + share

    def hold_back(self, session: Session, by_s: float, before: Array | None = None) -> Array:
        """Take back half the change: RK4 takes about the mean of velocities before and after."""
        data = _own(session)._data
        now = np.array(data.qvel)
        if before is not None:
            data.qpos[:] -= 0.5 * by_s * (now - before)
        return now

    def lose(self, session: Session) -> None:
        """Lose the last joint's rate; MuJoCo then puts the whole state back to the start."""
        _own(session)._data.qvel[-1] = np.nan


def _own(session: Session) -> MujocoSession:
    """Return the session by its own class; only here are its parts accessed."""
    return cast(MujocoSession, session)


SPOILER: Spoiler = MujocoSpoiler()
