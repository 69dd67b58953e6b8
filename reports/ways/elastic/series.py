"""Elastic links as segments, beside the exact chain of as many."""

import numpy as np

from models.array import Array
from models.motion import Motion, State
from reports.compare.elastic_truth import ChainTruth, chain_truth
from reports.compare.tracks import length
from reports.stability.case import Trial, Yardstick
from reports.stability.error_series import ErrorSeries, lacking, nearest, widest
from sim.engine import Run

CHAIN = ("segments",)


def elastic_error_series(trial: Trial, run: Run) -> ErrorSeries:
    """The errors of a run of the segments of a scene, with its elastic links as such.

    The error of place is the larger of two: the error of the deflection against the exact chain,
    over the largest deflection, which is the engine's own; and the error of a place against the
    beam, as for rigid links.
    """
    truth = _truth(trial)
    folded = truth.logged(run)
    beside = truth.beside(folded)
    assert beside is not None
    time_s, driver = beside.motion.time_s, beside.driver_rad
    with np.errstate(all="ignore"):  # a broken run is judged, not warned
        bent = [
            length(track.error) / track.scale
            for track in beside.tracks(CHAIN, truth.exact_at(time_s))
        ]
        places = [length(track.error) / track.scale for track in beside.places]
        parts = {
            "a deflection, over the largest,": widest(bent, driver),
            "a place": widest(places, driver),
        }
        gaps = [np.abs(gap) / trial.scene.longest_m for gap in run.gaps.values()]
    return ErrorSeries(
        status=folded.status,
        reason=folded.reason,
        time_s=time_s,
        driver_rad=driver,
        place=np.max(list(parts.values()), axis=0),
        gap=widest(gaps, driver),
        drive=widest([beside.drive], driver),
        crank=beside.crank,
        period_s=trial.scene.driver.law.period_s,
        sine=nearest(trial.scene, beside.reference),
        incomplete=lacking(trial.given, run),
        worst_of_place=max(parts, key=lambda name: float(np.max(parts[name]))),
    )


def elastic_start(trial: Trial) -> State:
    """The state of the segments at time 0, on their periodic motion."""
    return _truth(trial).start


def elastic_motion(trial: Trial, time_s: Array) -> Motion:
    """The exact chain with all of its nodes, to draw."""
    return _truth(trial).exact.motion.at(time_s)


def _truth(trial: Trial) -> ChainTruth:
    return chain_truth(trial.scene, trial.segments, trial.scene.driver.law.period_s)


SERIES = {
    "bend": Yardstick(
        "the deflection, over the largest", elastic_error_series, elastic_motion, elastic_start
    )
}
