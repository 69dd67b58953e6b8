"""One hard run: the run in the engine, its grade, and a picture where it fails."""

import math
import time
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import cast

import numpy as np

from models.array import Array
from models.errors import CrankcheckError
from models.motion import Motion
from models.scene import Scene
from reports.compare import compare, whole_errors
from reports.drawing.moving import INSTANTS, displacements, drawing, drawn_links, moving_points
from reports.output.numbers import DIGITS, finite
from reports.protocol.way import own_parts
from reports.stability.case import Case, Trial, Yardstick, yardsticks
from reports.stability.grades import outcome
from reports.stability.matrix import Graded, Outcome, Picture, label
from sim.engine import Run, settings
from sim.registry import engine as engine_of
from sim.run import run
from sim.run.check import OtherModelError

YARDSTICKS = yardsticks()
GROUPS = {
    group: cases
    for part in own_parts("cases").values()
    for group, cases in cast(Mapping[str, tuple[Case, ...]], part).items()
}
CATALOGUE: dict[str, Case] = {
    case.name: replace(
        case,
        group=group,
        way=YARDSTICKS[case.judge][0],
        error_of=YARDSTICKS[case.judge][1].error_of,
    )
    for group, cases in GROUPS.items()
    for case in cases
}


GradedPicture = tuple[Graded, Picture | None]


def graded(
    case: Case, engine: str, profile: str, value: float, *, draw: bool, forces: bool = False
) -> GradedPicture:
    """Run a case at one value in one engine, and grade it.

    Parameters
    ----------
    draw : bool
        Give a picture where the outcome is not one of the case's good ones.
    forces : bool
        Add the error of the forces, for cases that follow their driver, in engines that report
        them.

    Raises
    ------
    CrankcheckError
        The case has no reference at this value, or cannot be run with it; the message comes from
        the reference, or the engine.
    """
    began = time.perf_counter()
    trial = case.trial(value)
    blank = Graded(case.name, engine, profile, value, label(value), "ok", "")
    yardstick = YARDSTICKS[case.judge][1]
    asked = forces and yardstick.with_forces and engine_of(engine).forces_of != "nothing"
    result, done = _graded(case, trial, blank, yardstick, forces=asked)
    result = replace(result, wall_s=time.perf_counter() - began)
    if not draw or done is None or result.outcome in case.good:
        return result, None
    return result, picture(case, trial, result, done, yardstick.motion)


def _graded(
    case: Case, trial: Trial, blank: Graded, yardstick: Yardstick, *, forces: bool
) -> tuple[Graded, Run | None]:
    blank = replace(blank, steps=trial.steps, dt_s=trial.dt_s)
    state = yardstick.start(trial)
    try:
        done = run(
            trial.given,
            state,
            blank.engine,
            blank.profile,
            dt_s=trial.dt_s,
            steps=trial.steps,
            every=trial.every,
            drive=trial.drive,
            settings=trial.settings,
            open_m=trial.open_m,
            with_forces=forces,
        )
    except (settings.SettingError, OtherModelError) as error:
        return replace(blank, outcome="unsupported", reason=str(error)), None
    if done.motion is None or done.status == "unsupported":
        lost: Outcome = "unsupported" if done.status == "unsupported" else "crashed"
        return replace(blank, outcome=lost, reason=done.reason), None
    errors = yardstick.look(trial, done)
    grade = outcome(errors, case.within)
    at = grade.sample
    apart = grade.outcome == "diverged"  # the log ends before it came apart
    result = replace(
        blank,
        outcome=grade.outcome,
        reason=grade.reason,
        error=math.nan if apart else errors.worst(errors.place)[0],
        gap=math.nan if apart else errors.worst(errors.gap)[0],
        drive=errors.worst(errors.drive)[0],
        sine=errors.sine,
        at_s=math.nan if at is None else float(errors.time_s[at]),
        at_driver_rad=math.nan if at is None else float(errors.driver_rad[at]),
        force=math.nan if apart else force_error(trial.scene, done, trial.settled_turns),
    )
    return result, done


def force_error(scene: Scene, run: Run, settled_turns: float = 0.0) -> float:
    """Return the worst error of a reaction, normal force, moment or torque, as a share of the
    largest of its kind, from ``settled_turns`` on; infinite where a number is missing, NaN where
    there is no reference of forces (nothing has a mass, or the motion is not the driver's)."""
    motion = run.motion
    if not run.with_forces or motion is None:
        return math.nan
    first_s = motion.time_s[0] + settled_turns * scene.driver.law.period_s
    kept = slice(min(int(np.searchsorted(motion.time_s, first_s)), motion.time_s.size - 1), None)
    cut = replace(
        motion.each_series(lambda series: series[kept]),
        time_s=motion.time_s[kept],
        forces=motion.forces and motion.forces.stretch(kept),
    )
    settled = replace(
        run, motion=cut, forces_of="states" if kept.start else run.forces_of
    )  # the start, where steps have no forces, is cut off
    beside = compare.Truth(scene, bound=False).beside(settled)
    try:
        rows = whole_errors.force_rows(beside).rows if beside else ()
    except CrankcheckError:
        return math.nan
    sizes = [row.pure if row.finite else math.inf for row in rows if row.kind != "start"]
    return max(sizes, default=math.nan)


BEFORE = 0.3
"""Part of a turn that is shown before the place of the failure, of one turn in all."""


def picture(
    case: Case, trial: Trial, graded: Graded, run: Run, truth: Callable[[Trial, Array], Motion]
) -> Picture | None:
    """Return the picture of a graded run; None where there is no reference to be drawn."""
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
    """Return samples of one turn about the failure, evenly spread; of the last turn without one."""
    end = float(time_s[-1])
    middle = end if math.isnan(at_s) else at_s
    first = max(min(middle - BEFORE * period_s, end - period_s), float(time_s[0]))
    low, high = np.searchsorted(time_s, [first, first + period_s])
    high = min(int(high), len(time_s) - 1)
    return np.unique(np.linspace(int(low), high, INSTANTS).round().astype(np.intp))
