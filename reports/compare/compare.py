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
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from analytic.forces.jolts import jolts
from models.array import Array, Mask
from models.errors import ReachError
from models.motion import Motion
from models.poses import mass_ratio
from models.scene import Scene
from reports.compare.beside import Beside
from reports.compare.branch import departure
from reports.compare.change_points import WINDOW_RAD, conditioning, near
from reports.compare.drive_rounding import summed
from reports.compare.errors import Error, ErrorKind, Errors
from reports.compare.force_log import ForceErrors, force_notes, off_stamps, unbalanced
from reports.compare.series import length, rate, second_rate, size
from reports.compare.tracks import Track
from reports.compare.uneven import uneven, unevenly_turned
from reports.quantities import QUANTITIES, named
from reports.quantities.forces import acting_at, largest_reaction, silent
from reports.quantities.quantity import Role, Source

UNSURE = 1e-5
"""The most that a force of the reference may be wrong by, of its scale: where a load jumps between
two samples that rounding can not tell apart, it is known to the jump."""
EPSILON = float(np.finfo(np.float64).eps)


@dataclass(frozen=True)
class _Instants:
    """The samples of a series: time [s], commanded driver angle [rad], and whether they are in the
    window of a change point, each (T,); and how many may be the start."""

    time_s: Array
    driver_rad: Array
    passed: Mask
    settling: int

    def __getitem__(self, part: slice | Mask) -> _Instants:
        time_s, driver_rad, passed = self.time_s[part], self.driver_rad[part], self.passed[part]
        return _Instants(time_s, driver_rad, passed, self.settling)

    @property
    def first(self) -> int:
        """The number of samples that are the start."""
        return min(self.settling, self.time_s.size // 4)

    @cached_property
    def parts(self) -> tuple[tuple[ErrorKind, slice | Mask, _Instants], ...]:
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
    at = _instants(beside, beside.motion.time_s, reference)
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
        uncertain=_uncertain(beside),
        departure=departure(beside),
        summed_rad=summed(scene.driver.law, run.dt_s, run.steps),
        jolt=float(jolt[0]),
        worst_jolt=float(np.max(jolt)),
        mass_ratio=mass_ratio(scene),
        starts_in_passage=bool(np.any(at.passed[: at.first])),
        uneven=far,
        uneven_rates=unevenly_turned(scene, far),
        unbalanced=borne.unbalanced,
        start_load=borne.start_load,
    )


def force_rows(beside: Beside) -> ForceErrors:
    """The errors of forces, at the instants that they act at; none where none were asked for."""
    run = beside.run
    if not run.with_forces:
        return ForceErrors()
    known = acting_at(run)
    time_s = beside.motion.time_s if known is None else known
    reference = beside.truth.with_forces_at(time_s)
    assert reference.forces is not None
    tracks = beside.tracks(named("force"), reference)
    alive = np.isfinite(reference.forces.torque)
    for track in tracks:
        alive = alive & (track.bound <= UNSURE * track.scale)
    at = _instants(beside, time_s, reference)[alive]
    rows, missing, start = list[Error](), list[str](), 0.0
    for track in tracks if np.any(alive) else ():
        start = max(start, float(length(track.truth)[alive][0]) / track.scale)
        if silent(run) and np.all(np.isnan(track.error)):
            missing.append(f"{track.quantity} of {track.body_kind} {track.body}")
            continue
        kept = replace(track, error=track.error[alive], bound=track.bound[alive])
        rows += _rate_rows(kept, at, "reported")
    return ForceErrors(
        tuple(rows),
        tuple(missing),
        force_notes(run, reference.forces, int(np.sum(~alive)), int(np.sum(at.passed))),
        unbalanced(run, largest_reaction(beside.scene, reference)),
        start if run.forces_of == "steps" else 0.0,
        off_stamps(run),
    )


def places(beside: Beside | None) -> list[Error]:
    """Drive error, total errors of place and gaps alone; none of a run that logged nothing."""
    if beside is None:
        return []
    at = _instants(beside, beside.motion.time_s, beside.reference)
    return [
        *_whole(beside, at, "drive"),
        *_whole(beside, at, "place"),
        *_whole(beside, at, "closure"),
    ]


def _instants(beside: Beside, time_s: Array, reference: Motion) -> _Instants:
    driver_rad = beside.scene.driver.law.at(time_s)[0]
    passed = near(reference.crossings, driver_rad, WINDOW_RAD)
    return _Instants(time_s, driver_rad, passed, beside.settling)


def _row(
    track: Track, at: _Instants, source: Source = "reported", kind: ErrorKind = "total"
) -> Error:
    """A track as numbers."""
    return _numbers(track, length(track.error), track.bound, at, source, kind)


def _numbers(
    track: Track, error: Array, bound: Array, at: _Instants, source: Source, kind: ErrorKind
) -> Error:
    """A series of lengths (T,) of a track's error as numbers, with what they may be wrong by."""
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
    )


def _rate_rows(track: Track, at: _Instants, source: Source) -> Iterable[Error]:
    """A rate as rows of its parts: the first samples, those at change points, and the rest."""
    error = length(track.error)
    for kind, part, instants in at.parts:
        yield _numbers(track, error[part], track.bound[part], instants, source, kind)


def _whole(beside: Beside, at: _Instants, role: Role) -> list[Error]:
    """The quantities that play a role, each over the whole run; one after the other, as the tracks
    of one take enough memory."""
    every = (beside.tracks((name,), beside.reference) for name in named(role))
    return [_row(track, at) for tracks in every for track in tracks]


def _geometric(beside: Beside, at: _Instants) -> tuple[list[Error], tuple[str, ...]]:
    """Errors against the reference at the logged crank angle, or a note that says why not."""
    if not beside.has_crank:
        return [], ()
    if not np.all(np.isfinite(beside.crank)):
        return [], ("no geometric error: the logged crank angle is not finite",)
    try:
        tracks = beside.tracks(named("place"), beside.at_crank)
    except ReachError as error:
        return [], (f"no geometric error: the logged crank left its range ({error})",)
    return [_row(track, at, kind="geometric") for track in tracks], ()


def _reported(beside: Beside) -> tuple[list[Error], tuple[str, ...]]:
    """Velocities, accelerations and the like as the engine gives them, and the bodies without."""
    rows, missing = list[Error](), list[str]()
    for name in named("derived"):
        entry = QUANTITIES[name]
        instants = entry.instants(beside.run)
        time_s = beside.motion.time_s if instants is None else instants
        reference = beside.truth.at(time_s)
        at = _instants(beside, time_s, reference)
        tracks = beside.tracks((name,), reference)
        # Silence is no fault of an engine that does not report it, if it is silent of all.
        if entry.silent(beside.run) and all(np.all(np.isnan(track.error)) for track in tracks):
            missing += [f"{name} of {track.body_kind} {track.body}" for track in tracks]
            continue
        for track in tracks:
            rows += _rate_rows(track, at, "reported")
    return rows, tuple(missing)


def _differenced(beside: Beside, at: _Instants) -> Iterable[Error]:
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
            yield from _rate_rows(differenced, inner, "differenced")


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
