"""A machine in free motion, beside the motion that its masses and forces give it."""

from dataclasses import replace

import numpy as np

from models.array import Array
from models.errors import CrankcheckError
from models.motion import Motion, State
from reports.compare.branch import free_departure
from reports.compare.compare import first_samples
from reports.compare.free_facts import window_means
from reports.compare.free_truth import FreeBeside, FreeTruth, free_truth
from reports.compare.tracks import Track, length, tracks
from reports.quantities.free_and_elastic import GEOMETRY, PHASE
from reports.stability.case import Trial, Yardstick
from reports.stability.error_series import ErrorSeries, lacking, nearest, widest
from reports.stability.other_truths import at_toggle, thrown_motion, thrown_start
from sim.engine import Run

LOOKS = 1001
"""Number of instants in the search for the largest kinetic energy."""


def free_error_series(trial: Trial, run: Run) -> ErrorSeries:
    """The errors of a run of a scene that loses no energy, against its free motion.

    The error of place is the largest of three: that of phase and places at the same time, over the
    sensitivity, as far as the reference is followed and known; that of the places at the run's own
    driver angle; and the drift of the energy, over the largest kinetic energy.
    """
    motion = run.motion
    assert motion is not None
    truth = _truth(trial)
    followed = int(np.searchsorted(motion.time_s, trial.followed_s * (1.0 + 1e-9), "right"))
    known = truth.beside(first_samples(run, followed))
    assert isinstance(known, FreeBeside)
    whole = FreeBeside(truth, run, motion, whole_run=run, free=truth.free)
    with np.errstate(all="ignore"):  # a broken run is judged, not warned
        same_time = np.zeros_like(motion.time_s)
        same_time[: known.motion.time_s.size] = _same_time(known)
        parts = {
            "the phase, or a position at the same time, over the sensitivity": same_time,
            "a position at the run's own angle": _geometry(whole),
            "the energy, over the largest kinetic one,": _energy(whole),
        }
        gaps = [np.abs(gap) / trial.scene.longest_m for gap in run.gaps.values()]
    return ErrorSeries(
        status=run.status,
        reason=run.reason,
        time_s=motion.time_s,
        driver_rad=whole.crank,
        place=np.max(list(parts.values()), axis=0),
        gap=widest(gaps, motion.time_s),
        drive=np.full_like(motion.time_s, np.nan),
        crank=whole.crank,
        period_s=trial.scene.driver.law.period_s,
        departure=free_departure(known),
        sine=nearest(trial.scene, known.reference),
        incomplete=lacking(trial.scene, run),
        worst_of_place=max(parts, key=lambda name: float(np.max(parts[name]))),
    )


def free_start(trial: Trial) -> State:
    """The state at time 0, with the accelerations that the masses and forces give."""
    return _truth(trial).start


def free_motion(trial: Trial, time_s: Array) -> Motion:
    """The reference motion to draw. Raises CrankcheckError where it is no longer followed."""
    return replace(_truth(trial).at(time_s), bound=None)


def _truth(trial: Trial) -> FreeTruth:
    """The integrated motion, as far as it is followed; kept from one run to the next."""
    steps = min(float(trial.steps), trial.followed_s / trial.dt_s)
    return free_truth(trial.scene, round(steps), trial.dt_s)


def _same_time(known: FreeBeside) -> Array:
    """The worst error of phase and place at the same time over the sensitivity (T,)."""
    places = (*known.tracks((PHASE.name,), known.reference), *known.places)
    time_s = known.motion.time_s
    return widest([_pure(known.judged(track, time_s)) for track in places], time_s)


def _geometry(whole: FreeBeside) -> Array:
    """The worst error of place at the run's own driver angle (T,); 0 where that has left its range,
    which other errors show."""
    none = np.zeros_like(whole.motion.time_s)
    if not np.isfinite(whole.crank).all():
        return np.full_like(none, np.inf)
    try:
        beside = whole.at_crank
    except CrankcheckError:
        return none
    # Not those of `whole`: they need the reference at the same time, which is followed less far.
    places = tracks(whole.scene, whole.run, beside, (GEOMETRY.name,))
    return widest([_pure(track) for track in places], none)


def _energy(whole: FreeBeside) -> Array:
    """Drift of the mean energy around each sample since the first such mean, over the largest
    kinetic energy (T,): means, as the energy also comes and goes with the motion."""
    energy, time_s = whole.run.energy, whole.motion.time_s
    if energy is None:
        return np.zeros_like(time_s)
    means = window_means(whole.scene, time_s, energy.total_j)
    instants = np.linspace(0.0, whole.free.until_s, LOOKS)
    largest = float(np.max(whole.free.energy(instants).kinetic))
    if not np.isfinite(energy.total_j).all():
        return np.full_like(time_s, np.inf)
    whiles = np.flatnonzero(np.isfinite(means))  # none reaches beyond the log
    drift = np.zeros_like(time_s)
    if whiles.size:
        drift[whiles] = np.abs(means[whiles] - means[whiles[0]]) / largest
    return drift


def _pure(track: Track) -> Array:
    return np.asarray(length(track.error) / track.scale)


SERIES = {
    "free-motion": Yardstick(
        "free motion at the same time over the sensitivity, at the run's own angle, and its energy",
        free_error_series,
        free_motion,
        free_start,
    ),
    "toggle": Yardstick(
        "distance of a throw from getting over, rad", at_toggle, thrown_motion, thrown_start
    ),
}
