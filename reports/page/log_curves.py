"""Curves of the channels of a log, in the units of their columns, beside the reference."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from models.array import Array
from models.motion import Motion
from models.scene.driver import driver_course, driver_shown
from reports.drawing.moving import goes_round
from reports.logs.channel import Reading
from reports.logs.kinds import UNITS
from reports.own_log.judged import JudgedLog, LogRow, log_rows

LEAST, MOST = 240, 6_000
"""Bounds on the rows drawn of a channel, for any number of channels and any length of the log."""
NEAR = 0.1
"""Share of the rows that shows the turn of the largest error alone, where the log is thinned."""
BYTES = 16
"""Characters of a drawn row in the page: its instant, log, error and phase."""
AT_ZERO = 1e-9
"""Distance to a whole turn [deg] below which an angle is that turn: rounding alone."""


@dataclass(frozen=True)
class Samples:
    """Drawn rows of a channel: their instants [s], the ``logged`` values and their ``error``, both
    in the unit and with the sign of the column, and the driver's ``phase`` (`_phase`). ``worst`` is
    the index of the largest error; ``is_thinned`` says that rows between them are left out."""

    time_s: Array
    phase: Array
    logged: Array
    error: Array
    worst: int
    is_thinned: bool


@dataclass(frozen=True)
class DrawnChannel:
    """A channel as it is drawn, in ``unit``: ``whole``, and ``near`` its largest error, None where
    ``whole`` leaves nothing out.

    ``judged`` are the errors of the table that the channel is part of, ``limit`` the limit of its
    own error [unit], None without; ``total`` counts the rows of the log. ``turn`` is a whole turn
    [unit] of a wrapped angle, else None; ``turns`` is the lead of another angle over the reference
    [turns].
    """

    column: str
    name: str
    unit: str
    reading: Reading | None
    judged: tuple[LogRow, ...]
    limit: float | None
    turn: float | None
    turns: int
    total: int
    whole: Samples
    near: Samples | None

    @property
    def taken(self) -> float:
        """The largest used share of a limit, below 0 where there is none."""
        return max((row.taken for row in self.judged), default=-1.0)

    @property
    def largest(self) -> float:
        """The largest error [unit], with its sign."""
        return float(self.whole.error[self.whole.worst])

    @property
    def worst_s(self) -> float:
        """Instant of the largest error [s]."""
        return float(self.whole.time_s[self.whole.worst])


def curves(judged: JudgedLog, room: int) -> list[DrawnChannel]:
    """Return the drawn part of each channel, in ``room`` characters, the worst first."""
    number = len(judged.log.readings) + len(judged.beside.run.gaps)
    most = round(room / (BYTES * max(number, 1) * (1.0 + NEAR)))
    drawing = _Drawing(judged, log_rows(judged), min(max(most, LEAST), MOST), turn_s(judged))
    found = [*drawing.of_readings(), *drawing.of_gaps()]
    return sorted(found, key=lambda curve: (-curve.taken, -_share(curve)))


def turn_s(judged: JudgedLog) -> float:
    """Return the time of a turn of the driver [s], or its period where it swings."""
    scene = judged.beside.scene
    if not goes_round(scene):
        return scene.driver.law.period_s
    angle = driver_course(scene, judged.beside.reference)[0]
    turned = abs(float(angle[-1] - angle[0]))
    time_s = judged.log.time_s
    return math.tau * float(time_s[-1] - time_s[0]) / turned if turned > 0.0 else math.inf


def _share(curve: DrawnChannel) -> float:
    """Return the used share of a channel's own limit; of two of a point, one is worse."""
    if curve.limit is None:
        return 0.0
    return abs(curve.largest) / curve.limit if math.isfinite(curve.largest) else math.inf


