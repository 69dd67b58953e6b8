"""Sessions of engines that step MuJoCo's compiled models elsewhere than in its library.

MuJoCo compiles the model; the engine takes it and the state, and gives the states of each step.
What follows from states is that of MuJoCo.
"""

from abc import abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any, ClassVar, Self

import mujoco  # type: ignore[import-untyped]  # ships no stubs
import numpy as np

from models.array import Array
from models.errors import EngineError
from models.motion import State
from models.scene import Scene
from sim.compiling import compiling
from sim.engine import EPSILON, Drive, Facts, Poses, Profile, Setting, Settings
from sim.engine import drive as drives
from sim.mujoco.engine import MujocoSession
from sim.mujoco.stepped import FULL, VERSION, Look

IDLE: Settings = {"islands": "disable", "contact": "disable"}
"""Settings of MuJoCo without effect in these engines: they have no islands, nothing touches."""
OF_MODEL = (
    "body_mass", "body_inertia", "body_ipos", "body_invweight0", "dof_armature", "eq_solref",
    "eq_solimp", "tendon_stiffness", "tendon_damping", "tendon_lengthspring",
)  # fmt: skip
OF_OPTIONS = "timestep", "gravity", "tolerance", "iterations"
"""Numbers of a model and of its options that `MujocoSession.facts` reads."""


def profile(
    base: Profile, engine: str, summary: str, changes: Mapping[str, Setting], name: str = ""
) -> Profile:
    """Return a profile of MuJoCo for an engine, with some settings changed."""
    kept = {each: setting for each, setting in base.settings.items() if each not in IDLE}
    return Profile(name or base.name, engine, summary, {**kept, **changes})


class PortedSession(MujocoSession):
    """A scene in an engine that takes MuJoCo's models, of ``version``.

    With numbers of single precision it leads a prescribed crank along its law: the rounding of its
    steps would add up.
    """

    name: ClassVar[str]
    version: ClassVar[str]
    _calls_back = False

    def __init__(
        self, scene: Scene, state: State, settings: Settings, dt_s: float, drive: Drive
    ) -> None:
        super().__init__(scene, state, {**IDLE, **settings}, dt_s, drive)
        self._stays = False
        if loads := self._loading.by_motion:
            raise EngineError(
                f"{scene.name}: {', '.join(loads)} depends on the motion, and {self.name} takes "
                "loads of time alone; run mujoco"
            )
        try:
            with compiling():
                self._put()
                self._roll(0)
        except NotImplementedError as error:
            raise EngineError(f"{scene.name}: {self.name}: {error}; run mujoco") from None

    @property
    def single(self) -> bool:
        """True if its numbers are of single precision."""
        return True

    @abstractmethod
    def _put(self) -> None:
        """Give the engine the model and the state. Raises NotImplementedError as it does."""

    @abstractmethod
    def _stepped(self, controls: Array, led: Array) -> Array:
        """Step, but for the last row; return coordinates, rates and accelerations before each.

        The rows of ``controls`` (T, nu) act in a step each, those of ``led`` (T, 2) are coordinate
        and rate of the crank before it; NaN where the engine steps it.
        """

    def facts(self) -> Facts:
        found = super().facts()
        held = {name: value for name, value in found.settings.items() if name not in IDLE}
        return replace(found, version=self.version, settings=held)

    def _take_back(self, of: Callable[[str], Any], of_options: Callable[[str], Any]) -> None:
        """Take the numbers of the engine's own model that differ by more than its rounding."""
        rounding = EPSILON["single" if self.single else "double"]
        for model, names, get in (
            (self._model, OF_MODEL, of),
            (self._model.opt, OF_OPTIONS, of_options),
        ):
            for name in names:
                asked = getattr(model, name)
                found = np.asarray(get(name), dtype=np.float64).reshape(np.shape(asked))
                if not np.allclose(asked, found, rtol=rounding, atol=0.0):
                    setattr(model, name, found if found.ndim else type(asked)(found))

    @classmethod
    def _batch(
        cls, sessions: Sequence[Self], steps: int, threads: int
    ) -> Callable[[], Sequence[Array]]:
        def given(count: int) -> tuple[Array, Array]:
            controls = np.array([one._controls(count) for one in sessions])
            return controls, np.array([one._led(count) for one in sessions])

        with compiling():
            stepped = cls._put_together(sessions)
            stepped(*given(1))

        def roll() -> Sequence[Array]:
            rows = stepped(*given(steps + 1))
            return [one._taken(each) for one, each in zip(sessions, rows, strict=True)]

        return roll

    @classmethod
    @abstractmethod
    def _put_together(cls, sessions: Sequence[Self]) -> Callable[[Array, Array], Array]:
        """Give the engine the worlds of a batch, and return `_stepped` for all of them."""

    def _roll(self, steps: int) -> Array:
        return self._taken(self._stepped(self._controls(steps + 1), self._led(steps + 1)))

    def _taken(self, rows: Array) -> Array:
        """Return the states after each step; the session goes on from the last."""
        model, data = self._model, self._data
        count = model.nq + model.nv
        self._pushes_there, self._from = rows[:, count:], self._done
        times = data.time + self._dt * np.arange(len(rows))
        states = np.column_stack([times, rows[:, :count]])
        mujoco.mj_setState(model, data, states[-1], FULL)
        return states[1:]

    def _led(self, count: int) -> Array:
        """Return coordinate and rate of the crank before each of the next steps."""
        if not self.single or self._drive != "prescribed":
            return np.full((count, 2), np.nan)
        law, first = self._scene.driver.law, self._done
        place = drives.angles(law, self._start_s, self._dt, first - 1, first + count - 1)
        start = float(law.at(np.array([self._start_s]))[0][0])
        ahead = self._model.qpos0[self._crank] + self._sense * (place - start)
        speed = self._sense * drives.chords(
            law, self._start_s, self._dt, first - 1, first + count - 2
        )
        if not self._shift:
            times = self._start_s + self._dt * (first + np.arange(count, dtype=np.float64))
            speed = self._sense * law.at(times)[1]
        return np.column_stack([ahead[1:], speed])

    def _poses(self, states: Array, at: Array, look: Look | None = None) -> Poses:
        return self._posed(states, at, self._pushes_there[np.rint(at).astype(int) - self._from])


def version_of(own_version: str) -> str:
    """Return the version of such an engine, with that of its MuJoCo."""
    return f"{own_version} (mujoco {VERSION})"
