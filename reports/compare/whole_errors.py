"""Assembly of the errors of a run, from parts specific to its kind and parts of every kind; and the
errors of its forces, at the instants at which they act."""

from __future__ import annotations

import sys
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from analytic.forces.late_impulses import jolts
from models.array import Array, Mask
from models.motion import Forces, Motion
from models.scene import Scene, joints, laws
from reports.compare import error_rows, errors
from reports.compare.compare import Beside
from reports.compare.hardness import (
    curvature,
    facets,
    inertia_share,
    law_jumps,
    load_slopes,
    parting,
    shared,
    unevenly_turned,
)
from reports.compare.tracks import length
from reports.output.numbers import count
from reports.quantities import named, quantity
from reports.quantities.forces import (
    acting,
    acting_at,
    largest_reaction,
    largest_torque,
    silent,
    unreported,
)
from sim.engine import Run

UNSURE = 1e-5
"""Largest uncertainty of a reference force, over its scale: where a load jumps between two samples
that rounding cannot separate, it is known to the jump."""
OF_STEPS = 12
"""Samples in which forces of steps come to their steady error. The defect of half a step is over
with the next; where iterations leave up to half of it from step to step, 2^-12 are left, below the
give of soft constraints."""


def force_rows(beside: Beside) -> ForceErrors:
    """Return the errors of forces, at their own instants; none where none were requested."""
    scene, run = beside.scene, beside.run
    if not run.with_forces:
        return ForceErrors()
    known = acting_at(run)
    time_s = beside.motion.time_s if known is None else known
    reference = beside.truth.with_forces_at(time_s)
    assert reference.forces is not None
    tracks = beside.tracks(named("force"), reference)
    determined: Mask = np.isfinite(reference.forces.torque) & ~near_jumps(scene, reference)
    at = error_rows.instants_of(beside, time_s, reference)
    if run.forces_of == "steps":
        at = replace(at, settling=min(at.settling, OF_STEPS))
    rows, missing, start = list[errors.Error](), list[str](), 0.0
    left: Mask = ~determined
    unsure = dict[tuple[str, str], float]()
    for track in tracks:
        if unreported(run, track.quantity, track.body):
            missing.append(f"{track.quantity} of {track.body_kind} {track.body}")
            continue
        kept: Mask = determined & (track.bound <= UNSURE * track.scale)
        if not np.any(kept):  # friction of a joint that never turns may be either way, say
            unsure[track.quantity, track.body] = float(np.max(track.bound)) / track.scale
            continue
        left = left | ~kept
        start = max(start, float(length(track.truth)[kept][0]) / track.scale)
        if silent(run) and np.all(np.isnan(track.error)):
            missing.append(f"{track.quantity} of {track.body_kind} {track.body}")
            continue
        judged = beside.judged(track, time_s)
        sure = replace(judged, error=judged.error[kept], bound=judged.bound[kept])
        rows += error_rows.rate_rows(sure, at[kept], "reported")
    borne = acting(run)
    force, torque = largest_reaction(scene, reference), largest_torque(scene, reference)
    return ForceErrors(
        tuple(rows),
        tuple(missing),
        force_notes(run, reference.forces, int(np.sum(left)), int(np.sum(at[~left].passed))),
        errors.ForceFacts(
            contradictions=() if borne is None else borne.contradictions,
            unbalanced=unbalanced(run, force),
            start_load=start if run.forces_of == "steps" else 0.0,
            load_slopes=load_slopes(scene, reference, force, torque),
            inertia_share=inertia_share(scene, force),
        ),
        off_stamps(run),
        unsure,
    )


ROUNDING = 1e-9
"""Largest error of the stamps, as a share of a step."""


@dataclass(frozen=True)
class ForceErrors:
    """Result of the comparison of forces, in the terms of `reports.compare.errors.Errors`."""

    rows: tuple[errors.Error, ...] = ()
    not_reported: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()
    facts: errors.ForceFacts = field(default_factory=errors.ForceFacts)
    incomplete: str = ""
    unsure: Mapping[tuple[str, str], float] = field(default_factory=dict)
    """Uncertainty of the reference, as a pure number, of forces that it knows at no sample."""


