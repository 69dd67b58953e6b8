"""Input of the hypotheses: the errors to be explained, and those that must not arise."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from models.array import Array
from models.errors import CrankcheckError
from reports.causes.account import CAUSE, NUMBER, Account
from reports.causes.cause import EXPLAINED, MOST, CauseSize, Excerpt, LogCase, Rows, picked
from reports.causes.world import World
from reports.logs.channel import Channel

SPOILT = 1.2
"""Ratio to its limit from which on a hypothesis spoils a channel that was within it."""
MISSING = 0.4
"""Part of the channels that a hypothesis affects which may have another fault as well."""
MENDED = 0.8
"""Part that may be left in a channel that comes within its limit by a fault of others."""
WELL = 0.02
"""Remaining part of an error explained too well to try expensive hypotheses."""
NOTHING_LEFT = 1e-3
"""Part of a signal that counts as nothing."""
FEW = 400
"""Rows for fits of numbers, before a trial on the others."""


@dataclass(frozen=True)
class Inquiry:
    """Excerpts of a case, by column, beside the reference in ``world``; the errors in ``open`` are
    to be explained. ``accounts`` are those found so far; the world is ``changed`` where it is no
    longer the scene as driven."""

    case: LogCase
    world: World
    excerpts: Mapping[str, Excerpt]
    open: tuple[str, ...]
    accounts: tuple[Account, ...] = ()
    changed: bool = False

    @staticmethod
    def of(case: LogCase) -> Inquiry:
        """Return the inquiry of a case. Raises CrankcheckError where the scene has no reference."""
        out = tuple(reading.channel.column for reading in case.out)
        return Inquiry(case, World.of(case.truth), case.excerpts, out)

    @property
    def period_s(self) -> float:
        return self.world.scene.driver.law.period_s

    @cached_property
    def step_s(self) -> float:
        """The median interval between the samples [s]."""
        times = self.case.log.time_s
        return float(np.median(np.diff(times))) if times.size > 1 else self.period_s

    @cached_property
    def thin(self) -> Inquiry:
        """The same with few rows, for fits of numbers."""
        return self.part(picked(self.rows, most=FEW))

    @property
    def rows(self) -> int:
        """Rows of the excerpts."""
        return max((each.rows.size for each in self.excerpts.values()), default=0)

    def part(self, rows: Rows) -> Inquiry:
        """Return the same with some of the rows, by their places in the excerpts."""
        parts = {column: each.part(rows) for column, each in self.excerpts.items()}
        return replace(self, excerpts=parts)

    @property
    def unclaimed(self) -> tuple[str, ...]:
        """Open columns that no account without a fitted number explains."""
        return self._open_beside(CAUSE + NUMBER, lambda column: EXPLAINED)

    @property
    def unexplained(self) -> tuple[str, ...]:
        """Open columns that no account with one number or none brings well within limits."""
        over = {
            column: excerpt.limit / excerpt.size.largest
            for column, excerpt in self.excerpts.items()
            if excerpt.size.largest > 0.0
        }
        return self._open_beside(
            CAUSE + 2 * NUMBER, lambda column: min(WELL, over.get(column, WELL))
        )

    def _open_beside(self, cost: float, enough: Callable[[str], float]) -> tuple[str, ...]:
        """Return the open columns of which each account below a cost leaves more than enough."""
        few = [account for account in self.accounts if account.cost < cost]
        well = {c for account in few for c, rest in account.rests.items() if rest <= enough(c)}
        return tuple(column for column in self.open if column not in well)

    @property
    def healthy(self) -> tuple[str, ...]:
        """The columns that were within their limits from the beginning."""
        return tuple(column for column, each in self.case.excerpts.items() if not each.out)

    def expected(self, world: World, columns: Iterable[str] | None = None) -> dict[str, Array]:
        """Return the reference in a world, by column (all of them). Raises CrankcheckError."""
        groups: dict[bytes, list[str]] = {}
        for column in self.excerpts if columns is None else columns:
            groups.setdefault(self.excerpts[column].instants.tobytes(), []).append(column)
        found: dict[str, Array] = {}
        for group in groups.values():
            channels = [self.channel(column) for column in group]
            motion = world.at(self.excerpts[group[0]].instants, channels)
            found |= {c: each.expected(motion) for c, each in zip(group, channels, strict=True)}
        return found

    def errors(self, world: World, columns: Iterable[str] | None = None) -> dict[str, Array]:
        """Return the errors against a world, by column. Raises CrankcheckError."""
        return self._beside(self.expected(world, columns))

    def _beside(self, expected: Mapping[str, Array]) -> dict[str, Array]:
        return {column: self.excerpts[column].beside(each) for column, each in expected.items()}

    def misfit(self, world: World, columns: Iterable[str]) -> Array:
        """Return the errors in a world over their sizes, joined. Raises CrankcheckError."""
        errors = self.errors(world, columns)
        return np.concatenate([errors[c] / self.excerpts[c].size.rms for c in columns])

    def channel(self, column: str) -> Channel:
        return self.excerpts[column].channel

    def account(
        self,
        name: str,
        cost: float,
        errors: Mapping[str, Array],
        phrase: str,
        *,
        corrections: Mapping[str, Mapping[str, object]] | None = None,
        expected: Mapping[str, Array] | None = None,
        besides: Iterable[str] = (),
    ) -> Account | None:
        """Return the account with these remaining ``errors``, by column, against another reference
        ``expected``; None where it explains no open column and none of ``besides``."""
        instead, told, mended = expected or {}, dict[str, float](), dict[str, float]()
        for column in (each for each in (*self.open, *besides) if each in errors):
            excerpt, error, other = self.excerpts[column], errors[column], instead.get(column)
            if column not in self.open or excerpt.explained(error, other):
                told[column] = excerpt.rest(error, other)
            # One fault of several channels may be small in some of them.
            elif expected is not None and CauseSize.of(error).largest <= SPOILT * excerpt.limit:
                mended[column] = excerpt.rest(error, other)
        if not told:
            return None
        told |= {column: rest for column, rest in mended.items() if rest < MENDED}
        lefts = {column: self.excerpts[column].left(errors[column]) for column in told}
        return Account(name, cost, told, lefts, phrase, corrections or {})

    def account_of_world(
        self,
        name: str,
        cost: float,
        world: World,
        phrase: str,
        among: Iterable[str] | None = None,
        missing: float = MISSING,
    ) -> Account | None:
        """Return the account of another ``world`` for the log (or its columns ``among``); None
        where there is no such mechanism, where a healthy channel would be off, or where more than
        the part ``missing`` of the affected channels stays unexplained."""
        try:
            expected = self.expected(world, among)
        except CrankcheckError:
            return None
        errors = self._beside(expected)
        told = self.account(name, cost, errors, phrase, expected=expected)
        if told is None or self.spoilt(errors):
            return None
        if all(self._vanishes(column, expected[column]) for column in told.rests):
            return None
        told = replace(told, world=world)
        moved = [c for c in self.open if c in expected and self.excerpts[c].moves(expected[c])]
        missed = [c for c in moved if c not in told.rests and c in self.unclaimed]
        return told if len(missed) <= missing * len(moved) else None

    def no_chance(self, account: Account) -> bool:
        """True if an account explains several channels, or one too well for a mere likeness."""
        if len(account.columns) > 1 or account.world is None:
            return True
        (column,) = account.columns
        return self.excerpts[column].told_apart(self.errors(account.world, [column])[column])

    def spoilt(self, errors: Mapping[str, Array]) -> tuple[str, ...]:
        """Return the columns that were healthy, and are not with these errors."""
        return tuple(
            column
            for column in self.healthy
            if column in errors
            and CauseSize.of(errors[column]).largest
            > max(SPOILT * self.excerpts[column].limit, 3.0 * self.excerpts[column].worst)
        )

    def _vanishes(self, column: str, expected: Array) -> bool:
        """True if the reference of a channel is next to nothing, as at times that show its zeros
        only: that would explain any readings next to nothing."""
        before = CauseSize.of_signal(self.excerpts[column].expected).rms
        return CauseSize.of_signal(expected).rms < NOTHING_LEFT * before

    def within(self, world: World, left: Iterable[str]) -> Inquiry | None:
        """Return the inquiry into the columns ``left`` in another world, if it has a mechanism."""
        try:
            expected = self.expected(world)
        except CrankcheckError:
            return None
        there = {column: self.excerpts[column].in_world(each) for column, each in expected.items()}
        return replace(self, world=world, excerpts=there, open=tuple(left), changed=True)

    def stretch(self, column: str) -> Inquiry:
        """Return the inquiry into rows around a column's largest error. Raises CrankcheckError."""
        excerpt = self.excerpts[column]
        rows = excerpt.reading.values.size
        worst = int(excerpt.rows[np.argmax(np.abs(excerpt.error))])
        first = max(0, min(worst - MOST // 2, rows - MOST))
        return self.into(column, np.arange(first, min(first + MOST, rows)))

    def into(self, column: str, rows: Rows) -> Inquiry:
        """Return the inquiry into one column at these rows of the log. Raises CrankcheckError."""
        excerpt = self.excerpts[column]
        reading, channel = excerpt.reading, excerpt.channel
        values, instants = reading.values[rows], reading.instants[rows]
        expected = channel.expected(self.world.at(instants, [channel]))
        there = replace(excerpt, rows=rows, values=values, instants=instants).in_world(expected)
        return replace(self, excerpts={column: there}, open=(column,))

    def whole(self, column: str) -> tuple[Array, Array]:
        """Return a column's readings and errors, 0 for missing numbers. Raises CrankcheckError."""
        reading = self.excerpts[column].reading
        channel = reading.channel
        if self.changed:
            expected = channel.expected(self.world.at(reading.instants, [channel]))
        else:
            expected = reading.expected(self.case.truth)
        error = channel.error(reading.values, expected)
        return reading.values, np.where(np.isfinite(error), error, 0.0)
