"""Rows of errors: a track in numbers, over all samples, or the first ones, those near change points
and the rest apart."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from models.array import Array, Mask
from models.motion import Motion
from reports.compare.beside import Beside
from reports.compare.change_points import WINDOW_RAD, near
from reports.compare.errors import Error, ErrorKind
from reports.compare.series import length, size
from reports.compare.tracks import Track
from reports.quantities.quantity import Source


@dataclass(frozen=True)
class Instants:
    """The samples of a series: time [s], commanded driver angle [rad], and whether they are in the
    window of a change point, each (T,); how many may be the start; what the driver is told in."""

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
        """The number of samples that are the start."""
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
    """The samples of a run at instants of its own, or of its forces."""
    driver_rad = beside.driver_at(time_s, reference)
    passed = near(reference.crossings, driver_rad, WINDOW_RAD)
    return Instants(time_s, driver_rad, passed, beside.settling, beside.scene.driver.unit)


def whole_row(
    track: Track, at: Instants, source: Source = "reported", kind: ErrorKind = "total"
) -> Error:
    """A track as numbers."""
    return _numbers(track, length(track.error), track.bound, at, source, kind)


def _numbers(
    track: Track, error: Array, bound: Array, at: Instants, source: Source, kind: ErrorKind
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
        driver_unit=at.driver_unit,
    )


def rate_rows(track: Track, at: Instants, source: Source) -> Iterable[Error]:
    """A rate as rows of its parts: the first samples, those at change points, and the rest."""
    error = length(track.error)
    for kind, part, instants in at.parts:
        yield _numbers(track, error[part], track.bound[part], instants, source, kind)
