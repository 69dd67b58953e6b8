"""A log with errors over its limits, and the causes that explain them."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from models.array import Array
from reports.compare.compare import Truth
from reports.logs.channel import Channel, OwnLog, Reading


@dataclass(frozen=True)
class LogCase:
    """Log beside the reference of its scene as driven, with the limit of the error of each channel
    [SI], by column. A channel without a limit is not judged."""

    log: OwnLog
    truth: Truth
    limits: Mapping[str, float]

    @property
    def readings(self) -> tuple[Reading, ...]:
        """All readings, including further bodies' copies of a point."""
        return (*self.log.readings, *self.log.copies)

    @cached_property
    def excerpts(self) -> Mapping[str, Excerpt]:
        """The excerpt of each judged channel, all at the same rows, including those of the largest
        errors. Raises CrankcheckError without a reference."""
        judged = [reading for reading in self.readings if reading.channel.column in self.limits]
        motions, told = {}, []
        for reading in judged:
            of = id(reading.instants)
            if of not in motions:
                motions[of] = self.truth.at(reading.instants)
            expected = reading.channel.expected(motions[of])
            error = np.abs(_finite(reading.channel.error(reading.values, expected)))
            row = int(np.argmax(error)) if error.size else 0
            told.append((reading, expected, row, float(error[row])))
        besides = [row for _, _, row, _ in told]
        rows = picked(max((r.values.size for r in judged), default=0), besides)
        return {
            reading.channel.column: Excerpt(
                reading=reading,
                limit=self.limits[reading.channel.column],
                worst=worst,
                rows=rows,
                values=reading.values[rows],
                instants=reading.instants[rows],
                expected=expected[rows],
                error=_finite(reading.channel.error(reading.values[rows], expected[rows])),
            )
            for reading, expected, _, worst in told
        }

    @property
    def out(self) -> tuple[Reading, ...]:
        """The readings with errors over their limits."""
        return tuple(excerpt.reading for excerpt in self.excerpts.values() if excerpt.out)


@dataclass(frozen=True)
class Cause:
    """Cause of errors, or of a delay within the limits, in some channels.

    ``text`` names the fault, the channels and the numbers. ``correction`` is the map entry for each
    of ``columns``, and ``of_column`` the entries where they differ by column; both are empty if no
    map corrects the log. ``left`` is the largest remaining error over the original one, in the
    channel where that ratio is largest.
    """

    name: str
    columns: tuple[str, ...]
    text: str
    correction: Mapping[str, object]
    left: float
    of_column: Mapping[str, Mapping[str, object]] = field(default_factory=dict)


Rows = NDArray[np.intp]
MOST = 1500
"""Rows on which hypotheses are tried."""
GOLDEN = 0.6180339887498949
EXPLAINED = 0.1
"""Part of an error that an explanation may leave."""
NOUGHT = 1e-3
"""A value below this part of its limit counts as 0."""
TIGHT = 0.02
"""Part that an unspecific explanation may leave, unless the rest is noise."""
ROUGH = 1.0
"""Mean square of the steps of a series over its own, above which it is noise: 2 where no sample
predicts the next one (von Neumann, Ann. Math. Stat. 12, 1941)."""
MOVED = 0.3
"""A hypothesis affects a channel if it changes the reference by this part of its error."""
BROUGHT_WITHIN = 1.0 / 3.0
"""Part that may be left where the channel is then within its limit."""
ROUNDING = 1e-9
"""Part of the longest link, or angle [rad], below which a fitted number is rounding."""


