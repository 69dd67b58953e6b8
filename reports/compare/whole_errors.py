"""The errors of a run put together, from the parts that its kind gives and those of every kind."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np

from analytic.forces.late_impulses import jolts
from models.joints import mass_ratio
from reports.compare.beside import Beside
from reports.compare.curvature import curvature
from reports.compare.error_rows import Instants
from reports.compare.errors import Departure, Error, Errors
from reports.compare.facts import MotionFacts, SceneFacts
from reports.compare.force_log import ForceErrors
from reports.compare.role_rows import differenced_rows, reported_rows, uncertain, whole_rows
from reports.compare.uneven import unevenly_turned
from reports.quantities.quantity import BodyKind


@dataclass(frozen=True)
class Parts:
    """The parts of a comparison that differ from kind to kind: rows before those of the gaps and
    ``conserved`` ones behind the rates, ``notes`` before those of forces, and facts as of
    `SceneFacts`. ``borne`` is what came of the forces."""

    placed: Iterable[Error]
    notes: tuple[str, ...]
    borne: ForceErrors
    departure: Departure | None
    conditioning: float
    summed_rad: float
    far: Mapping[tuple[BodyKind, str], float]
    motion: MotionFacts
    conserved: Iterable[Error] = ()
    drives_within: bool = False


def whole_errors(beside: Beside, at: Instants, parts: Parts) -> Errors:
    """All errors of a run; ``at`` are the instants of its places."""
    scene, run, borne = beside.scene, beside.run, parts.borne
    reported, not_reported = reported_rows(beside)
    jolt = jolts(scene, beside.whole)
    growth = parts.motion.sensitivity
    return Errors(
        rows=(
            *parts.placed,
            *whole_rows(beside, at, "closure"),
            *reported,
            *differenced_rows(beside, at),
            *parts.conserved,
            *borne.rows,
        ),
        not_reported=(*not_reported, *borne.not_reported),
        notes=(*parts.notes, *borne.notes),
        of_scene=SceneFacts(
            curvature=curvature(scene, beside.whole),
            conditioning=parts.conditioning,
            step_rad=scene.pace_rad_s * run.dt_s,
            summed_rad=parts.summed_rad,
            jolt=float(jolt[0]),
            worst_jolt=float(np.max(jolt)),
            mass_ratio=mass_ratio(scene),
            drives_within=parts.drives_within,
            starts_in_passage=bool(np.any(at.passed[: at.first])),
            uneven={body: size / growth for body, size in parts.far.items()},
            uneven_rates=unevenly_turned(scene, parts.far),
        ),
        of_forces=borne.facts,
        of_motion=parts.motion,
        missing=beside.missing,
        incomplete=beside.incomplete or borne.incomplete,
        uncertain={key: bound / growth for key, bound in uncertain(beside).items()}
        | dict(borne.unsure),
        departure=parts.departure,
    )
