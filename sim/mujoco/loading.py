"""Sizes of a scene's loads while MuJoCo steps, as the controls of their actuators."""

import math
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from typing import Any

import mujoco  # type: ignore[import-untyped]  # ships no stubs
import numpy as np

from models.array import Array
from models.mjcf.forces import sliding_joint
from models.mjcf.tree import Limb, driven_freedom
from models.scene import Scene
from models.scene.characteristics import Constant
from models.scene.loads import Load
from sim.engine import Drive, load_magnitudes

Parts = tuple[float, float, float]
"""Parts of a load, at the begin, the middle and the end of a step."""
INSIDE = 1e-9
"""Distance within its step, in steps, at which the end stages evaluate the load: above the rounding
of times, below any error."""
STAGES = np.array([INSIDE, 0.5, 1.0 - INSIDE])
NODES, WEIGHTS = np.polynomial.legendre.leggauss(6)


class StageClock:
    """The step of RK4, counted from ``first`` on, and its stage, by MuJoCo's clock: stage 0 at its
    start, 1, evaluated twice, in the middle, 2 at its end.

    Two steps share an instant, and each sees its own side of it: a jump on the grid belongs to the
    step that it begins. Halves of steps are counted, as the clock adds up rounding.
    """

    def __init__(self, dt_s: float, first: int) -> None:
        self._halves_per_s, self._first = 2.0 / dt_s, first
        self._last_half = 2 * first  # as after a start: no middle was before

    def at(self, clock_s: float) -> tuple[int, int]:
        """Return step and stage of an evaluation; every one has to call it, in turn."""
        half = round(self._halves_per_s * clock_s)
        step, stage = half // 2 - self._first, half % 2
        if stage == 0 and self._last_half == half - 1:  # after the middle comes the end
            step, stage = step - 1, 2
        self._last_half = half
        return step, stage


def forward_parts(speed: float, change: float) -> Parts:
    """Return the parts of a load that acts in forward motion, of a step that begins at a speed and
    changes it evenly by so much.

    Such a load jumps where the speed of its slider changes its sign. Stages that use their own
    speed see some of the jump, at any instant of it, and the step falls to first order. RK4 adds up
    a step as Simpson's rule does; a load that acts for the first share s of the step keeps its
    impulse, and its moments with time and the square of time, in the parts

        begin  6 s - 9 s^2 + 4 s^3        middle  3 s^2 - 2 s^3        end  4 s^3 - 3 s^2

    The impulse alone is not enough: at a dead centre the slider turns back where the load has no
    lever, which grows from there.
    """
    after = speed + change
    if speed * after >= 0.0:
        whole = float(speed > 0.0 or (speed == 0.0 and after > 0.0))
        return whole, whole, whole
    s = abs(speed / change)
    until = (s * (6.0 - 9.0 * s + 4.0 * s * s), s * s * (3.0 - 2.0 * s), s * s * (4.0 * s - 3.0))
    return until if speed > 0.0 else (1.0 - until[0], 1.0 - until[1], 1.0 - until[2])


def stage_sizes(load: Load, start_s: float, dt_s: float, first: int, count: int) -> Array:
    """Return the sizes (count, 3) of a load over time in the stages of some steps [N or N m].

    A step with a jump or kink has the stages of the parabola with the load's moments with 1, c and
    c^2 over the step, c from 0 to 1. Simpson's rule, which is RK4 for a course over time, then
    gives speed and position as the load does, except for the effect of the motion on it.
    """
    begins = start_s + dt_s * np.arange(first, first + count)
    times = begins[:, None] + dt_s * STAGES
    sizes = load.magnitude(times.ravel()).reshape(times.shape)
    cuts: dict[int, list[float]] = {}
    for kink in load.characteristic.kinks_between(begins[0], start_s + dt_s * (first + count)):
        place = (kink - start_s) / dt_s
        step = math.floor(place)
        if first <= step < first + count and INSIDE < place - step < 1.0 - INSIDE:
            cuts.setdefault(step, []).append(place - step)
    for step, places in cuts.items():
        sizes[step - first] = _parabola(load, start_s + dt_s * step, dt_s, places)
    return np.asarray(sizes)


def _parabola(load: Load, begin_s: float, dt_s: float, cuts: Sequence[float]) -> Array:
    """Return at 0, 1/2 and 1 the parabola nearest to the load over a step, in the mean square: the
    sum of Legendre's P0, P1, P2 with (2 k + 1) times the load's moment with each."""
    ends = np.array([0.0, *sorted(cuts), 1.0])
    half = 0.5 * np.diff(ends)[:, None]
    places = (ends[:-1, None] + half * (1.0 + NODES)).ravel()
    shares = (half * WEIGHTS).ravel() * load.magnitude(begin_s + dt_s * places)
    across = 2.0 * places - 1.0  # from -1 to 1
    mean, slope = shares.sum(), 3.0 * (shares * across).sum()
    bend = 5.0 * (shares * (1.5 * across**2 - 0.5)).sum()
    return np.array([mean - slope + bend, mean - 0.5 * bend, mean + slope + bend])


