"""MuJoCo Warp: MuJoCo's models stepped by kernels of Warp, in single precision."""

from collections.abc import Callable, Sequence
from copy import copy
from dataclasses import fields
from functools import partial
from importlib.metadata import version
from typing import Any, Self

import numpy as np

from models.array import Array
from sim.engine import Batches
from sim.engine.imported import imported, imported_warp
from sim.engine.settings import shipped_engine
from sim.mujoco import settings as mujoco
from sim.mujoco.ported import PortedSession, version_of
from sim.mujoco_warp import DECLARATION
from sim.mujoco_warp import settings as own

mjw = imported("mujoco_warp")
wp = imported_warp()
VERSION = version_of(version("mujoco-warp"))
STEPPERS = (mjw.euler, mjw.rungekutta4, mjw.implicit, mjw.implicit, mjw.discrete)
"""What follows an evaluation of the forces, by MuJoCo's number of the integrator."""


class MujocoWarpSession(PortedSession):
    """A session with one world on the processor."""

    name, version = "mujoco-warp", VERSION

    def _put(self) -> None:
        with wp.ScopedDevice("cpu"):
            self._there = there = mjw.put_model(self._model)
            there.opt.warn_overflow = 0  # its iterations end it, and it says so in each step
            there.opt.tolerance.fill_(float(self._model.opt.tolerance))  # else 1e-6 at least
            mjw.step(there, mjw.put_data(self._model, self._data))  # compiles all kernels
            self._now = mjw.put_data(self._model, self._data)
        self._take_back(
            lambda name: _number(getattr(there, name)),
            lambda name: _number(getattr(there.opt, name)),
        )

    def _stepped(self, controls: Array, led: Array) -> Array:
        (rows,) = _stepped(self._there, self._now, self._crank, controls[None], led[None])
        return np.asarray(rows)

    @classmethod
    def _put_together(cls, sessions: Sequence[Self]) -> Callable[[Array, Array], Array]:
        one, number = sessions[0], len(sessions)
        with wp.ScopedDevice("cpu"):
            now = mjw.put_data(one._model, one._data, nworld=number)
            there = _of_worlds([each._there for each in sessions])
            there.opt = _of_worlds([each._there.opt for each in sessions])
        for name in ("qpos", "qvel", "ctrl", "qacc_warmstart"):
            starts = [getattr(each._now, name).numpy()[0] for each in sessions]
            getattr(now, name).numpy()[:] = starts
        return partial(_stepped, there, now, one._crank)


def _of_worlds(models: Sequence[Any]) -> Any:
    """Return a model with the numbers of each in those arrays that have a row for each world."""
    whole = copy(models[0])
    for each in fields(whole):
        if getattr(each.type, "shape", ())[:1] == ("*",):
            given = [getattr(model, each.name) for model in models]
            rows = np.concatenate([array.numpy() for array in given])
            setattr(whole, each.name, wp.array(rows, dtype=given[0].dtype))
    return whole


def _stepped(model: Any, now: Any, crank: int, controls: Array, led: Array) -> Array:
    """Step all worlds; on the processor, arrays of Warp are seen by numpy as they are."""
    own = now.qpos, now.qvel, now.qacc, now.ctrl
    qpos, qvel, qacc, control = (each.numpy() for each in own)
    rows = np.empty((*controls.shape[:2], qpos.shape[1] + 2 * qvel.shape[1]))
    leads, stepper = not np.isnan(led).any(), STEPPERS[int(model.opt.integrator)]
    with wp.ScopedDevice("cpu"):
        for k in range(rows.shape[1]):
            control[:] = controls[:, k]
            if leads:
                qpos[:, crank], qvel[:, crank] = led[:, k].T
            mjw.forward(model, now)
            rows[:, k] = np.concatenate([qpos, qvel, qacc], axis=1)
            if k + 1 < rows.shape[1]:
                stepper(model, now)
    return rows


def _number(value: Any) -> Any:
    """Return a number, or the numbers of the only world."""
    return value.numpy()[0] if hasattr(value, "numpy") else value


ENGINE = shipped_engine(
    own,
    VERSION,
    MujocoWarpSession,
    of_states=True,
    forces_of="nothing",
    no_forces="run mujoco for those of the same model",
    holds=mujoco.holds,
    in_seconds=mujoco.in_seconds,
    applies_gears=True,
    precision=DECLARATION.precision,
    floor=2e-6,
    batches=Batches(MujocoWarpSession.record_together),
)
