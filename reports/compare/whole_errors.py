"""The errors of a run put together, from the parts that its kind gives and those of every kind."""

from __future__ import annotations

import sys
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np

from analytic.forces.late_impulses import jolts
from models.joints import mass_ratio
from models.laws import ConstantSpeed, Law
from reports.compare.beside import Beside
from reports.compare.error_rows import (
    Instants,
    differenced_rows,
    reported_rows,
    uncertain,
    whole_rows,
)
from reports.compare.errors import Departure, Error, Errors, MotionFacts, SceneFacts
from reports.compare.force_rows import ForceErrors
from reports.compare.hardness import curvature, unevenly_turned
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


TWICE = 4.0
"""How much more is granted where the angle is added up twice."""


def summed(law: Law, dt_s: float, steps: int) -> float:
    """The most that rounding makes of the driver's angle in so many steps of ``dt_s`` [rad].

    At constant speed an engine adds ``speed * dt`` to the angle at every step (MuJoCo ``qpos += dt
    * qvel``, pymunk ``angle += omega * dt``). Each sum is rounded by at most eps/2 of the angle,
    and as the same amount is added each time, all are rounded to the same side while the angle
    stays between two powers of two: the worst case, steps * eps/2 * largest angle, is nearly
    reached, and the square root of the number of steps that chance would give is exceeded
    (measured, 10^3 to 10^6 steps: 0.1 to 0.18 of the worst case, whatever the step and the engine).

    Any other law comes to MuJoCo as accelerations, worked out beforehand, and is added up twice.
    Some roundings of the speed remain at every step, and a law that repeats itself repeats them:
    the angle is off by their sum, which grows with the square of the number of steps as well
    (measured: 2.3 times the above for 10^4 and 10^5 steps).
    """
    lasts_s = steps * dt_s
    farthest = law.offset_rad + lasts_s * law.fastest_until(lasts_s)
    once = steps * sys.float_info.epsilon / 2.0 * farthest
    return once if isinstance(law, ConstantSpeed) else TWICE * once
