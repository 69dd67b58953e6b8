"""The errors of a free run: phase, positions and rates at the same time over the sensitivity of the
motion, the geometry at the run's own angle, and conserved quantities."""

import sys
from collections.abc import Iterable
from dataclasses import replace

import numpy as np

from analytic.forces.late_impulses import late_impulses
from models.array import Array
from models.errors import CrankcheckError
from models.scene.joints import has_loops
from reports.compare import branch, compare, hardness
from reports.compare.error_rows import Instants, instants_of, whole_row, whole_rows
from reports.compare.errors import Error, Errors
from reports.compare.free_facts import FreeFacts, energy_rows, momentum_rows, window_s
from reports.compare.free_truth import FreeBeside
from reports.compare.tracks import Track, length
from reports.compare.whole_errors import TWICE, ComparedParts, force_rows, whole_errors
from reports.quantities.free_and_elastic import GEOMETRY, PHASE

COURSE = 400
"""Instants at which the growth of the errors is kept."""
LEAST_SINE = 0.3
"""Least sine of a transmission angle where the driver passes a limit of its own: near it the
geometry belongs to another coordinate, which is not singular there."""
STILL = 1e-12
"""Speed below which the driver is at rest, over its largest."""


def compared(beside: compare.Beside, errors: Errors | None) -> Errors:
    """Return the errors of a free run, as far as the reference is known; no module comes before."""
    assert isinstance(beside, FreeBeside)
    reference, scene = beside.reference, beside.scene
    at = instants_of(beside, beside.motion.time_s, reference)
    same_time = _same_time(beside)
    geometry, notes = _geometry(beside, at)
    facts = _facts(beside, same_time)
    borne = force_rows(beside)
    least = LEAST_SINE if facts.passages else 0.0
    farthest = float(np.max(np.abs(at.driver_rad)))
    parts = ComparedParts(
        placed=[*_phase_and_places(beside, same_time, at), *geometry],
        notes=(*notes, *_notes(beside, facts)),
        borne=replace(borne, facts=replace(borne.facts, load_slopes={}), unsure={}),
        departure=branch.free_departure(beside),
        conditioning=max(hardness.conditioning(reference, at.driver_rad), least),
        summed_rad=TWICE * beside.run.steps * sys.float_info.epsilon / 2.0 * farthest,
        # In an open chain joint coordinates are as good as their integrator: nothing is too near.
        far=hardness.uneven(scene, reference, at.driver_rad) if has_loops(scene) else {},
        motion=facts,
        conserved=[*energy_rows(beside), *momentum_rows(beside)],
    )
    return whole_errors(beside, at, parts)


def places(beside: compare.Beside) -> list[Error]:
    """Return phase, positions at the same time, geometry and gaps alone."""
    assert isinstance(beside, FreeBeside)
    at = instants_of(beside, beside.motion.time_s, beside.reference)
    return [
        *_phase_and_places(beside, _same_time(beside), at),
        *_geometry(beside, at)[0],
        *whole_rows(beside, at, "closure"),
    ]


def _same_time(beside: FreeBeside) -> tuple[Track, ...]:
    """Return the phase and all positions against the reference at the same time, unscaled."""
    return (*beside.tracks((PHASE.name,), beside.reference), *beside.places)


def _phase_and_places(beside: FreeBeside, tracks: Iterable[Track], at: Instants) -> Iterable[Error]:
    """Yield errors at the same time, unscaled and over the sensitivity."""
    for track in tracks:
        yield whole_row(beside.judged(track, at.time_s), at)
        yield whole_row(track, at, kind="raw")


def _geometry(beside: FreeBeside, at: Instants) -> tuple[list[Error], tuple[str, ...]]:
    """Return errors at the run's own coordinate, or a note with the reason for none."""
    if beside.no_geometry:
        return [], (beside.no_geometry,)
    try:
        tracks = beside.tracks((GEOMETRY.name,), beside.at_crank)
    except CrankcheckError as error:
        return [], (f"no geometry: the run left the range of its own coordinate ({error})",)
    return [whole_row(track, at) for track in tracks], ()


def _facts(beside: FreeBeside, same_time: Iterable[Track]) -> FreeFacts:
    """Return the growth of the errors, at `COURSE` instants."""
    worst: Array = np.zeros_like(beside.motion.time_s)
    for track in same_time:
        pure = length(track.error) / track.scale
        worst = np.maximum(worst, np.where(np.isfinite(pure), pure, np.inf))
    kept = np.unique(np.linspace(0, worst.size - 1, COURSE).round().astype(np.intp))
    raw, judged = np.maximum.accumulate(worst), np.maximum.accumulate(worst / beside.growth)
    time_s, scene = beside.motion.time_s, beside.scene
    speed, peak = np.abs(beside.driver_speed), scene.pace_rad_s
    turned = np.cumsum(np.diff(time_s, prepend=time_s[0]) * speed)
    while_s = window_s(scene, float(np.ptp(beside.reference.time_s)))
    return FreeFacts(
        travel_rad=float(np.trapezoid(peak * (speed / peak) ** 3, time_s)),
        drifted_rad=float(np.max(turned / beside.growth)),
        late=late_impulses(scene, beside.reference, beside.run.dt_s, while_s),
        sensitivity=beside.pure_growth,
        until_s=float(time_s[-1]),
        left_out=beside.left_out,
        time_s=time_s[kept],
        raw=raw[kept],
        judged=judged[kept],
        passages=sum(passage.time_s <= time_s[-1] for passage in beside.free.passages),
    )


def _notes(beside: FreeBeside, facts: FreeFacts) -> Iterable[str]:
    if facts.left_out:
        yield (
            f"the reference ends at t = {facts.until_s:.4g} s, where its uncertainty exceeds a "
            f"quarter of the limit: {facts.left_out} later samples are not judged"
        )
    if facts.passages:
        yield f"the driver turns back at {facts.passages} limits of its angle on the way"
    yield from _held(beside)


def _held(beside: FreeBeside) -> Iterable[str]:
    """Yield a note where loads of one stroke hold the reference at rest, as friction does: an
    engine oscillates there, and creeps by its overshoot."""
    of_strokes = [load.name for load in beside.scene.loads.values() if load.stroke != "both"]
    still = np.abs(beside.driver_speed) <= STILL * beside.scene.pace_rad_s
    held = np.flatnonzero(still[1:] & still[:-1])
    if of_strokes and held.size:
        yield (
            f"from t = {beside.motion.time_s[held[0]]:.4g} s loads of one stroke "
            f"({', '.join(of_strokes)}) hold it at rest, as friction does; engines apply them by "
            "the sign of a speed, creep there, and converge with first order at best"
        )
