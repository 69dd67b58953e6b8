"""Derivatives of MuJoCo's states: by its own transition matrices, and by differences of runs.

`mjd_transitionFD` differentiates a step by the state before it. Its products over the steps, times
the derivative of the start, are those of dimensions that move the start alone; lengths and masses
change the model as well.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import mujoco  # type: ignore[import-untyped]  # ships no stubs
import numpy as np

from models.array import Array
from models.motion import State
from models.scene import Scene
from sim.engine import Settings
from sim.engine.gradient import (
    OFFSETS,
    STEP,
    SWEEP,
    PoseGradient,
    Variation,
    differences,
    placed,
    slope,
    steadiest,
)
from sim.mujoco import settings as own
from sim.mujoco.engine import MujocoSession
from sim.mujoco.stepped import FULL


@dataclass(frozen=True)
class SceneNeighbours:
    """A scene in MuJoCo at its start, and its neighbours by each dimension (`Variation`)."""

    here: MujocoSession
    near: Mapping[str, Sequence[MujocoSession]]

    @staticmethod
    def of(variation: Variation, settings: Settings, dt_s: float) -> "SceneNeighbours":
        """Open all sessions. Raises EngineError."""

        def opened(scene: Scene, state: State) -> MujocoSession:
            return MujocoSession(scene, state, settings, dt_s, "prescribed")

        every = {
            name: [opened(*one) for one in variation.neighbours(name)] for name in variation.names
        }
        return SceneNeighbours(opened(variation.scene, variation.state), every)

    def start_slope(self, name: str) -> tuple[Array, Array]:
        """Return the derivatives of joint coordinates and rates at the start."""
        data = [session._data for session in self.near[name]]
        return slope([each.qpos for each in data]), slope([each.qvel for each in data])

    def result(self, method: str, q: Array, slopes: Mapping[str, Array]) -> PoseGradient:
        """Return the places from joint coordinates (K, n), and their derivatives from those of the
        coordinates: the lengths in between change as well."""
        by = {
            name: slope(
                [
                    placed(one._scene, one.bodies_at(q + offset * STEP * slopes[name]))
                    for offset, one in zip(OFFSETS, self.near[name], strict=True)
                ]
            )
            for name in slopes
        }
        return PoseGradient(method, placed(self.here._scene, self.here.bodies_at(q)), by)


def transitions(
    opened: SceneNeighbours, names: Sequence[str], steps: Sequence[int], eps: float
) -> tuple[Array, Array]:
    """Return the joint coordinates after steps (K, n), and their derivatives by the start
    (K, n, P), from matrices differenced at ``eps``."""
    model, last = opened.here._model, max(steps)
    data, found = mujoco.MjData(model), []
    controls = opened.here._controls(last) if model.nu else np.empty((last, 0))
    slopes = np.array([np.concatenate(opened.start_slope(name)) for name in names]).T
    matrix = np.zeros((len(slopes), len(slopes)))
    with opened.here._at_work():
        mujoco.mj_setState(model, data, opened.here._full_state(), FULL)
        for number in range(1, last + 1):
            data.ctrl[:] = controls[number - 1]
            mujoco.mjd_transitionFD(model, data, eps, True, matrix, None, None, None)
            mujoco.mj_step(model, data)
            slopes = matrix @ slopes
            if number in steps:
                found.append((data.qpos.copy(), slopes[: model.nv]))
    q, by = zip(*found, strict=True)
    return np.array(q), np.array(by)


def gradient(
    variation: Variation, settings: Settings, dt_s: float, steps: Sequence[int]
) -> Iterator[PoseGradient]:
    """Differentiate by the start with `mjd_transitionFD`, and by everything with whole runs."""
    names = [name for name in variation.names if name.startswith("driver.")]
    method = "mjd_transitionFD"
    if own.integrator(settings, "prescribed") == "RK4":
        yield PoseGradient(method, refusal="it takes no RK4")
    elif names:
        start = SceneNeighbours.of(replace(variation, names=tuple(names)), settings, dt_s)
        every = [transitions(start, names, steps, eps) for eps in SWEEP]
        best = steadiest([by for _, by in every])
        yield start.result(method, every[0][0], {n: best[:, :, i] for i, n in enumerate(names)})
    yield differences(MujocoSession, variation, settings, dt_s, steps)


GRADIENT = gradient
