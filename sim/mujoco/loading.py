"""The sizes of a scene's loads while MuJoCo steps, as the controls of their actuators."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import mujoco  # type: ignore[import-untyped]  # ships no stubs
import numpy as np

from models.array import Array
from models.loads import Load
from models.mjcf_options import driver_joint
from models.scene import Scene
from models.tree import Limb
from sim.engine import Drive
from sim.load_magnitudes import ahead, known_ahead


class Loading:
    """The controls of the loads, which are the last of the model's.

    What is known ahead is a control of each step (`at_times`), in C throughout. What depends on the
    motion is set by a callback (`following`) in every evaluation of the forces, four times a step
    of RK4, from the state of then; that costs some microseconds each.
    """

    def __init__(
        self, scene: Scene, model: Any, limbs: tuple[Limb, ...], drive: Drive, start_s: float
    ) -> None:
        self.loads = tuple(scene.loads.values())
        self._scene, self._start_s = scene, start_s
        self.first = int(model.nu) - len(self.loads)
        self._of_motion = [k for k, load in enumerate(self.loads) if not known_ahead(load, drive)]
        self._crank = int(model.joint(driver_joint(scene)).qposadr[0])
        self._slides = {
            limb.slider.name: int(model.joint(freedom.name).qposadr[0])
            for limb in limbs
            if limb.slider is not None
            for freedom in limb.freedoms
            if freedom.kind == "slide"
        }

    def at_times(self, time_s: Array) -> Array:
        """The controls (T, n), 0 where they follow from the motion."""
        columns = np.zeros((len(time_s), len(self.loads)))
        for k, load in enumerate(self.loads):
            if k not in self._of_motion:
                columns[:, k] = ahead(self._scene, load, time_s)
        return columns

    @contextmanager
    def following(self) -> Iterator[None]:
        """Let loads follow the motion while MuJoCo works; its callback is one for all models."""
        if not self._of_motion:
            yield
            return
        mujoco.set_mjcb_control(self._follow)
        try:
            yield
        finally:
            mujoco.set_mjcb_control(None)

    def _follow(self, _model: Any, data: Any) -> None:
        for k in self._of_motion:
            data.ctrl[self.first + k] = self.size(self.loads[k], data)

    def size(self, load: Load, data: Any) -> float:
        """The size of a load in the state of the data; all slides are joints, and read as the
        sliders' displacements."""
        # Hinges and slides have one coordinate and one rate, so both stand at one place.
        sliding = {
            name: (float(data.qpos[k]), float(data.qvel[k])) for name, k in self._slides.items()
        }
        omega = float(data.body(load.body).cvel[2]) if load.over == "omega" else 0.0
        theta = float(data.qpos[self._crank])
        return load.size(self._start_s + float(data.time), theta, sliding, omega)
