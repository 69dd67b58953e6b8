"""A run that failed, cut to the time around the failure, to be drawn moving beside the truth."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import cast

import numpy as np

from models.array import Array
from models.errors import CrankcheckError
from models.motion import Motion
from reports.drawing.moving import INSTANTS, displacements, drawing, drawn_links, moving_points
from reports.output.numbers import DIGITS, finite
from reports.stability.case import Case, Trial
from reports.stability.matrix import Graded, Picture
from sim.engine import Run

BEFORE = 0.3
"""How much of a turn is shown before the place of the failure, of one turn in all."""


def picture(
    case: Case, trial: Trial, graded: Graded, run: Run, truth: Callable[[Trial, Array], Motion]
) -> Picture | None:
    """The picture of a graded run; None where there is no truth to be drawn there."""
    scene = trial.given  # with the segments of elastic links, which show how these bend
    assert run.motion is not None
    kept = _around(run.motion.time_s, graded.at_s, scene.driver.law.period_s)
    if kept.size < 2:
        return None
    time_s = run.motion.time_s[kept]
    trace: dict[str, Array] = {"time_s": time_s}
    for name in moving_points(scene):
        if name in run.motion.points:
            place = run.motion.points[name].position[kept]
            trace[f"x.{name}"], trace[f"y.{name}"] = place.T
    for name in drawn_links(scene):
        trace[f"theta.{name}"] = run.motion.links[name].theta[kept]
    try:
        true = truth(trial, time_s)
        shape = drawing(scene, time_s, true)
        rows = displacements(scene, trace, time_s, true)
    except CrankcheckError:
        return None
    if rows is None:
        return None
    return Picture(
        case=graded.case,
        engine=graded.engine,
        profile=graded.profile,
        value=graded.value,
        label=graded.label,
        title=f"{case.title}: {case.parameter} {graded.label} {case.unit}".strip(),
        drawing=cast(Mapping[str, object], finite(shape, DIGITS)),
        rows=finite(rows, DIGITS),
    )


def _around(time_s: Array, at_s: float, period_s: float) -> np.ndarray:
    """Samples of one turn about the failure, evenly spread; of the last turn where it has none."""
    end = float(time_s[-1])
    middle = end if math.isnan(at_s) else at_s
    first = max(min(middle - BEFORE * period_s, end - period_s), float(time_s[0]))
    low, high = np.searchsorted(time_s, [first, first + period_s])
    high = min(int(high), len(time_s) - 1)
    return np.unique(np.linspace(int(low), high, INSTANTS).round().astype(np.intp))
