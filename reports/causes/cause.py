"""A log that is off, and what explains that it is."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from models.array import Array
from reports.compare.beside import Truth
from reports.logs.channel import Channel, OwnLog, Reading


@dataclass(frozen=True)
class LogCase:
    """A log beside the truth of its scene as it is driven, with what the error of each channel may
    be [SI], by column; what has no limit is not judged."""

    log: OwnLog
    truth: Truth
    limits: Mapping[str, float]

    @property
    def readings(self) -> tuple[Reading, ...]:
        """All readings, those of further bodies' copies of a point as well."""
        return (*self.log.readings, *self.log.copies)

    @cached_property
    def excerpts(self) -> Mapping[str, Excerpt]:
        """The excerpt of each channel that is judged, by column. Raises CrankcheckError where there
        is no reference."""
        return excerpts(self.readings, self.truth, self.limits)

    @property
    def out(self) -> tuple[Reading, ...]:
        """The readings that are further off than they may be."""
        return tuple(excerpt.reading for excerpt in self.excerpts.values() if excerpt.out)


@dataclass(frozen=True)
class Cause:
    """What explains that some channels are off, or late though they are not off.

    ``text`` names the fault, the channels and the numbers. ``correction`` is what to write in the
    map for each of ``columns``, and ``of_column`` where that is something else for each of them;
    both are empty where no map mends the log. ``left`` is the largest error that remains, over the
    one that there was, in the channel where that is most.
    """

    name: str
    columns: tuple[str, ...]
    text: str
    correction: Mapping[str, object]
    left: float
    of_column: Mapping[str, Mapping[str, object]] = field(default_factory=dict)


Rows = NDArray[np.intp]
MOST = 1500
"""Rows that hypotheses are tried on."""
GOLDEN = 0.6180339887498949
EXPLAINED = 0.1
"""The part of an error that may be left by what explains it."""
NOUGHT = 1e-3
"""What is less than this part of its limit is as good as 0."""
TIGHT = 0.02
"""The part that may be left by what is like many other things, unless that is noise."""
ROUGH = 1.0
"""The mean square of the steps of a series over its own, from which on it is noise: 2 where no
sample says anything of the next one (von Neumann, Ann. Math. Stat. 12, 1941)."""
BROUGHT_WITHIN = 1.0 / 3.0
"""The part that may be left where the channel is within its limit then."""


@dataclass(frozen=True)
class Excerpt:
    """Readings of a channel (n,) at ``rows`` of the log, with the instants [s] that they belong to,
    what was ``expected`` of them, and their ``error`` [SI], 0 where a number is missing.

    ``worst`` is the largest error in the whole log, and ``over`` counts the readings over
    ``limit`` there.
    """

    reading: Reading
    limit: float
    worst: float
    over: int
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
        """Whether a reading is further off than it may be."""
        return self.worst > self.limit

    def beside(self, expected: Array, values: Array | None = None) -> Array:
        """The error of the readings, or of other ``values``, against what else may be expected."""
        return _finite(self.channel.error(self.values if values is None else values, expected))

    def in_world(self, expected: Array) -> Excerpt:
        """The same readings where something else is expected; ``worst`` is that of its rows."""
        error = self.beside(expected)
        worst, over = float(np.max(np.abs(error))), int(np.sum(np.abs(error) > self.limit))
        return replace(self, expected=expected, error=error, worst=worst, over=over)

    def part(self, rows: Rows) -> Excerpt:
        """Some of its rows, by their places in the excerpt."""
        names = ("rows", "values", "instants", "expected", "error")
        return replace(self, **{name: getattr(self, name)[rows] for name in names})

    @cached_property
    def size(self) -> CauseSize:
        """What is left is over it: the error, or the signal where that is less."""
        return self.size_beside(self.expected)

    def size_beside(self, expected: Array) -> CauseSize:
        """The same where something else is expected, as an explanation has to tell the readings,
        and not merely to be nearer than what is far off. A signal of nothing bounds nothing."""
        return CauseSize.of(self.error).least(CauseSize.of_signal(expected, self.nothing))

    @property
    def nothing(self) -> float:
        """What is as good as 0 [SI]."""
        return NOUGHT * self.limit if math.isfinite(self.limit) else 0.0

    @property
    def nought(self) -> bool:
        """Whether nothing but 0 is expected, by what counts."""
        return CauseSize.of(self.expected[np.isfinite(self.expected)]).largest <= self.nothing

    def rest(self, error: Array, expected: Array | None = None) -> float:
        """What is left of the error where it is ``error`` instead, and something else ``expected``:
        the largest or the root mean square, whichever is more; no number is infinitely much."""
        left, size = (
            CauseSize.of(error),
            self.size if expected is None else self.size_beside(expected),
        )
        pairs = ((left.largest, size.largest), (left.rms, size.rms))
        return max(part / whole if whole > 0.0 else np.inf for part, whole in pairs)

    def left(self, error: Array) -> float:
        """The largest error that is left, over the one that there was."""
        return CauseSize.of(error).largest / max(
            CauseSize.of(self.error).largest, np.finfo(float).tiny
        )

    def explained(self, error: Array, expected: Array | None = None) -> bool:
        """Whether so little is left that the error is explained."""
        rest = self.rest(error, expected)
        within = CauseSize.of(error).largest <= self.limit
        return rest <= (BROUGHT_WITHIN if within else EXPLAINED)

    def told_apart(self, error: Array) -> bool:
        """Whether what is left is next to nothing, or noise, so that what leaves it is not merely
        like what there is."""
        return self.rest(error) <= TIGHT or _rough(error)


