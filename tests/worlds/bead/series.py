"""Hard runs of beads, beside the swing."""

import numpy as np

from models.array import Array
from models.motion import Motion, State
from reports.compare.tracks import length
from reports.stability.case import Trial, Yardstick
from reports.stability.error_series import ErrorSeries, lacking, widest
from sim.engine import Run
from tests.worlds.bead.truth import BeadTruth


def look(trial: Trial, run: Run) -> ErrorSeries:
    """The largest error of the angle, or of a place, at each sample."""
    beside = BeadTruth(trial.scene).beside(run)
    assert beside is not None
    time_s = beside.motion.time_s
    errors = [length(track.error) / track.scale for track in beside.places]
    return ErrorSeries(
        status=run.status,
        reason=run.reason,
        time_s=time_s,
        driver_rad=beside.driver_rad,
        place=widest(errors, time_s),
        gap=np.zeros_like(time_s),
        drive=np.full_like(time_s, np.nan),
        crank=beside.crank,
        period_s=trial.scene.driver.law.period_s,
        sine=1.0,
        incomplete=lacking(trial.scene, run),
    )


def motion(trial: Trial, time_s: Array) -> Motion:
    return BeadTruth(trial.scene).at(time_s)


def start(trial: Trial) -> State:
    return BeadTruth(trial.scene).start


SERIES = {"bead": Yardstick("a bead, rad or over the spoke", look, motion, start)}
