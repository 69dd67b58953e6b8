"""Rows of errors: a track in numbers, over all samples, or separately over the first ones, those
near change points and the rest.

Velocities and accelerations come twice: as the engine reports them, against the reference at their
own instants; and by differencing the logged positions, against the reference differenced in the
same way.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from models.array import Array, Mask
from models.motion import Motion
from models.scene import Scene
from reports.compare.compare import EPSILON, Beside
from reports.compare.errors import Error, ErrorKind
from reports.compare.hardness import WINDOW_RAD, near, shared
from reports.compare.tracks import Track, length, rate, second_rate, size
from reports.quantities import QUANTITIES, named, quantity


@dataclass(frozen=True)
class Instants:
    """The samples of a series: time [s], commanded driver angle [rad], and a mask of those in the
    window of a change point, each (T,); the number that may be the start; the driver's unit."""

    time_s: Array
    driver_rad: Array
    passed: Mask
    settling: int
    driver_unit: str = "rad"

    def __getitem__(self, part: slice | Mask) -> Instants:
        time_s, driver_rad, passed = self.time_s[part], self.driver_rad[part], self.passed[part]
        return Instants(time_s, driver_rad, passed, self.settling, self.driver_unit)

    @property
    def first(self) -> int:
        """The number of samples of the start."""
        return min(self.settling, self.time_s.size // 4)

    @cached_property
    def parts(self) -> tuple[tuple[ErrorKind, slice | Mask, Instants], ...]:
        """The first samples, those at change points and the rest, by kind, without empty ones."""
        first, size = self.first, self.time_s.size
        later = np.arange(size) >= first
        kinds: list[tuple[ErrorKind, slice | Mask]] = [("start", slice(first))] if first else []
        if np.any(self.passed):
            kinds += [("total", later & ~self.passed), ("passage", later & self.passed)]
        else:
            kinds += [("total", slice(first, size))]
        cut = ((kind, part, self[part]) for kind, part in kinds)
        return tuple(each for each in cut if each[2].time_s.size)


def instants_of(beside: Beside, time_s: Array, reference: Motion) -> Instants:
    """Return the samples of a run at its own instants, or at those of its forces."""
    driver_rad = beside.driver_at(time_s, reference)
    passed = near(reference.crossings, driver_rad, WINDOW_RAD)
    return Instants(time_s, driver_rad, passed, beside.settling, beside.scene.driver.unit)


def whole_row(track: Track, at: Instants, kind: ErrorKind = "total") -> Error:
    """Return a reported track as numbers."""
    return _numbers(track, length(track.error), track.bound, at, "reported", kind)


def _numbers(
    track: Track, error: Array, bound: Array, at: Instants, source: quantity.Source, kind: ErrorKind
) -> Error:
    """Return a series of lengths (T,) of a track's error as numbers, with their uncertainty."""
    measured = size(error)
    return Error(
        quantity=track.quantity,
        body_kind=track.body_kind,
        body=track.body,
        source=source,
        kind=kind,
        unit=track.unit,
        scale=track.scale,
        maximum=measured.maximum,
        rms=measured.rms,
        final=measured.final,
        time_of_maximum_s=float(at.time_s[measured.index]),
        driver_at_maximum_rad=float(at.driver_rad[measured.index]),
        bound=float(np.max(bound, initial=0.0)),
        samples=int(error.shape[0]),
        driver_unit=at.driver_unit,
    )


def rate_rows(track: Track, at: Instants, source: quantity.Source) -> Iterable[Error]:
    """Yield a rate as rows of its parts: first samples, those at change points, and the rest."""
    error = length(track.error)
    for kind, part, instants in at.parts:
        yield _numbers(track, error[part], track.bound[part], instants, source, kind)


def whole_rows(beside: Beside, at: Instants, role: quantity.Role) -> list[Error]:
    """Return the quantities of a role, each over the whole run; one after the other, as the tracks
    of one take enough memory."""
    every = (beside.tracks((name,), beside.reference) for name in named(role))
    return [whole_row(beside.judged(track, at.time_s), at) for tracks in every for track in tracks]


def reported_rows(beside: Beside) -> tuple[list[Error], tuple[str, ...]]:
    """Return reported velocities, accelerations and the like, and the bodies without."""
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
    """Yield velocities and accelerations from the logged positions, by central differences."""
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
        # The logged numbers are rounded too: that is part of the uncertainty of a difference.
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


@shared
def uncertain(scene: Scene, reference: Motion) -> dict[tuple[str, str], float]:
    """Return the largest bound of the reference per quantity and body, as a pure number."""
    shares = {}
    for name in named("place", "derived"):
        for measure in QUANTITIES[name].measures:
            bounds, scale = measure.bound(scene, reference), measure.scale(scene, reference)
            for body in measure.truth(scene, reference):
                bound = np.max(bounds[body], initial=0.0) if body in bounds else 0.0
                shares[name, body] = float(bound) / scale
    return shares