def _rough(series: Array) -> bool:
    """Whether a series is noise, of which no sample says anything of the next."""
    centred = series - np.mean(series)
    return bool(np.sum(np.diff(series) ** 2) > ROUGH * np.sum(centred**2))


@dataclass(frozen=True)
class CauseSize:
    """How large a series is: its largest magnitude and its root mean square."""

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
        """That of how a series moves, or of its number where it stays; no bound where that is no
        more than ``nought``."""
        series = series[np.isfinite(series)]
        whole = CauseSize.of(series)
        if whole.largest <= nought:
            return CauseSize(np.inf, np.inf)
        moving = CauseSize.of(series - 0.5 * (series.max() + series.min()))
        return moving if moving.largest > 1e-9 * whole.largest else whole

    def least(self, other: CauseSize) -> CauseSize:
        return CauseSize(min(self.largest, other.largest), min(self.rms, other.rms))


def levelled(error: Array, channel: Channel) -> tuple[float, Array]:
    """The mean of an error, and the error less it; of an angle the mean that is nearest to 0, by
    whole turns, and of a wrapped one again the nearest turn at every sample."""
    if not channel.kind.turns:
        zero = float(np.mean(error))
        return zero, error - zero
    middle = float(np.angle(np.mean(np.exp(1j * error))))
    near = np.remainder(error - middle + math.pi, math.tau) - math.pi
    zero = middle + float(np.mean(near))
    if channel.wrapped:
        return zero, near - (zero - middle)
    left = error - zero
    return zero, left - math.tau * np.round(left[:1] / math.tau)


def excerpts(
    readings: Sequence[Reading], truth: Truth, limits: Mapping[str, float]
) -> dict[str, Excerpt]:
    """The excerpt of each reading that has a limit, by column: all at the same rows, among them
    those of the largest errors. Raises CrankcheckError where there is no reference."""
    judged = [reading for reading in readings if reading.channel.column in limits]
    motions, told = {}, []
    for reading in judged:
        of = id(reading.instants)
        if of not in motions:
            motions[of] = truth.at(reading.instants)
        expected = reading.channel.expected(motions[of])
        error = np.abs(_finite(reading.channel.error(reading.values, expected)))
        limit = limits[reading.channel.column]
        row = int(np.argmax(error)) if error.size else 0
        told.append((reading, expected, row, float(error[row]), int(np.sum(error > limit))))
    rows = picked(
        max((r.values.size for r in judged), default=0), [row for _, _, row, _, _ in told]
    )
    return {
        reading.channel.column: Excerpt(
            reading=reading,
            limit=limits[reading.channel.column],
            worst=worst,
            over=over,
            rows=rows,
            values=reading.values[rows],
            instants=reading.instants[rows],
            expected=expected[rows],
            error=_finite(reading.channel.error(reading.values[rows], expected[rows])),
        )
        for reading, expected, _, worst, over in told
    }


def _finite(error: Array) -> Array:
    """An error with 0 where it is no number."""
    return np.where(np.isfinite(error), error, 0.0)


def picked(rows: int, besides: Sequence[int] = (), most: int = MOST) -> Rows:
    """At most some ``most`` rows spread over a log, and those ``besides``; in no even rhythm, that
    could be the mechanism's own."""
    if rows <= most:
        return np.arange(rows)
    place = np.arange(most)
    spread = ((place + (place * GOLDEN) % 1.0) * (rows / most)).astype(np.intp)
    return np.unique(np.concatenate([spread, [0, rows - 1], np.array(besides, dtype=np.intp)]))
