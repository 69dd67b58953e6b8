"""The errors of a run whose driver follows a law: of the drive, of positions at the same time and
at the logged angle of the driver, and of rates."""

from dataclasses import replace

import numpy as np

from models.errors import ReachError
from reports.compare.branch import departure
from reports.compare.compare import Beside
from reports.compare.error_rows import Instants, instants_of, whole_row, whole_rows
from reports.compare.errors import DRIVEN, Error, Errors
from reports.compare.hardness import conditioning, loading, uneven
from reports.compare.whole_errors import ComparedParts, force_rows, summed, whole_errors
from reports.quantities import named, quantity


def compared(beside: Beside, errors: Errors | None) -> Errors:
    """Return the errors of a driven run; no module comes before."""
    scene, run, reference = beside.scene, beside.run, beside.reference
    at = instants_of(beside, beside.motion.time_s, reference)
    geometric, notes = _geometric(beside, at)
    borne = force_rows(beside)
    loaded = replace(borne.facts, loading=loading(scene, beside.whole))
    parts = ComparedParts(
        placed=[*_of_roles(beside, at, "drive", "place"), *geometric],
        notes=notes,
        borne=replace(borne, facts=loaded),
        departure=departure(beside),
        conditioning=conditioning(reference, at.driver_rad),
        summed_rad=summed(scene.driver.law, run.dt_s, run.steps),
        far=uneven(scene, reference, at.driver_rad) if beside.of_engine else {},
        motion=DRIVEN,
        drives_within=scene.driver.is_inner,
    )
    return whole_errors(beside, at, parts)


def places(beside: Beside) -> list[Error]:
    """Return drive error, total errors of position and gaps alone."""
    at = instants_of(beside, beside.motion.time_s, beside.reference)
    return _of_roles(beside, at, "drive", "place", "closure")


def _of_roles(beside: Beside, at: Instants, *roles: quantity.Role) -> list[Error]:
    return [row for role in roles for row in whole_rows(beside, at, role)]


def _geometric(beside: Beside, at: Instants) -> tuple[list[Error], tuple[str, ...]]:
    """Return errors against the reference at the logged crank angle, or a note with the reason."""
    if not beside.has_crank:
        return [], ()
    if not np.all(np.isfinite(beside.crank)):
        return [], ("no geometric error: the logged crank angle is not finite",)
    try:
        tracks = beside.tracks(named("place"), beside.at_crank)
    except ReachError as error:
        return [], (f"no geometric error: the logged crank left its range ({error})",)
    return [whole_row(track, at, kind="geometric") for track in tracks], ()
