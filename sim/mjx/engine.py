"""MJX: MuJoCo's models stepped in a compiled loop of JAX."""

import os
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from copy import copy
from functools import partial
from importlib import import_module
from importlib.metadata import version
from typing import Any, Self

import numpy as np

from models.array import Array
from models.errors import EngineError
from sim.engine import AT_ROUNDING, Batches
from sim.engine.imported import imported
from sim.engine.settings import shipped_engine
from sim.mjx import settings as own
from sim.mujoco import settings as mujoco
from sim.mujoco.ported import PortedSession, version_of

# Matrices are small: threads would wait for each other, and for other cells.
os.environ.setdefault(
    "XLA_FLAGS", "--xla_cpu_multi_thread_eigen=false intra_op_parallelism_threads=1"
)
mjx = imported("mujoco.mjx")  # it imports Warp, where that is installed
jax: Any = import_module("jax")  # so that types do not depend on what is installed
jnp: Any = import_module("jax.numpy")
try:
    CPU = jax.devices("cpu")[0]
except (RuntimeError, AssertionError) as error:  # where JAX_PLATFORMS leaves it out
    raise EngineError("engine mjx: JAX has no processor; add cpu to JAX_PLATFORMS") from error
VERSION = version_of(version("mujoco-mjx"))
MOST = 4000
"""Steps of a compiled loop at most: its arrays have one size, so that it is compiled once."""
FLOOR = 2e-6
"""Error of place that float32 leaves, over the longest link or in rad."""
STEPPERS = {0: mjx.euler, 1: mjx.rungekutta4, 3: mjx.implicit}
"""What follows an evaluation of the forces, by MuJoCo's number of the integrator."""


class MjxSession(PortedSession):
    """A session with one model on the processor; the compiled loop is one for all of its kind."""

    name, version = "mjx", VERSION

    @property
    def single(self) -> bool:
        return self._settings["precision"] == "float32"

    def _put(self) -> None:
        with self._as_numbers():
            there, data = mjx.put_model(self._model, impl="jax"), self._data
            # Compiled code is used again for arrays that are on a device by name, as results are,
            # and for models that are alike in all that is no such array.
            keys = {name: np.zeros_like(getattr(there, name)) for name in ("key_qpos", "key_qvel")}
            self._there = there.replace(**keys)
            start = {"qpos": data.qpos, "qvel": data.qvel, "ctrl": data.ctrl}
            start = {name: jax.device_put(value.copy(), CPU) for name, value in start.items()}
            self._now = mjx.make_data(self._model, impl="jax").replace(**start)
        there, options = self._there, self._there.opt
        self._take_back(lambda name: getattr(there, name), lambda name: getattr(options, name))

    @contextmanager
    def _as_numbers(self) -> Iterator[None]:
        """Let JAX have numbers of this session's precision, on the processor."""
        with jax.enable_x64(not self.single), jax.default_device(CPU):
            yield

    def _stepped(self, controls: Array, led: Array, run: Any = None) -> Array:
        rows, steps = [], controls.shape[-2] - 1
        with self._as_numbers():
            for first in range(0, max(steps, 1), MOST):
                count = min(steps - first, MOST)
                kept = slice(first, first + count + 1)
                given = [filled(each[..., kept, :]) for each in (controls, led)]
                self._now, found = (run or rolled)(
                    self._there, self._now, *given, self._crank, count
                )
                kept = slice(count + (first + count == steps))
                rows.append(np.asarray(found, dtype=np.float64)[..., kept, :])
        return np.concatenate(rows, axis=-2)

    @classmethod
    def _put_together(cls, sessions: Sequence[Self]) -> Callable[[Array, Array], Array]:
        all_ = copy(sessions[0])
        with all_._as_numbers():
            for name in ("_there", "_now"):
                stacked = jax.tree_util.tree_map(
                    lambda *each: jax.device_put(jnp.stack(each), CPU),
                    *(getattr(one, name) for one in sessions),
                )
                setattr(all_, name, stacked)
        return partial(all_._stepped, run=rolled_together)


def filled(rows: Array) -> Array:
    """Return the rows with others after them, to the size of the compiled loop."""
    missing = MOST + 1 - rows.shape[-2]
    return np.concatenate([rows, np.zeros((*rows.shape[:-2], missing, rows.shape[-1]))], axis=-2)


def _rolled(model: Any, data: Any, controls: Any, led: Any, crank: Any, count: Any) -> Any:
    """Return the data after ``count`` steps, and coordinates, rates and accelerations before each
    step and after the last."""

    def one(k: Any, carry: Any) -> Any:
        data, rows = carry
        coordinate, rate = led[k]
        data = data.replace(
            ctrl=controls[k],
            qpos=data.qpos.at[crank].set(
                jnp.where(jnp.isnan(coordinate), data.qpos[crank], coordinate)
            ),
            qvel=data.qvel.at[crank].set(jnp.where(jnp.isnan(rate), data.qvel[crank], rate)),
        )
        there = mjx.forward(model, data)
        rows = rows.at[k].set(jnp.concatenate([there.qpos, there.qvel, there.qacc]))
        after = STEPPERS[int(model.opt.integrator)](model, there)
        return jax.tree_util.tree_map(lambda a, b: jnp.where(k < count, a, b), after, data), rows

    rows = jnp.zeros((len(controls), model.nq + 2 * model.nv))
    return jax.lax.fori_loop(0, count + 1, one, (data, rows))


rolled: Any = jax.jit(_rolled)
rolled_together: Any = jax.jit(jax.vmap(_rolled, in_axes=(0, 0, 0, 0, None, None)))
ENGINE = shipped_engine(
    own,
    VERSION,
    MjxSession,
    of_states=True,
    forces_of="nothing",
    no_forces="MJX exports its forces to MuJoCo's own data alone; run mujoco",
    holds=mujoco.holds,
    in_seconds=mujoco.in_seconds,
    numbers_with=lambda settings: (
        ("single", FLOOR) if settings["precision"] == "float32" else ("double", AT_ROUNDING)
    ),
    applies_gears=True,
    batches=Batches(
        MjxSession.record_together,
        "the matrices of all worlds are multiplied together, and so in another order",
    ),
)