class Loading:
    """Controls of the loads, the last of the model's controls.

    Loads known ahead are a control of each step (`at_times`), in C throughout. A callback
    (`following`) sets loads that depend on the motion in every evaluation of the forces, from the
    state of then; that costs some microseconds each. It also sets loads over time, and loads of one
    stroke, as steps of RK4 of ``stages_dt_s`` [s] are to see them in their stages (`in_stages`).
    """

    def __init__(
        self,
        scene: Scene,
        model: Any,
        limbs: tuple[Limb, ...],
        drive: Drive,
        start_s: float,
        stages_dt_s: float = 0.0,
    ) -> None:
        self.loads = tuple(scene.loads.values())
        self._scene, self._start_s = scene, start_s
        self.first = int(model.nu) - len(self.loads)
        self._dt, known = stages_dt_s, load_magnitudes.known_ahead
        self._of_motion = [k for k, load in enumerate(self.loads) if not known(load, drive)]
        self._of_time = [
            k
            for k, load in enumerate(self.loads)
            if self._dt and known(load, drive) and not isinstance(load.characteristic, Constant)
        ]
        self._clock: StageClock | None = None
        # Lists, as a callback reads a number of an array ten times as slowly.
        self._sizes: list[list[list[float]]] = []
        self._parts: dict[str, Parts] = {}
        driven, self._sense = driven_freedom(scene, limbs)
        self._crank = int(model.joint(driven).qposadr[0])
        self._turning = {
            load.body: int(model.body(load.body).id) for load in self.loads if load.over == "omega"
        }
        self._slides = {
            slider: int(model.joint(sliding_joint(limbs, slider)).qposadr[0])
            for slider in scene.sliders
        }
        self._of_strokes = {
            load.name: replace(load, stroke="both")
            for load in self.loads
            if self._dt and load.stroke != "both"
        }

    @property
    def by_motion(self) -> list[str]:
        """Loads that depend on the motion, by name."""
        return [self.loads[k].name for k in self._of_motion]

    def at_times(self, time_s: Array) -> Array:
        """Return the controls (T, n), 0 where they follow from the motion."""
        columns = np.zeros((len(time_s), len(self.loads)))
        for k, load in enumerate(self.loads):
            if k not in self._of_motion:
                # Where a load jumps at a sample, its later value holds there.
                after = time_s + INSIDE * self._dt if k in self._of_time else time_s
                columns[:, k] = load_magnitudes.ahead(self._scene, load, after)
        return columns

    @contextmanager
    def following(self) -> Iterator[None]:
        """Let loads follow the motion while MuJoCo works; its callback is one for all models."""
        if not (self._of_motion or self._of_time):
            yield
            return
        mujoco.set_mjcb_control(self._follow)
        try:
            yield
        finally:
            mujoco.set_mjcb_control(None)

    @contextmanager
    def in_stages(self, first: int, count: int) -> Iterator[None]:
        """Set loads over time in their stages, and loads of one stroke by their share of the step,
        while MuJoCo takes ``count`` steps from the step ``first`` on."""
        if self._of_time or self._of_strokes:
            self._clock = StageClock(self._dt, first)
        given = self._start_s, self._dt, first, count
        sizes = [stage_sizes(self.loads[k], *given) for k in self._of_time]
        self._sizes = np.stack(sizes, axis=2).tolist() if sizes else []
        try:
            yield
        finally:
            self._clock, self._sizes = None, []

    def _follow(self, _model: Any, data: Any) -> None:
        controls, first, clock = data.ctrl, self.first, self._clock
        step, stage = (0, 0) if clock is None else clock.at(data.time)
        if self._sizes:
            # MuJoCo puts a state that diverges back to time 0; such a run is thrown away.
            for k, size in zip(self._of_time, self._sizes[max(step, 0)][stage], strict=True):
                controls[first + k] = size
        if not self._of_motion:
            return
        if clock is not None and stage == 0:  # the rate of the speed is that of the stage before
            for name, load in self._of_strokes.items():
                k = self._slides[str(load.slider)]
                change = self._dt * float(data.qacc[k])
                self._parts[name] = forward_parts(float(data.qvel[k]), change)
        for k in self._of_motion:
            load, share = self.loads[k], 1.0
            if clock is not None and load.name in self._of_strokes:
                forward = self._parts[load.name][stage]
                share = forward if load.stroke == "forward" else 1.0 - forward
                load = self._of_strokes[load.name]
            controls[first + k] = share * self.size(load, data)

    def size(self, load: Load, data: Any) -> float:
        """Return the size of a load in the state of the data; all slides are joints, and their
        coordinates are the sliders' displacements."""
        # Hinges and slides have one coordinate and one rate, so both have the same index.
        sliding = {
            name: (float(data.qpos[k]), float(data.qvel[k])) for name, k in self._slides.items()
        }
        omega = float(data.cvel[self._turning[load.body], 2]) if load.over == "omega" else 0.0
        theta = self._sense * float(data.qpos[self._crank])
        return load.size(self._start_s + float(data.time), theta, sliding, omega)
