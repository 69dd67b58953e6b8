"""MuJoCo Warp: MuJoCo's models stepped by kernels of Warp, in single precision."""

from importlib.metadata import version
from typing import Any

import numpy as np

from models.array import Array
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
        """Step; on the processor, arrays of Warp are seen by numpy as they are."""
        model, now = self._there, self._now
        own = now.qpos, now.qvel, now.qacc, now.ctrl
        qpos, qvel, qacc, control = (each.numpy()[0] for each in own)
        rows, leads = np.empty((len(controls), len(qpos) + 2 * len(qvel))), not np.isnan(led).any()
        stepper = STEPPERS[int(model.opt.integrator)]
        with wp.ScopedDevice("cpu"):
            for k, row in enumerate(rows):
                control[:] = controls[k]
                if leads:
                    qpos[self._crank], qvel[self._crank] = led[k]
                mjw.forward(model, now)
                row[:] = np.concatenate([qpos, qvel, qacc])
                if k + 1 < len(rows):
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
)
