"""Compare a run with the reference: total, geometric, drive and closure errors, rates and all.

Total error: the reference at the commanded time. Geometric error: the reference at the crank angle
that the engine logged, so that a crank which lags shows in the drive and not in the geometry.
Velocities and accelerations come twice: as the engine reports them, against the reference at the
instants they belong to; and by differencing the logged positions, against the reference
differenced in the same way.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterable
from dataclasses import replace

import numpy as np

from analytic.forces.jolts import jolts
from models.errors import ReachError
from models.motion import Motion
from models.poses import mass_ratio
from models.scene import Scene
from reports.compare.beside import Beside
from reports.compare.branch import departure
from reports.compare.change_points import conditioning
from reports.compare.drive_rounding import summed
from reports.compare.error_rows import Instants, instants_of, rate_rows, whole_row
from reports.compare.errors import Error, Errors
from reports.compare.force_rows import force_rows
from reports.compare.loading import loading
from reports.compare.series import length, rate, second_rate
from reports.compare.uneven import uneven, unevenly_turned
from reports.quantities import QUANTITIES, named
from reports.quantities.quantity import Role

EPSILON = float(np.finfo(np.float64).eps)


def compare(beside: Beside | None) -> Errors | None:
    """The errors of a run, or None where it logged nothing.

    Samples that are not finite, and bodies or pins of the scene that a run lacks, give errors
    that are not finite; what a user's own log lacks gives none.

    Returns
    -------
    Errors or None
        One row per quantity, body, source and kind.
    """
    if beside is None:
        return None
    scene, run, reference = beside.scene, beside.run, beside.reference
    at = instants_of(beside, beside.motion.time_s, reference)
    geometric, notes = _geometric(beside, at)
    reported, not_reported = _reported(beside)
    borne = force_rows(beside)
    jolt = jolts(scene, beside.whole)
    far = uneven(scene, reference, at.driver_rad) if beside.of_engine else {}
    return Errors(
        rows=(
            *_whole(beside, at, "drive"),
            *_whole(beside, at, "place"),
            *geometric,
            *_whole(beside, at, "closure"),
            *reported,
            *_differenced(beside, at),
            *borne.rows,
        ),
        not_reported=(*not_reported, *borne.not_reported),
        notes=(*notes, *borne.notes),
        curvature=curvature(scene, beside.whole),
        conditioning=conditioning(reference, at.driver_rad),
        step_rad=scene.driver.law.peak_speed_rad_s * run.dt_s,
        missing=beside.missing,
        incomplete=beside.incomplete or borne.incomplete,
        uncertain=_uncertain(beside) | dict(borne.unsure),
        departure=departure(beside),
        summed_rad=summed(scene.driver.law, run.dt_s, run.steps),
        jolt=float(jolt[0]),
        worst_jolt=float(np.max(jolt)),
        mass_ratio=mass_ratio(scene),
        starts_in_passage=bool(np.any(at.passed[: at.first])),
        uneven=far,
        uneven_rates=unevenly_turned(scene, far),
        contradictions=borne.contradictions,
        unbalanced=borne.unbalanced,
        start_load=borne.start_load,
        loading=loading(scene, beside.whole),
        load_slopes=borne.load_slopes,
        inertia_share=borne.inertia_share,
    )


def places(beside: Beside | None) -> list[Error]:
    """Drive error, total errors of place and gaps alone; none of a run that logged nothing."""
    if beside is None:
        return []
    at = instants_of(beside, beside.motion.time_s, beside.reference)
    return [
        *_whole(beside, at, "drive"),
        *_whole(beside, at, "place"),
        *_whole(beside, at, "closure"),
    ]


def _whole(beside: Beside, at: Instants, role: Role) -> list[Error]:
    """The quantities that play a role, each over the whole run; one after the other, as the tracks
    of one take enough memory."""
    every = (beside.tracks((name,), beside.reference) for name in named(role))
    return [whole_row(track, at) for tracks in every for track in tracks]


def _geometric(beside: Beside, at: Instants) -> tuple[list[Error], tuple[str, ...]]:
    """Errors against the reference at the logged crank angle, or a note that says why not."""
    if not beside.has_crank:
        return [], ()
    if not np.all(np.isfinite(beside.crank)):
        return [], ("no geometric error: the logged crank angle is not finite",)
    try:
        tracks = beside.tracks(named("place"), beside.at_crank)
    except ReachError as error:
        return [], (f"no geometric error: the logged crank left its range ({error})",)
    return [whole_row(track, at, kind="geometric") for track in tracks], ()


def _reported(beside: Beside) -> tuple[list[Error], tuple[str, ...]]:
    """Velocities, accelerations and the like as the engine gives them, and the bodies without."""
    rows, missing = list[Error](), list[str]()
    for name in named("derived"):
        entry = QUANTITIES[name]
        instants = entry.instants(beside.run)
        time_s = beside.motion.time_s if instants is None else instants
        reference = beside.truth.at(time_s)
        at = instants_of(beside, time_s, reference)
        tracks = beside.tracks((name,), reference)
        # Silence is no fault of an engine that does not report it, if it is silent of all.
        if entry.silent(beside.run) and all(np.all(np.isnan(track.error)) for track in tracks):
            missing += [f"{name} of {track.body_kind} {track.body}" for track in tracks]
            continue
        for track in tracks:
            rows += rate_rows(track, at, "reported")
    return rows, tuple(missing)


def _differenced(beside: Beside, at: Instants) -> Iterable[Error]:
    """Velocities and accelerations from the logged positions, by central differences."""
    if at.time_s.size < 3 or not beside.is_even:
        return
    step_s = float(at.time_s[1] - at.time_s[0])
    orders = [
        (name, each.tolerance.differenced)
        for name, entry in QUANTITIES.items()
        for each in entry.criteria
        if each.tolerance.differenced
    ]
    inner = at[1:-1]
    for track in beside.places:
        # The logged numbers are rounded too: that is part of what a difference is uncertain by.
        unsure = (track.bound + EPSILON * track.magnitude)[1:-1]
        for name, order in orders:
            once = order == 1
            measure = QUANTITIES[name].of(track.body_kind)
            differenced = replace(
                track,
                quantity=name,
                error=(rate if once else second_rate)(track.error, step_s),
                bound=unsure / step_s if once else 4 * unsure / step_s**2,
                scale=measure.scale(beside.scene, beside.reference),
                unit=measure.unit,
            )
            yield from rate_rows(differenced, inner, "differenced")


def _uncertain(beside: Beside) -> dict[tuple[str, str], float]:
    """The largest bound of the reference per quantity and body, as a pure number."""
    scene, reference = beside.scene, beside.reference
    shares = {}
    for name in named("place", "derived"):
        for measure in QUANTITIES[name].measures:
            bounds, scale = measure.bound(scene, reference), measure.scale(scene, reference)
            for body in measure.truth(scene, reference):
                bound = np.max(bounds[body], initial=0.0) if body in bounds else 0.0
                shares[name, body] = float(bound) / scale
    return shares


def curvature(scene: Scene, reference: Motion) -> float:
    """The largest pure acceleration of the reference, at least 1, where it is a number."""
    square = scene.driver.law.peak_speed_rad_s**2
    turning = (link.alpha / square for link in reference.links.values())
    moving = (
        point.acceleration / (scene.longest_m * square) for point in reference.points.values()
    )
    sizes = (length(series) for series in itertools.chain(turning, moving))
    return max(float(np.max(each, where=np.isfinite(each), initial=1.0)) for each in sizes)
