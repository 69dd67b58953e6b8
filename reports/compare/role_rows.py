"""The errors of a run by the role of what is compared, as rows, against one reference or another.

Velocities and accelerations come twice: as the engine reports them, against the reference at the
instants they belong to; and by differencing the logged positions, against the reference
differenced in the same way.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import numpy as np

from reports.compare.beside import Beside
from reports.compare.error_rows import Instants, instants_of, rate_rows, whole_row
from reports.compare.errors import Error
from reports.compare.series import rate, second_rate
from reports.quantities import QUANTITIES, named
from reports.quantities.quantity import Role

EPSILON = float(np.finfo(np.float64).eps)


def whole_rows(beside: Beside, at: Instants, role: Role) -> list[Error]:
    """The quantities that play a role, each over the whole run; one after the other, as the tracks
    of one take enough memory."""
    every = (beside.tracks((name,), beside.reference) for name in named(role))
    return [whole_row(beside.judged(track, at.time_s), at) for tracks in every for track in tracks]


def reported_rows(beside: Beside) -> tuple[list[Error], tuple[str, ...]]:
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
            rows += rate_rows(beside.judged(track, time_s), at, "reported")
    return rows, tuple(missing)


def differenced_rows(beside: Beside, at: Instants) -> Iterable[Error]:
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
    for place in beside.places:
        track = beside.judged(place, at.time_s)
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


def uncertain(beside: Beside) -> dict[tuple[str, str], float]:
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
