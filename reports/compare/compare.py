"""Compare a run with the reference: total, geometric, drive and closure errors, rates and all.

Total error: the reference at the commanded time. Geometric error: the reference at the crank angle
that the engine logged, so that a crank which lags shows in the drive and not in the geometry.
Of a run that was let go (`reports.compare.free`) there is a phase in place of the drive.
"""

from __future__ import annotations

import numpy as np

from analytic.forces.late_impulses import jolts
from models.errors import ReachError
from models.poses import mass_ratio
from reports.compare.beside import Beside
from reports.compare.branch import departure
from reports.compare.change_points import conditioning
from reports.compare.curvature import curvature
from reports.compare.drive_rounding import summed
from reports.compare.error_rows import Instants, instants_of, whole_row
from reports.compare.errors import Error, Errors
from reports.compare.force_rows import force_rows
from reports.compare.free.free_beside import FreeBeside
from reports.compare.loading import loading
from reports.compare.role_rows import differenced_rows, reported_rows, uncertain, whole_rows
from reports.compare.uneven import uneven, unevenly_turned
from reports.quantities import named
from reports.quantities.quantity import Role


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
    if isinstance(beside, FreeBeside):
        from reports.compare.free.free_errors import free_errors  # for what is let go alone

        errors = free_errors(beside)
    else:
        errors = _of_driven(beside)
    if beside.bends:
        from reports.compare.elastic.elastic_errors import with_elastic  # where links bend alone

        return with_elastic(errors, beside)
    return errors


def _of_driven(beside: Beside) -> Errors:
    """As `compare`, but for what is elastic."""
    scene, run, reference = beside.scene, beside.run, beside.reference
    at = instants_of(beside, beside.motion.time_s, reference)
    geometric, notes = _geometric(beside, at)
    reported, not_reported = reported_rows(beside)
    borne = force_rows(beside)
    jolt = jolts(scene, beside.whole)
    far = uneven(scene, reference, at.driver_rad) if beside.of_engine else {}
    return Errors(
        rows=(
            *whole_rows(beside, at, "drive"),
            *whole_rows(beside, at, "place"),
            *geometric,
            *whole_rows(beside, at, "closure"),
            *reported,
            *differenced_rows(beside, at),
            *borne.rows,
        ),
        not_reported=(*not_reported, *borne.not_reported),
        notes=(*notes, *borne.notes),
        curvature=curvature(scene, beside.whole),
        conditioning=conditioning(reference, at.driver_rad),
        step_rad=scene.pace_rad_s * run.dt_s,
        missing=beside.missing,
        incomplete=beside.incomplete or borne.incomplete,
        uncertain=uncertain(beside) | dict(borne.unsure),
        departure=departure(beside),
        summed_rad=summed(scene.driver.law, run.dt_s, run.steps),
        jolt=float(jolt[0]),
        worst_jolt=float(np.max(jolt)),
        mass_ratio=mass_ratio(scene),
        drives_within=scene.driver.is_inner,
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
    if isinstance(beside, FreeBeside):
        from reports.compare.free.free_errors import free_places  # for what is let go alone

        rows = free_places(beside)
    else:
        at = instants_of(beside, beside.motion.time_s, beside.reference)
        roles: tuple[Role, ...] = ("drive", "place", "closure")
        rows = [row for role in roles for row in whole_rows(beside, at, role)]
    if beside.bends:
        from reports.compare.elastic.elastic_errors import elastic_rows

        rows += elastic_rows(beside)
    return rows


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
