"""The last turn of a run at a few instants: its motion, and its errors, with sign; a free run,
which has no turns, in full.

This suffices for a drawing and a curve of error over crank angle, at a hundredth of the whole log.
Series by name: ``time_s``, ``driver_rad`` (commanded), ``drive`` [rad], ``gap`` (the largest of all
pins and sliders) [m]; per link ``theta.LINK``, ``angle.LINK`` and ``geometric.angle.LINK`` [rad];
per slider ``displacement.NAME`` and ``geometric.displacement.NAME`` [m]; per point ``x.P``, ``y.P``
[m]. Names with ``geometric.`` are against the reference at the logged crank angle, the others
against it at the commanded time. Free motion has the series of `free_series` as well.
"""

from collections.abc import Iterable, Mapping
from contextlib import suppress

import numpy as np

from models.array import Array
from models.errors import CrankcheckError
from models.scene import Scene
from reports.compare import compare, free_truth, tracks
from reports.quantities import named
from sim.engine import Run

Trace = Mapping[str, Array]
"""Series by name."""
SAMPLES_PER_TURN = 90
"""Divides the usual numbers of steps in a turn, so that cells of a line share their instants."""


def trace(truth: compare.Truth, run: Run) -> Trace:
    """Return the series of a run; empty where it logged nothing that is finite."""
    scene = truth.scene
    if run.motion is None or run.motion.time_s.size < 2:
        return {}
    kept = _instants(scene, run)
    beside = truth.beside(compare.each_at(run, lambda series: series[kept]))
    assert beside is not None
    series = {
        "time_s": beside.motion.time_s,
        "driver_rad": beside.driver_rad,
        "drive": beside.drive,
        "gap": np.max([np.abs(gap) for gap in beside.run.gaps.values()], axis=0, initial=0.0),
    }
    series |= _errors(beside.places, "")
    # Where the logged crank left its range, or is not finite, the total error says it.
    with suppress(CrankcheckError, ValueError):
        series |= _errors(beside.tracks(named("place"), beside.at_crank), "geometric.")
    for name, link in beside.motion.links.items():
        series[f"theta.{name}"] = link.theta
    for name, point in beside.motion.points.items():
        series[f"x.{name}"], series[f"y.{name}"] = point.position.T
    for name, own in beside.motion.elastic.items():
        series[f"deflection.{name}"] = own.middle
        series[f"deflection_error.{name}"] = own.middle - beside.reference.elastic[name].middle
    if isinstance(beside, free_truth.FreeBeside):
        series |= free_series(beside)
    return {name: np.ascontiguousarray(each) for name, each in series.items()}


def _instants(scene: Scene, run: Run) -> np.ndarray:
    """Return the kept samples: the last turn, in parts as equal as the steps allow."""
    assert run.motion is not None
    times = run.motion.time_s
    step_s = run.dt_s * run.every
    per_turn = scene.driver.law.period_s / step_s
    span = min(round(per_turn), times.size - 1)
    wanted = SAMPLES if scene.is_free else SAMPLES_PER_TURN
    parts = min(max(round(wanted * span / per_turn), 1), span)
    return np.round(times.size - 1 - span + np.linspace(0, span, parts + 1)).astype(np.intp)


def _errors(placed: Iterable[tracks.Track], prefix: str) -> Mapping[str, Array]:
    """Return the errors of links and sliders, which have a sign."""
    return {
        f"{prefix}{track.quantity}.{track.body}": track.error
        for track in placed
        if track.body_kind != "point"
    }


SAMPLES = 720
"""Samples of a whole free run: some fifty in a swing of a mechanism that lasts ten seconds."""


def free_series(beside: free_truth.FreeBeside) -> Mapping[str, Array]:
    """Return series by name, (T,) each, of a run that was thinned out to the kept instants.

    ``phase`` [rad] is the driver's error at the same time, ``growth`` the sensitivity, ``omega``
    the driver's logged angular velocity [rad/s]. Where the engine has an energy, ``energy`` [J] is
    that, less the work of loads and dampers by the reference, and less its value at the start;
    ``kinetic`` the true kinetic energy [J].
    """
    run = beside.run
    series = {"phase": beside.drive, "growth": beside.growth}
    if driver := beside.motion.links.get(beside.scene.driver.link):
        series["omega"] = driver.omega
    if run.energy is not None and run.velocity_time_s is not None:
        known = beside.free.energy(np.clip(run.velocity_time_s, 0.0, beside.free.until_s))
        own = run.energy.total_j - known.work
        series |= {"energy": own - own[0], "kinetic": known.kinetic}
    return series
