"""Rows that a log has lost, or has twice, where the times of the others were closed up."""

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from models.array import Array
from reports.causes.account import CAUSE, CHOICE, NUMBER, Account
from reports.causes.cause import MOST, Rows, within_half_a_turn
from reports.causes.inquiry import Inquiry
from reports.output.numbers import listed

FARTHEST, TWICE = 1000, 25
"""Rows that may be lost altogether, up to a period; and the ratio of them to those there twice."""
EVEN = 0.1
"""Largest offset of a time from the even grid, in intervals."""
OFF, JUMP = 100.0, 200.0
"""Largest cost of a reading, as the square of its error over the noise, and cost of one place."""
FINE = 0.01
"""Least noise, over the limit."""
FEW, FEWEST = 0.03, 3
"""Part of the rows before which some may be lost, and their number in any log."""
SHOWN = 3


def lost_rows(inquiry: Inquiry) -> Iterator[Account | None]:
    """Yield accounts of channels that belong to later rows from some rows on."""
    columns, times = list(inquiry.open), inquiry.case.log.time_s
    even = np.ptp(np.diff(times)) < EVEN * inquiry.step_s
    if not inquiry.unexplained or inquiry.world.drive is not None or not even:
        return
    out = [np.abs(each.error) > each.limit for each in map(inquiry.excerpts.get, columns) if each]
    rows = inquiry.excerpts[columns[0]].rows
    first = max(0, int(rows[np.argmax(np.any(out, axis=0))]) - MOST // 2)
    some = np.arange(first, min(first + MOST, times.size))
    found = {column: inquiry.into(column, some).excerpts[column] for column in columns}
    while columns:  # those of another stream may have lost others
        told = _told(replace(inquiry, excerpts=found, open=tuple(columns)), columns, first)
        yield told
        columns = [column for column in columns if told and column not in told.columns]


def _told(there: Inquiry, columns: Sequence[str], first: int) -> Account | None:
    """Return the account of rows lost in as many of some columns as agree on the places."""
    most = int(min(FARTHEST, there.period_s / there.step_s, there.rows))
    shifts, row = np.arange(-(most // TWICE), most + 1), np.arange(there.rows)
    place = np.arange(shifts[0], there.rows + shifts[-1])
    tables = {column: _table(there, column, place, shifts.size) for column in columns}
    path = np.full(there.rows, -shifts[0])
    for _ in range(2):  # at first with the noise of the first rows, then with that of all
        squares = np.tile(1e-6 * np.where(shifts < 0, -TWICE * shifts, shifts), (row.size, 1))
        few = row if np.any(np.diff(path)) else row[: 1 + row.size // 10]
        for column, table in tables.items():
            excerpt, limit = there.excerpts[column], there.excerpts[column].limit
            error = (excerpt.expected + excerpt.error)[:, None] - table
            if excerpt.channel.wrapped:
                error = within_half_a_turn(error)
            usual = np.median(np.abs(error[few, path[few]]))
            noise = max(usual, np.median(np.abs(np.diff(excerpt.error))))
            squares += np.fmin(np.square(error / np.clip(noise, FINE * limit, limit)), OFF)
        path = _cheapest(squares, -int(shifts[0]))
    lost = np.diff(path)
    places = np.flatnonzero(lost) + 1
    if not 0 < places.size <= max(FEWEST, FEW * row.size):
        return None
    expected = {column: table[row, path] for column, table in tables.items()}
    errors = {c: there.excerpts[c].beside(each) for c, each in expected.items()}
    errors = {c: each for c, each in errors.items() if there.excerpts[c].told_apart(each)}
    times = there.case.log.time_s[first + places]
    each = [
        f"{abs(count)}{' too many' if count < 0 else ''} before sample {at} (t = {time:.6g} s)"
        for count, at, time in zip(lost[places - 1], first + places, times, strict=True)
    ]
    more = [f"{len(each) - SHOWN} times more"] if len(each) > SHOWN else []
    phrase = "{who} lack{s} rows, with the times of the others closed up: "
    phrase += listed(each[:SHOWN] + more)
    cost = CAUSE + NUMBER + CHOICE * min(places.size, 4)
    return there.account("lost rows", cost, errors, phrase, expected=expected)


def _table(there: Inquiry, column: str, place: Rows, width: int) -> Array:
    """Return the reference (n, width) of so many rows around each. Raises CrankcheckError."""
    channel, (start, end) = there.channel(column), there.excerpts[column].instants[[0, -1]]
    instants = start + (end - start) / (there.rows - 1) * place
    signal = channel.expected(there.world.at(instants, [channel]))
    return sliding_window_view(signal, width)


def _cheapest(cost: Array, start: int) -> Rows:
    """Return the states (n,) from ``start`` on with the least sum of costs (n, s) and jumps, by
    dynamic programming (Viterbi, IEEE Trans. Inf. Theory 13, 1967)."""
    total = np.where(np.arange(cost.shape[1]) == start, 0.0, np.inf)
    before = np.empty(cost.shape, dtype=np.intp)
    for row, each in enumerate(cost):
        best = int(np.argmin(total))
        stays = total <= total[best] + JUMP
        before[row] = np.where(stays, np.arange(total.size), best)
        total = np.where(stays, total, total[best] + JUMP) + each
    path = np.empty(len(cost), dtype=np.intp)
    path[-1] = np.argmin(total)
    for row in range(len(cost) - 1, 0, -1):
        path[row - 1] = before[row, path[row]]
    return path