def off_stamps(run: Run) -> str:
    """Return a text on forces stamped farther than a step from their sample, "" where there are
    none: a force at another time does not belong to that sample."""
    forces = acting(run)
    if forces is None or run.motion is None:
        return ""
    samples = run.motion.time_s[-forces.time_s.size :]
    bad = np.flatnonzero(~(np.abs(forces.time_s - samples) <= (1.0 + ROUNDING) * run.dt_s))
    if not bad.size:
        return ""
    first = int(bad[0])
    return (
        f"forces of the sample at {samples[first]:.9g} s are stamped {forces.time_s[first]:.9g} s, "
        f"over a step away ({count(bad.size, 'sample')} of {samples.size})"
    )


def unbalanced(run: Run, largest_n: float) -> errors.Unbalanced | None:
    """Return the pin with the largest finite sum of forces, over the largest reaction."""
    forces = acting(run)
    sums = dict[str, float]()
    for point, bodies in (forces.pins if forces else {}).items():
        off = np.hypot(*np.sum(list(bodies.values()), axis=0).T)
        if np.any(np.isfinite(off)):
            sums[point] = float(np.max(off, where=np.isfinite(off), initial=0.0)) / largest_n
    point = max(sums, key=lambda name: sums[name], default="")
    return errors.Unbalanced(point, sums[point]) if point else None


def force_notes(run: Run, reference: Forces, dead: int, passed: int) -> tuple[str, ...]:
    """Return notes on forces that are not compared, or not judged, at samples in dead points
    (``dead``) and near change points (``passed``), with the reasons."""
    logged = acting(run)
    notes = [reference.undetermined and f"no reactions: {reference.undetermined}"]
    if left_out := str(run.unreported):
        notes.append(f"forces: {run.engine} does not report those of {left_out}")
    if dead:
        notes.append(
            f"forces: left out {count(dead, 'sample')} of {reference.time_s.size}, in dead "
            "points or beside jumps of a load or of friction, where they are not determined"
        )
    if passed:
        notes.append(
            f"forces: {count(passed, 'sample')} of {reference.time_s.size} near change points "
            "compared and not judged, as joints may push against each other there"
        )
    if logged is not None and logged.undetermined != reference.undetermined:
        notes.append(logged.undetermined and f"forces: {logged.undetermined}")
    return tuple(note for note in notes if note)


NEAR = 3
"""Samples on both sides of a jump: MuJoCo's friction, a soft constraint, stops a joint that should
stand still within its time constant, which profile tuned has at three steps."""


def near_jumps(scene: Scene, reference: Motion) -> Mask:
    """Return a mask of samples, (T,), beside a jump of a force, for a motion with its forces."""
    jumps = np.zeros(max(reference.time_s.size - 1, 0), dtype=np.bool_)
    friction = reference.forces.friction if reference.forces is not None else {}
    for series in friction.values():
        jumps |= _turns(series)
    for load in scene.loads.values():
        if load.stroke == "both" or load.slider is None:
            continue
        slid = reference.sliders[load.slider]
        turns = _turns(slid.speed)
        if load.over == "displacement":
            acts = load.characteristic.at(slid.displacement) != 0.0
            turns &= acts[1:] | acts[:-1]
        jumps |= turns
    near = np.zeros(reference.time_s.size, dtype=np.bool_)
    for by in range(min(NEAR, jumps.size)):
        near[: jumps.size - by] |= jumps[by:]  # so many samples before the jump
        near[1 + by :] |= jumps[: jumps.size - by]
    return near


def _turns(series: Array) -> Mask:
    """Return a mask of sign changes from one sample to the next, (T - 1,)."""
    sign = np.sign(np.nan_to_num(series))
    return np.asarray(sign[1:] != sign[:-1])


