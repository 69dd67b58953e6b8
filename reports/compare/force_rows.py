"""The errors of forces, at the instants that they act at, and what is left out of them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from models.array import Mask
from reports.compare.beside import Beside
from reports.compare.error_rows import instants_of, rate_rows
from reports.compare.errors import Error
from reports.compare.facts import ForceFacts
from reports.compare.force_log import ForceErrors, force_notes, off_stamps, unbalanced
from reports.compare.jumps import near_jumps
from reports.compare.loading import inertia_share, load_slopes
from reports.compare.series import length
from reports.quantities import named
from reports.quantities.forces import acting, acting_at, largest_reaction, largest_torque, silent

UNSURE = 1e-5
"""The most that a force of the reference may be wrong by, of its scale: where a load jumps between
two samples that rounding can not tell apart, it is known to the jump."""
OF_STEPS = 12
"""Samples in which forces of steps come to their steady error. What half a step has left undone is
over with the next; where iterations leave up to half of it from step to step, 2^-12 are left, under
what soft constraints leave open."""


def force_rows(beside: Beside) -> ForceErrors:
    """The errors of forces, at the instants that they act at; none where none were asked for."""
    scene, run = beside.scene, beside.run
    if not run.with_forces:
        return ForceErrors()
    known = acting_at(run)
    time_s = beside.motion.time_s if known is None else known
    reference = beside.truth.with_forces_at(time_s)
    assert reference.forces is not None
    tracks = beside.tracks(named("force"), reference)
    determined: Mask = np.isfinite(reference.forces.torque) & ~near_jumps(scene, reference)
    at = instants_of(beside, time_s, reference)
    if run.forces_of == "steps":
        at = replace(at, settling=min(at.settling, OF_STEPS))
    rows, missing, start = list[Error](), list[str](), 0.0
    left: Mask = ~determined
    unsure = dict[tuple[str, str], float]()
    for track in tracks:
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
        rows += rate_rows(sure, at[kept], "reported")
    borne = acting(run)
    force, torque = largest_reaction(scene, reference), largest_torque(scene, reference)
    return ForceErrors(
        tuple(rows),
        tuple(missing),
        force_notes(run, reference.forces, int(np.sum(left)), int(np.sum(at[~left].passed))),
        ForceFacts(
            contradictions=() if borne is None else borne.contradictions,
            unbalanced=unbalanced(run, force),
            start_load=start if run.forces_of == "steps" else 0.0,
            load_slopes=load_slopes(scene, reference, force, torque),
            inertia_share=inertia_share(scene, force),
        ),
        off_stamps(run),
        unsure,
    )
