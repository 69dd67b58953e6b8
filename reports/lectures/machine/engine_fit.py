"""Lengths by the derivatives of an engine: a run of it through a turn of the log, differentiated.

The engine's own motion is compared with the log, from a start that the reference assembles. Rows
are those nearest to even angles of the driver; what is left of the angle is made up by the
derivative by the driver.
"""

from __future__ import annotations

import math
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from analytic.gradients.dimensions import dimensions
from analytic.gradients.gradient import gradient_at
from analytic.gradients.length_fit import (
    Differentiated,
    LengthFit,
    LoggedSeries,
    fit_lengths,
)
from models.array import Array
from models.errors import CrankcheckError, EngineError
from models.motion import Motion
from models.scene import Scene
from models.scene.laws import ConstantSpeed
from reports.lectures.machine.engine_gradients import Question, methods_of
from reports.lectures.machine.engine_motions import motions
from sim.engine.gradient import PoseGradient
from sim.engine.settings import profile_of, resolved
from sim.registry import engine

REFERENCE = "reference"
ROWS = 24
"""Rows of a turn that are compared."""


@dataclass(frozen=True)
class FitEnd:
    """End of a fit by one source of derivatives: the lengths, or the reason why there are none;
    the number of motions that were differentiated, and the time [s]."""

    source: str
    found: LengthFit | None
    motions: int
    wall_s: float
    reason: str = ""


def fits(
    scene: Scene,
    drive: Array,
    readings: Sequence[LoggedSeries],
    names: Sequence[str],
    given: Mapping[str, float],
    choices: Sequence[tuple[str, str]],
    steps_per_turn: float,
) -> list[FitEnd]:
    """Fit the same rows by the reference and by each engine with a profile. Raises CrankcheckError
    for a log whose driver turns back, or is no link."""
    rows = turn_rows(scene, drive)
    drive = drive[rows]
    readings = [replace(one, values=one.values[rows]) for one in readings]
    ends = [_end(REFERENCE, gradient_at, scene, drive, readings, names, given)]
    for name, profile in choices:
        own = EngineMotions(name, profile, steps_per_turn)
        ends.append(_end(f"{name} {profile}", own, scene, drive, readings, names, given))
    return ends


def turn_rows(scene: Scene, drive: Array) -> Array:
    """Return the rows of the first turn that are nearest to even angles of the driver."""
    ahead = np.abs(drive - drive[0])
    if scene.driver.slider is not None or (np.diff(ahead) <= 0.0).any():
        raise CrankcheckError(
            f"{scene.name}: an engine's fit needs a link as driver that turns one way in the log"
        )
    targets = np.linspace(0.0, min(math.tau, float(ahead[-1])), ROWS, endpoint=False)
    return np.unique(np.abs(ahead[:, None] - targets).argmin(axis=0))


def _end(
    source: str,
    differentiate: Differentiated,
    scene: Scene,
    drive: Array,
    readings: Sequence[LoggedSeries],
    names: Sequence[str],
    given: Mapping[str, float],
) -> FitEnd:
    count, began = [], time.perf_counter()

    def counted(
        scene: Scene, drive: Array, by: Sequence[str]
    ) -> tuple[Motion, Mapping[str, Motion]]:
        count.append(1)
        return differentiate(scene, drive, by)

    found, reason = None, ""
    try:
        found = fit_lengths(scene, drive, readings, names, given, differentiate=counted)
    except (CrankcheckError, np.linalg.LinAlgError) as error:  # no convergence; nothing determined
        if source == REFERENCE:
            raise
        reason = str(error)
    return FitEnd(source, found, len(count), time.perf_counter() - began, reason)


@dataclass(frozen=True)
class EngineMotions:
    """Motion of an engine at coordinates of the driver, and its derivatives (`Differentiated`)."""

    engine: str
    profile: str
    steps_per_turn: float

    def __call__(
        self, scene: Scene, drive: Array, by: Sequence[str]
    ) -> tuple[Motion, Mapping[str, Motion]]:
        """Run through the coordinates. Raises EngineError where it has no derivatives."""
        speed = math.copysign(scene.driver.law.peak_speed_rad_s, drive[-1] - drive[0])
        step = math.copysign(math.tau / self.steps_per_turn, speed)
        steps = 1 + np.rint((drive - drive[0]) / step).astype(int)
        law = ConstantSpeed(float(drive[0]) - step, speed)
        scene = replace(scene, driver=replace(scene.driver, law=law))
        lead = next(name for name in dimensions(scene) if name.startswith("driver."))
        names = tuple(dict.fromkeys([*by, lead]))
        each, row = np.unique(steps, return_inverse=True)  # near rows may be of one step
        asked = Question(scene, names, tuple(each.tolist()), step / speed, "")
        own, slopes = motions(asked.variation, self._found(asked))
        own = own.each_series(lambda series: series[row])
        slopes = {n: by.each_series(lambda series: series[row]) for n, by in slopes.items()}
        left = drive - (law.start_rad + step * steps)
        units = asked.units

        def made_up(series: Array, slope: Array) -> Array:
            return np.asarray(series + left.reshape(-1, *[1] * (series.ndim - 1)) * slope)

        own = own.each_series(made_up, slopes[lead])
        return own, {n: slopes[n].each_series(partial(np.multiply, 1.0 / units[n])) for n in by}

    def _found(self, asked: Question) -> PoseGradient:
        settings = resolved(profile_of(engine(self.engine), self.profile), None)
        reason = ""
        for method in methods_of(self.engine):
            for found in method(asked.variation, settings, asked.dt_s, asked.steps):
                if not found.refusal and all(name in found.by for name in asked.names):
                    return found
                reason = found.refusal or reason
        raise EngineError(f"no derivatives by lengths: {reason}")
