"""What can be broken in a session of MuJoCo: the compiled model and its state, in place."""

from collections.abc import Callable, Mapping
from typing import cast

import mujoco  # type: ignore[import-untyped]  # ships no stubs
import numpy as np

from models.array import Array
from sim.engine import Session, Settings
from sim.mujoco.engine import MujocoSession
from sim.mujoco.settings import text
from sim.run.spoil import Opening, Post, Spoiler, WrongSetting, rounded


class MujocoSpoiler:
    """The loops are equality constraints; the rest is a tree."""

    wrong_settings: Mapping[WrongSetting, Callable[[float], Settings]] = {
        # Newton solves these loops in one, so it is Gauss-Seidel.
        "few-iterations": lambda size: {"solver": "PGS", "iterations": round(1.0 / size)},
        "light-drive": lambda size: {"flywheel_ratio": 1.0 / size},
        "semi-implicit": lambda _: {"integrator": "Euler"},
    }

    def open_loop(self, session: Session) -> None:
        """Of the two flags a rollout reads that of the model, a step that of the state."""
        own = _own(session)
        own._model.eq_active0[:] = 0
        own._data.eq_active[:] = 0

    def soften(self, session: Session, opening: Opening, share: float) -> None:
        """The impedance is the share of a joint's acceleration that is held."""
        held = np.array([float(opening.settings[f"solimp_{end}"]) for end in ("dmin", "dmax")])
        _own(session)._model.eq_solimp[:, :2] = held - share

    def slip(self, session: Session, by_m: float) -> None:
        """The site of the second body moves; of one at the body's origin MuJoCo would not look at
        the place."""
        model = _own(session)._model
        site = model.eq_obj2id[0]
        model.site_sameframe[site] = mujoco.mjtSameFrame.mjSAMEFRAME_NONE
        model.site_pos[site, 0] += by_m

    def pull(self, session: Session, gravity_m_s2: float) -> None:
        """The mechanism stands in the x-y plane, so down is -y."""
        _own(session)._model.opt.gravity[1] -= gravity_m_s2

    def load(self, session: Session, share: float) -> None:
        """Of the last body."""
        _own(session)._model.body_mass[-1] *= 1.0 + share

    def turn(self, session: Session, angle_rad: float) -> None:
        """The last joint."""
        own = _own(session)
        own._data.qpos[-1] += angle_rad
        mujoco.mj_forward(own._model, own._data)

    def block(self, session: Session, opening: Opening, body: str, post: Post) -> None:
        """The post is written into the model, which is compiled again; it and the bars of ``body``
        are as hard as the joints."""
        own = _own(session)
        spec = mujoco.MjSpec.from_string(
            text(opening.scene, opening.state, opening.settings, opening.dt_s, opening.drive)
        )
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
        model.body_invweight0[:] = own._model.body_invweight0  # lowered where nothing drives
        data = mujoco.MjData(model)
        data.qpos[:], data.qvel[:] = own._data.qpos, own._data.qvel
        mujoco.mj_forward(model, data)
        own._model, own._data = model, data

    def round_state(self, session: Session, relative: float) -> None:
        """Joint coordinates and their rates."""
        data = _own(session)._data
        data.qpos[:] = rounded(np.array(data.qpos), relative)
        data.qvel[:] = rounded(np.array(data.qvel), relative)

    def damp(self, session: Session, per_s: float) -> None:
        """By the damping of each joint, over its inertia in the model's own configuration."""
        model = _own(session)._model
        model.dof_damping[:] += per_s * model.dof_M0

    def slow(self, session: Session, share: float) -> None:
        """By an armature."""
        model = _own(session)._model
        model.dof_armature[-1] += share * model.dof_M0[-1]

    def spin(self, session: Session, by_rad_s: float) -> None:
        """The last joint."""
        own = _own(session)
        own._data.qvel[-1] += by_rad_s
        mujoco.mj_forward(own._model, own._data)

    def quicken(self, session: Session, share: float) -> None:
        """The rates of the joints."""
        _own(session)._data.qvel[:] *= 1.0 + share

    def hold_back(self, session: Session, by_s: float, before: Array | None = None) -> Array:
        """RK4 takes about the mean of the velocities before and after a step."""
        data = _own(session)._data
        now = np.array(data.qvel)
        if before is not None:
            data.qpos[:] -= 0.5 * by_s * (now - before)
        return now

    def lose(self, session: Session) -> None:
        """Of the last joint; MuJoCo then puts the whole state back to the start."""
        _own(session)._data.qvel[-1] = np.nan


def _own(session: Session) -> MujocoSession:
    """The session as what it is; its parts are reached into, which nothing else does."""
    return cast(MujocoSession, session)


SPOILER: Spoiler = MujocoSpoiler()
