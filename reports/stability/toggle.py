"""A four-bar that is thrown at its toggle: whether it gets over is the question."""

from __future__ import annotations

import numpy as np

from models.array import Array
from models.motion import Motion, State
from reports.compare.errors import Departure
from reports.compare.free.hard_runs import OVER, toggle_passage
from reports.stability.case import Throw, Trial
from reports.stability.error_series import ErrorSeries, lacking, widest, worst_of
from sim.engine import Run


def at_toggle(trial: Trial, run: Run) -> ErrorSeries:
    """A run beside what its energy lets it do.

    One that gets over and should not has left its branch. For one that should and does not, the
    error of place is the angle that coupler and rocker were short of where it would have been over,
    at the nearest [rad].
    """
    motion, throw = run.motion, _throw(trial)
    assert motion is not None
    crank = motion.links[trial.scene.driver.link].theta
    passage = toggle_passage(throw.barrier, run)
    place, left = np.zeros_like(crank), None
    over = throw.margin > 0.0
    if passage.outcome == "over" and not over:
        _, other = throw.barrier.links
        at = passage.index
        left = Departure(other, float(motion.time_s[at]), float(crank[at]))
    elif passage.outcome == "undecided" or (passage.outcome == "back" and over):
        short = passage.nearest_rad - OVER * abs(throw.barrier.open_rad)
        place[passage.index :] = short
    gaps = [np.abs(gap) / trial.scene.longest_m for gap in run.gaps.values()]
    decided = np.arange(crank.size) <= passage.index
    return ErrorSeries(
        status=run.status,
        reason=run.reason,
        time_s=motion.time_s,
        driver_rad=worst_of(crank),
        place=place,
        gap=np.where(decided, widest(gaps, crank), 0.0),  # what comes after it is not asked
        drive=np.full_like(crank, np.nan),
        crank=worst_of(crank),
        period_s=trial.scene.driver.law.period_s,
        departure=left,
        sine=0.0,
        incomplete=lacking(trial.scene, run),
        worst_of_place="the angle of coupler and rocker, short of being over,",
    )


def thrown_start(trial: Trial) -> State:
    """The state that it is thrown in."""
    throw = _throw(trial)
    return throw.barrier.start(throw.margin)


def thrown_motion(trial: Trial, time_s: Array) -> Motion:
    """The truth to be drawn."""
    from analytic.free.release import release  # slow to import, for free motion alone

    return release(trial.scene, trial.steps * trial.dt_s).at(time_s, bound=False)


def _throw(trial: Trial) -> Throw:
    assert trial.throw is not None
    return trial.throw