@dataclass(frozen=True)
class ComparedParts:
    """The parts of a comparison that differ from kind to kind: rows before those of the gaps and
    ``conserved`` ones after the rates, ``notes`` before those of forces, and facts as of
    `errors.SceneFacts`. ``borne`` is the result for the forces."""

    placed: Iterable[errors.Error]
    notes: tuple[str, ...]
    borne: ForceErrors
    departure: errors.Departure | None
    conditioning: float
    summed_rad: float
    far: Mapping[tuple[quantity.BodyKind, str], float]
    motion: errors.MotionFacts
    conserved: Iterable[errors.Error] = ()
    drives_within: bool = False


_jolts = shared(jolts)


def whole_errors(beside: Beside, at: error_rows.Instants, parts: ComparedParts) -> errors.Errors:
    """Return all errors of a run; ``at`` are the instants of its positions."""
    scene, run, borne = beside.scene, beside.run, parts.borne
    reported, not_reported = error_rows.reported_rows(beside)
    jolt = _jolts(scene, beside.whole)
    growth = parts.motion.sensitivity
    return errors.Errors(
        rows=(
            *parts.placed,
            *error_rows.whole_rows(beside, at, "closure"),
            *reported,
            *error_rows.differenced_rows(beside, at),
            *parts.conserved,
            *borne.rows,
        ),
        not_reported=(*not_reported, *borne.not_reported),
        notes=(*parts.notes, *borne.notes),
        of_scene=errors.SceneFacts(
            curvature=curvature(scene, beside.whole),
            conditioning=parts.conditioning,
            step_rad=scene.pace_rad_s * run.dt_s,
            summed_rad=parts.summed_rad,
            jolt=float(jolt[0]),
            worst_jolt=float(np.max(jolt)),
            mass_ratio=joints.mass_ratio(scene),
            drives_within=parts.drives_within,
            starts_in_passage=bool(np.any(at.passed[: at.first])),
            uneven={body: size / growth for body, size in parts.far.items()},
            uneven_rates=unevenly_turned(scene, parts.far),
            floor=run.floor,
            law_jumps=law_jumps(scene, beside.whole),
            parting=parting(scene, beside.whole),
            facets=facets(scene, beside.whole),
        ),
        of_forces=borne.facts,
        of_motion=parts.motion,
        missing=beside.missing,
        incomplete=beside.incomplete or borne.incomplete,
        uncertain={
            key: bound / growth
            for key, bound in error_rows.uncertain(scene, beside.reference).items()
        }
        | dict(borne.unsure),
        departure=parts.departure,
    )


TWICE = 4.0
"""Factor for an angle that is added up twice."""


def summed(law: laws.Law, dt_s: float, steps: int) -> float:
    """Return the largest effect of rounding on the driver's angle in ``steps`` of ``dt_s`` [rad].

    At constant speed an engine adds ``speed * dt`` to the angle at every step (MuJoCo ``qpos += dt
    * qvel``, pymunk ``angle += omega * dt``). Each sum is rounded by at most eps/2 of the angle,
    and as the same amount is added each time, all are rounded to the same side while the angle
    stays between two powers of two: the worst case, steps * eps/2 * largest angle, is nearly
    reached, and the square root of the number of steps that chance would give is exceeded
    (measured, 10^3 to 10^6 steps: 0.1 to 0.18 of the worst case, whatever the step and the engine).

    Any other law comes to MuJoCo as accelerations, computed beforehand, and is added up twice. Some
    roundings of the speed remain at every step, and a law that repeats itself repeats them: the
    angle is off by their sum, which grows with the square of the number of steps as well (measured:
    2.3 times the above for 10^4 and 10^5 steps).
    """
    lasts_s = steps * dt_s
    farthest = law.offset_rad + lasts_s * law.fastest_until(lasts_s)
    once = steps * sys.float_info.epsilon / 2.0 * farthest
    return once if isinstance(law, laws.ConstantSpeed) else TWICE * once
