"""The sizes of a scene's loads while MuJoCo steps, as the controls of their actuators."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from typing import Any

import mujoco  # type: ignore[import-untyped]  # ships no stubs
import numpy as np

from models.array import Array
from models.characteristics import Constant
from models.loads import Load
from models.scene import Scene
from models.tree import Limb, driven_freedom
from sim.engine import Drive
from sim.load_magnitudes import ahead, known_ahead
from sim.mujoco.load_stages import INSIDE, LoadStages
from sim.mujoco.stroke_shares import StrokeShares


class Loading:
    """The controls of the loads, which are the last of the model's.

    What is known ahead is a control of each step (`at_times`), in C throughout. What depends on the
    motion is set by a callback (`following`) in every evaluation of the forces, four times a step
    of RK4, from the state of then; that costs some microseconds each. So are loads over time where
    ``stages_dt_s`` says that steps of RK4, of that length [s], are to see them in their stages
    (`in_stages`), and loads of one stroke with their share of the step.
    """

    def __init__(
        self,
        scene: Scene,
        model: Any,
        limbs: tuple[Limb, ...],
        drive: Drive,
        start_s: float,
        stages_dt_s: float | None = None,
    ) -> None:
        self.loads = tuple(scene.loads.values())
        self._scene, self._start_s = scene, start_s
        self.first = int(model.nu) - len(self.loads)
        of_motion = [not known_ahead(load, drive) for load in self.loads]
        self._of_motion = [k for k, follows in enumerate(of_motion) if follows]
        self._dt = stages_dt_s or 0.0
        self._of_time = [
            k
            for k, load in enumerate(self.loads)
            if self._dt and not of_motion[k] and not isinstance(load.characteristic, Constant)
        ]
        self._stages: LoadStages | None = None
        self._shares: StrokeShares | None = None
        driven, self._sense = driven_freedom(scene, limbs)
        self._crank = int(model.joint(driven).qposadr[0])
        self._turning = {
            load.body: int(model.body(load.body).id) for load in self.loads if load.over == "omega"
        }
        self._slides = {
            limb.slider.name: int(model.joint(freedom.name).qposadr[0])
            for limb in limbs
            if limb.slider is not None
            for freedom in limb.freedoms
            if freedom.kind == "slide"
        }
        self._of_strokes = {
            load.name: replace(load, stroke="both")
            for load in self.loads
            if self._dt and load.stroke != "both"
        }

    def at_times(self, time_s: Array) -> Array:
        """The controls (T, n), 0 where they follow from the motion."""
        columns = np.zeros((len(time_s), len(self.loads)))
        for k, load in enumerate(self.loads):
            if k not in self._of_motion:
                # Where a load jumps at a sample, what comes after it holds there.
                after = time_s + INSIDE * self._dt if k in self._of_time else time_s
                columns[:, k] = ahead(self._scene, load, after)
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

    @contextmanager
    def in_stages(self, first: int, count: int) -> Iterator[None]:
        """Let loads over time be those of the stages, and loads of one stroke have their share of
        the step, while MuJoCo takes ``count`` steps from the step ``first`` on."""
        if not (self._of_time or self._of_strokes):
            yield
            return
        before = mujoco.get_mjcb_control()
        loads = [self.loads[k] for k in self._of_time]
        if loads:
            self._stages = LoadStages(loads, self._start_s, self._dt, first, count)
        if self._of_strokes:
            sliders = dict.fromkeys(str(load.slider) for load in self._of_strokes.values())
            places = {name: self._slides[name] for name in sliders}
            self._shares = StrokeShares(places, self._dt, first)
        mujoco.set_mjcb_control(self._follow)
        try:
            yield
        finally:
            self._stages = self._shares = None
            mujoco.set_mjcb_control(before)

    def _follow(self, _model: Any, data: Any) -> None:
        controls, first = data.ctrl, self.first
        forward = self._shares.at(data) if self._shares is not None else None
        for k in self._of_motion:
            load = self.loads[k]
            if forward is None or load.name not in self._of_strokes:
                controls[first + k] = self.size(load, data)
                continue
            share = forward[str(load.slider)]
            share = share if load.stroke == "forward" else 1.0 - share
            controls[first + k] = share * self.size(self._of_strokes[load.name], data)
        if self._stages is not None:
            for k, size in zip(self._of_time, self._stages.at(data.time), strict=True):
                controls[first + k] = size

    def size(self, load: Load, data: Any) -> float:
        """The size of a load in the state of the data; all slides are joints, and read as the
        sliders' displacements."""
        # Hinges and slides have one coordinate and one rate, so both stand at one place.
        sliding = {
            name: (float(data.qpos[k]), float(data.qvel[k])) for name, k in self._slides.items()
        }
        omega = float(data.cvel[self._turning[load.body], 2]) if load.over == "omega" else 0.0
        theta = self._sense * float(data.qpos[self._crank])
        return load.size(self._start_s + float(data.time), theta, sliding, omega)
