"""A compiled model in MuJoCo, stepped and logged in C, and read back as poses of its bodies."""

import os
import time
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, contextmanager, nullcontext
from pathlib import Path
from typing import Any, Self

from models.array import Array

# Nothing is drawn here: without this, importing MuJoCo loads a window library by way of a process
# of its own, which takes longer than the rest and outlives a worker that has to end.
os.environ.setdefault("MUJOCO_GL", "disable")

import mujoco  # type: ignore[import-untyped]  # ships no stubs
import numpy as np
from mujoco import rollout

from models.errors import EngineError
from sim.engine import BodyPose, Log, Poses

VERSION = str(mujoco.mj_versionString())
"""Version of the C library."""
FULL = mujoco.mjtState.mjSTATE_FULLPHYSICS.value
DIVERGED = (
    mujoco.mjtWarning.mjWARN_BADQPOS,
    mujoco.mjtWarning.mjWARN_BADQVEL,
    mujoco.mjtWarning.mjWARN_BADQACC,
)
Look = Callable[[Any, Any], None]
"""Function of a model and its data, called after `mj_forward` at a state."""


class SteppedModel(ABC):
    """A model and its data from ``start_s`` [s] on, in steps of ``dt_s`` [s]; its velocities belong
    to ``shift`` steps after its positions."""

    _model: Any
    _data: Any
    _stays = True
    """False if `step` needs controls that change from step to step."""

    def __init__(self, start_s: float, dt_s: float, shift: float) -> None:
        self._start_s, self._dt, self._shift = start_s, dt_s, shift
        self._done = 0
        self._warnings: list[str] = []
        self._following: Callable[[], AbstractContextManager[None]] = nullcontext
        """Context to enter while MuJoCo works."""
        self._relate: Callable[[Any, Any], None] = lambda model, data: None
        """Sets what the model holds for one state alone."""

    def _hold(self, model: Any, keyframe: int | None) -> None:
        """Take a compiled model, at one of its keyframes."""
        self._model, self._data = model, mujoco.MjData(model)
        if keyframe is not None:
            mujoco.mj_resetDataKeyframe(model, self._data, keyframe)

    def _forward(self) -> None:
        with self._at_work():
            mujoco.mj_forward(self._model, self._data)

    @abstractmethod
    def _placed(self, q: Array, rate: Array, push: Array, lag_s: float) -> Mapping[str, BodyPose]:
        """Return the bodies from joint coordinates (T, nq), and their rates and accelerations
        (T, nv); the rates belong to ``lag_s`` later."""

    def _controls(self, steps: int) -> Array:
        """Return the controls of each of the next steps, (steps, nu)."""
        return np.tile(self._data.ctrl, (steps, 1))

    def _control_at(self, at: Array) -> Array:
        """Return the controls at the steps ``at``, (T, nu)."""
        return self._controls(len(at))

    def step(self, steps: int) -> None:
        """Advance in C without logging."""
        if not steps:
            return
        with self._at_work():
            if self._stays:
                mujoco.mj_step(self._model, self._data, steps)
            else:
                self._roll(steps)
        self._done += steps

    def record(self, steps: int, every: int, look: Look | None = None) -> Log:
        """Advance in C, log every step, keep every ``every``-th; ``look`` gets each of these after
        `mj_forward`."""
        first = self._full_state()
        began = time.perf_counter()
        with self._at_work():
            states = self._roll(steps)
        return self._logged(first, states, every, time.perf_counter() - began, look)

    def _logged(
        self, first: Array, states: Array, every: int, wall: float, look: Look | None = None
    ) -> Log:
        """Return the log of the states after each step from the ``first`` on."""
        steps = len(states)
        kept = np.concatenate([first[None], states[every - 1 :: every]])
        at = self._done + every * np.arange(len(kept), dtype=np.float64)
        good = np.abs(kept[:, 0] - kept[0, 0] - (at - self._done) * self._dt) < 0.5 * self._dt
        diverged = any(self._data.warning[kind].number for kind in DIVERGED)
        count = len(kept) if good.all() else int(np.argmin(good))
        with self._at_work():
            poses = self._poses(kept[:count], at[:count], look)
        self._done += steps
        warnings = tuple(dict.fromkeys(self._warnings))
        return Log(poses, (count - 1) * every, diverged or count < len(kept), warnings, wall)

    @classmethod
    def record_together(
        cls, sessions: Sequence[Self], steps: int, every: int, threads: int
    ) -> list[Log]:
        """Record sessions as the worlds of a batch (`sim.engine.Batches`)."""
        roll = cls._batch(sessions, steps, threads)
        first = [one._full_state() for one in sessions]
        began = time.perf_counter()
        with sessions[0]._at_work():
            states = roll()
        wall = (time.perf_counter() - began) / len(sessions)
        each = zip(sessions, first, states, strict=True)
        return [one._logged(start, after, every, wall) for one, start, after in each]

    @classmethod
    def _batch(
        cls, sessions: Sequence[Self], steps: int, threads: int
    ) -> Callable[[], Sequence[Array]]:
        """Return the stepping of a batch, which returns the states after each step by session."""
        models = [one._model for one in sessions]
        data = [mujoco.MjData(models[0]) for _ in range(threads)]

        def roll() -> Sequence[Array]:
            states, _ = rollout.rollout(
                models,
                data,
                np.array([one._full_state() for one in sessions]),
                np.array([one._controls(steps) for one in sessions]) if models[0].nu else None,
                nstep=steps,
                initial_warmstart=np.array([one._data.qacc_warmstart for one in sessions]),
            )
            return list(states)

        return roll

    def read(self) -> Poses:
        """Read the current state."""
        with self._at_work():
            return self._poses(self._full_state()[None], np.array([float(self._done)]))

    def _roll(self, steps: int) -> Array:
        """Return the states after each of the next steps, (steps, n)."""
        warm = self._data.qacc_warmstart[None].copy()
        given = {"control": self._controls(steps)[None]} if self._model.nu else {}
        states, _ = rollout.rollout(
            self._model,
            self._data,
            self._full_state()[None],
            nstep=steps,
            initial_warmstart=warm,
            **given,
        )
        return np.asarray(states[0])

    def _full_state(self) -> Array:
        """Return time, coordinates and rates, as MuJoCo's vector of a state."""
        state = np.empty(mujoco.mj_stateSize(self._model, FULL))
        mujoco.mj_getState(self._model, self._data, state, FULL)
        return state

    def _poses(self, states: Array, at: Array, look: Look | None = None) -> Poses:
        """Return the poses of logged states, with accelerations by `mj_forward` at each, on a copy
        of the data."""
        model, data = self._model, mujoco.MjData(self._model)
        push, control = np.empty((len(states), model.nv)), self._control_at(at) if model.nu else ()
        for k, state in enumerate(states):
            mujoco.mj_setState(model, data, state, FULL)
            self._relate(model, data)
            if model.nu:
                data.ctrl[:] = control[k]
            mujoco.mj_forward(model, data)
            if look is not None:
                look(model, data)
            push[k] = data.qacc
            data.qacc_warmstart[:] = data.qacc
        return self._posed(states, at, push)

    def _posed(self, states: Array, at: Array, push: Array) -> Poses:
        """Return the poses of states with their accelerations."""
        rates, lag = 1 + self._model.nq, self._shift * self._dt
        q, rate = states[:, 1:rates], states[:, rates : rates + self._model.nv]
        return Poses(self._start_s + self._dt * at, self._placed(q, rate, push, lag), lag)

    @contextmanager
    def _at_work(self) -> Iterator[None]:
        """Collect MuJoCo's warnings while it works."""
        with heard(self._warnings.append), self._following():
            yield


@contextmanager
def heard(hear: Callable[[str], object]) -> Iterator[None]:
    """Pass MuJoCo's warnings on, instead of printing and writing them to MUJOCO_LOG.TXT."""
    before = mujoco.get_mju_user_warning()
    mujoco.set_mju_user_warning(hear)
    try:
        yield
    finally:
        mujoco.set_mju_user_warning(before)


def compiled(text: str | bytes | None = None, path: Path | None = None) -> Any:
    """Compile a model from its text, from a file, or from a text in place of a file. Raises
    EngineError with MuJoCo's own words."""
    try:
        if path is None:
            return mujoco.MjModel.from_xml_string(text)
        with heard(lambda _: None):
            return mujoco.MjModel.from_xml_path(str(path), {str(path): text} if text else {})
    except ValueError as error:
        raise EngineError(f"MuJoCo refuses the model: {error}") from error