@dataclass(frozen=True)
class Excerpt:
    """Readings of a channel (n,) at ``rows`` of the log, with their instants [s], their
    ``expected`` values (the reference), and their ``error`` [SI], 0 where a number is missing.

    ``worst`` is the largest error in the whole log.
    """

    reading: Reading
    limit: float
    worst: float
    rows: Rows
    values: Array
    instants: Array
    expected: Array
    error: Array

    @property
    def channel(self) -> Channel:
        return self.reading.channel

    @property
    def out(self) -> bool:
        """True if a reading is off by more than the limit."""
        return self.worst > self.limit

    def beside(self, expected: Array, values: Array | None = None) -> Array:
        """Return the error of the readings, or of other ``values``, against another reference."""
        return _finite(self.channel.error(self.values if values is None else values, expected))

    def moves(self, expected: Array, least: float = 0.0) -> bool:
        """True if another reference changes the error noticeably, and by more than ``least``."""
        change = CauseSize.of(self.beside(expected) - self.error).largest
        return change > max(least, MOVED * self.size.largest)

    def in_world(self, expected: Array) -> Excerpt:
        """Return the same readings against another reference; ``worst`` is that of these rows."""
        error = self.beside(expected)
        return replace(self, expected=expected, error=error, worst=float(np.max(np.abs(error))))

    def part(self, rows: Rows) -> Excerpt:
        """Return some of the rows, by their places in the excerpt."""
        names = ("rows", "values", "instants", "expected", "error")
        return replace(self, **{name: getattr(self, name)[rows] for name in names})

    @cached_property
    def size(self) -> CauseSize:
        """Scale of remaining errors: the size of the error, or of the signal where that is less."""
        return self.size_beside(self.expected)

    def size_beside(self, expected: Array) -> CauseSize:
        """Return the scale for another reference: an explanation has to predict the readings, and
        not merely to be nearer than a large error. A signal of 0 sets no bound."""
        sizes = CauseSize.of(self.error), CauseSize.of_signal(expected, self.nothing)
        return CauseSize(min(each.largest for each in sizes), min(each.rms for each in sizes))

    @property
    def nothing(self) -> float:
        """Magnitude that counts as 0 [SI]."""
        return NOUGHT * self.limit if math.isfinite(self.limit) else 0.0

    @property
    def nought(self) -> bool:
        """True if the reference is 0, to within the magnitude that counts."""
        return CauseSize.of(self.expected[np.isfinite(self.expected)]).largest <= self.nothing

    def rest(self, error: Array, expected: Array | None = None) -> float:
        """Return the remaining part of the error if it is ``error``, against another reference
        ``expected``: by maximum or root mean square, whichever is more; infinite if missing."""
        left = CauseSize.of(error)
        size = self.size if expected is None else self.size_beside(expected)
        pairs = ((left.largest, size.largest), (left.rms, size.rms))
        return max(part / whole if whole > 0.0 else np.inf for part, whole in pairs)

    def left(self, error: Array) -> float:
        """Return the largest remaining error over the original one."""
        before = max(CauseSize.of(self.error).largest, np.finfo(float).tiny)
        return CauseSize.of(error).largest / before

    def explained(self, error: Array, expected: Array | None = None) -> bool:
        """True if the remaining error is small enough for an explanation."""
        rest = self.rest(error, expected)
        within = CauseSize.of(error).largest <= self.limit
        return rest <= (BROUGHT_WITHIN if within else EXPLAINED)

    def told_apart(self, error: Array) -> bool:
        """True if the residual is negligible or noise: the explanation is more than a likeness."""
        rough = np.sum(np.diff(error) ** 2) > ROUGH * np.sum((error - np.mean(error)) ** 2)
        return self.rest(error) <= TIGHT or bool(rough)


@dataclass(frozen=True)
class CauseSize:
    """Size of a series: its largest magnitude and its root mean square."""

    largest: float
    rms: float

    @staticmethod
    def of(series: Array) -> CauseSize:
        largest = float(np.max(np.abs(series), initial=0.0))
        if not 0.0 < largest < np.inf:
            return CauseSize(largest, largest)
        return CauseSize(largest, largest * float(np.sqrt(np.mean((series / largest) ** 2))))

    @staticmethod
    def of_signal(series: Array, nought: float = 0.0) -> CauseSize:
        """Return the size of the motion of a series, or of its value where it is constant; infinite
        where the series is at most ``nought``."""
        series = series[np.isfinite(series)]
        whole = CauseSize.of(series)
        if whole.largest <= nought:
            return CauseSize(np.inf, np.inf)
        moving = CauseSize.of(series - 0.5 * (series.max() + series.min()))
        return moving if moving.largest > 1e-9 * whole.largest else whole


def within_half_a_turn(angle_rad: Array) -> Array:
    """Return angles without their whole turns, from -pi to below pi [rad]."""
    return np.asarray(np.remainder(angle_rad + math.pi, math.tau) - math.pi)


def levelled(error: Array, channel: Channel) -> tuple[float, Array]:
    """Return the mean of an error, and the error less it. For an angle the mean is the one nearest
    to 0 by whole turns; a wrapped angle takes the nearest turn again at every sample."""
    if not channel.kind.turns:
        zero = float(np.mean(error))
        return zero, error - zero
    middle = float(np.angle(np.mean(np.exp(1j * error))))
    near = within_half_a_turn(error - middle)
    zero = middle + float(np.mean(near))
    if channel.wrapped:
        return zero, near - (zero - middle)
    left = error - zero
    return zero, left - math.tau * np.round(left[:1] / math.tau)


def _finite(error: Array) -> Array:
    return np.where(np.isfinite(error), error, 0.0)


def picked(rows: int, besides: Sequence[int] = (), most: int = MOST) -> Rows:
    """Return about ``most`` rows spread over a log, and those ``besides``; unevenly, as an even
    rhythm could be the mechanism's own."""
    if rows <= most:
        return np.arange(rows)
    place = np.arange(most)
    spread = ((place + (place * GOLDEN) % 1.0) * (rows / most)).astype(np.intp)
    return np.unique(np.concatenate([spread, [0, rows - 1], np.array(besides, dtype=np.intp)]))
