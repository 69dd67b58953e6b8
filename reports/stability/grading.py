"""One hard run: what the engine does with it, its grade, and a picture where it fails."""

from __future__ import annotations

import math
import time
from dataclasses import replace

from reports.stability.all_cases import YARDSTICKS
from reports.stability.case import Case, Trial
from reports.stability.force_error import force_error
from reports.stability.grades import outcome
from reports.stability.matrix import Graded, Outcome, Picture, label
from reports.stability.picture import picture
from reports.stability.yardstick import Yardstick
from sim.engine import Run
from sim.registry import engine as engine_of
from sim.run import run
from sim.settings import SettingError

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
        Say how far the forces are off as well, of cases that follow their driver, in engines that
        report them.

    Raises
    ------
    CrankcheckError
        The case has no reference at this value, or cannot be run with it; the message is that of
        the reference, or of the engine.
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
    """The grade, and the run where there is one."""
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
    except SettingError as error:
        return replace(blank, outcome="unsupported", reason=str(error)), None
    if done.motion is None or done.status == "unsupported":
        lost: Outcome = "unsupported" if done.status == "unsupported" else "crashed"
        return replace(blank, outcome=lost, reason=done.reason), None
    errors = yardstick.look(trial, done)
    grade = outcome(errors, case.within)
    at = grade.sample
    apart = grade.outcome == "diverged"  # what was logged ends before it came apart
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