@dataclass(frozen=True)
class _Drawing:
    """Input of the drawn channels: the ``table`` of errors, about how many rows each may have, and
    the time of a turn [s]."""

    judged: JudgedLog
    table: Sequence[LogRow]
    most: int
    turn_s: float

    def of_readings(self) -> Iterator[DrawnChannel]:
        """Yield the channels, grouped by equal instants: the reference is solved for these once."""
        own = self.judged.log.time_s
        apart = []
        for reading in self.judged.log.readings:
            if np.array_equal(reading.instants, own):
                yield self._of_reading(reading, self.judged.beside.reference)
            else:
                apart.append(reading)
        for reading in sorted(apart, key=lambda each: each.instants.tobytes()):
            yield self._of_reading(reading, self.judged.beside.truth.at(reading.instants))

    def _of_reading(self, reading: Reading, truth: Motion) -> DrawnChannel:
        channel = reading.channel
        units = UNITS[channel.kind.dimension]
        of_one = channel.sign * units[channel.unit]
        expected = channel.expected(truth)
        error = channel.error(reading.values, expected)
        ahead = float(reading.values[0] - expected[0] - error[0])
        logged = reading.values / of_one - channel.offset
        own = tuple(row for row in self.table if channel.column in row.columns)
        total = next((row for row in own if row.error.kind == "total"), None)
        whole, near = self._samples(truth, logged, error / of_one)
        return DrawnChannel(
            column=channel.column,
            name=channel.name,
            unit=channel.unit,
            reading=reading,
            judged=own,
            limit=None if total is None else _limit(total, units[channel.unit]),
            turn=abs(math.tau / of_one) if channel.wrapped and channel.kind.turns else None,
            turns=0 if channel.wrapped else round(ahead / math.tau),
            total=error.size,
            whole=whole,
            near=near,
        )

    def of_gaps(self) -> Iterator[DrawnChannel]:
        """Yield the gaps that are judged: each is its own error."""
        for row in self.table:
            if (row.error.quantity, row.error.kind) != ("gap", "total"):
                continue
            gap = self.judged.beside.run.gaps[row.error.body]
            whole, near = self._samples(self.judged.beside.reference, gap, gap)
            yield DrawnChannel(
                column=f"gap of {row.error.body}",
                name=f"gap of {row.error.body}",
                unit="m",
                reading=None,
                judged=(row,),
                limit=_limit(row, 1.0),
                turn=None,
                turns=0,
                total=gap.size,
                whole=whole,
                near=near,
            )

    def _samples(
        self, truth: Motion, logged: Array, error: Array
    ) -> tuple[Samples, Samples | None]:
        """Return the drawn rows of the whole, and near the largest error if that is thinned."""
        rows = extreme_rows((logged, error), self.most)
        whole = self._at(truth, logged, error, rows, rows.size < error.size)
        if not whole.is_thinned:
            return whole, None
        middle = whole.time_s[whole.worst]
        ends = (middle - self.turn_s / 2.0, middle + self.turn_s / 2.0)
        first, last = np.searchsorted(truth.time_s, ends)
        part = slice(int(first), int(last) + 1)
        some = extreme_rows((logged[part], error[part]), max(round(NEAR * self.most), LEAST))
        thinned = some.size < error[part].size
        return whole, self._at(truth, logged, error, some + part.start, thinned)

    def _at(
        self, truth: Motion, logged: Array, error: Array, rows: Rows, is_thinned: bool
    ) -> Samples:
        off = error[rows]
        # A value that is not finite is larger than all.
        worst = int(np.argmax(np.where(np.isfinite(off), np.abs(off), np.inf)))
        return Samples(
            time_s=truth.time_s[rows],
            phase=_phase(self.judged, truth, rows),
            logged=logged[rows],
            error=off,
            worst=worst,
            is_thinned=is_thinned,
        )


def _limit(row: LogRow, unit: float) -> float | None:
    limit = row.limit.number * row.error.scale / unit
    return limit if math.isfinite(limit) else None


def _phase(judged: JudgedLog, truth: Motion, rows: Rows) -> Array:
    """Return the phase of the driver at some rows: its angle within a turn [deg], or, where it
    swings, the part of its period [%]."""
    scene = judged.beside.scene
    if not goes_round(scene):
        since = truth.time_s[rows] - judged.log.time_s[0]
        return np.asarray(100.0 * np.mod(since / scene.driver.law.period_s, 1.0))
    angle = driver_shown(scene, truth)[rows]
    return np.asarray(np.mod(angle + AT_ZERO, 360.0))


Rows = NDArray[np.intp]


def extreme_rows(series: Sequence[Array], most: int) -> Rows:
    """Return the rows to be drawn of series that belong together, about ``most`` of them: all where
    there are no more, else the first, the last, and the smallest and largest of each series in
    every stretch. All series are of shape (T,)."""
    number = series[0].size
    if number <= most:
        return np.arange(number)
    length = math.ceil(number * 2 * len(series) / most)
    picked = [np.array([0, number - 1])]
    for each in series:
        missing = np.isnan(each)
        picked.append(_lowest(np.where(missing, np.inf, each), length))
        picked.append(_lowest(np.where(missing, np.inf, -each), length))
    return np.unique(np.concatenate(picked))


def _lowest(series: Array, length: int) -> Rows:
    """Return the row of the smallest number in each stretch of so many rows."""
    spare = -series.size % length
    stretches = np.pad(series, (0, spare), mode="edge").reshape(-1, length)
    rows: Rows = np.argmin(stretches, axis=1) + length * np.arange(len(stretches))
    return rows.clip(max=series.size - 1)
