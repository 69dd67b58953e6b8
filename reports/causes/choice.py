"""Which accounts together tell most at the least cost."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from models.array import Array
from reports.causes.account import Account

LEAST_REST = 1e-4
"""What is left of an error by less than this part is nothing."""
UNTOLD = 2.0
"""What it costs to leave a channel unexplained, in powers of ten of what is left of its error."""
ORDER = 0.01
"""What a place farther down the list of hypotheses costs: accounts that leave the same are many."""

EQUAL = 0.3
"""What is left of an error by more or less than this may be the same."""


def chosen(accounts: Sequence[Account], columns: Sequence[str]) -> list[Account]:
    """The accounts, each of the columns that it tells best, that leave least of ``columns`` for
    what it costs to believe them; the world is one, so that at most one is of another."""
    if not accounts or not columns:
        return []
    table = _Table.of(accounts, columns)
    worlds = [n for n, account in enumerate(accounts) if account.world is not None]
    plain = [n for n, account in enumerate(accounts) if account.world is None]
    starts = [[], *([world] for world in worlds)]
    best = min((table.descended(start, plain) for start in starts), key=table.total)
    told = []
    for number in sorted(best):
        own = [c for n, c in enumerate(columns) if table.owner(best, worlds, n) == number]
        if own:
            told.append(_of(accounts[number], own))
    return told


def _of(account: Account, columns: Sequence[str]) -> Account:
    """An account of some of its columns."""
    return replace(
        account,
        rests={column: account.rests[column] for column in columns},
        lefts={column: account.lefts[column] for column in columns},
    )


class _Table:
    """What each account (a,) leaves of each column (c,), in powers of ten, and what it costs."""

    def __init__(self, left: Array, cost: Array) -> None:
        self.left, self.cost = left, cost

    @staticmethod
    def of(accounts: Sequence[Account], columns: Sequence[str]) -> _Table:
        left = np.full((len(accounts), len(columns)), UNTOLD)
        for number, account in enumerate(accounts):
            for place, column in enumerate(columns):
                if column in account.rests:
                    rest = max(account.rests[column], LEAST_REST)
                    left[number, place] = np.log10(rest) + ORDER * account.order
        return _Table(left, np.array([account.cost for account in accounts]))

    def total(self, some: Sequence[int]) -> float:
        """What some accounts leave and cost together."""
        return float(self._least(some).sum() + self.cost[list(some)].sum())

    def _least(self, some: Sequence[int]) -> Array:
        """What is left of each column by the account of some that leaves least."""
        least: Array = self.left[list(some)].min(axis=0, initial=UNTOLD)
        return least

    def owner(self, some: Sequence[int], worlds: Sequence[int], place: int) -> int | None:
        """The account of some that leaves least of a column, one of a world where that leaves about
        as little; None where none explains it."""

        def left(number: int) -> float:
            return float(self.left[number, place]) - (EQUAL if number in worlds else 0.0)

        best = min(some, key=left, default=None)
        return None if best is None or self.left[best, place] >= UNTOLD else best

    def descended(self, start: Sequence[int], plain: Sequence[int]) -> list[int]:
        """Accounts, those of the start among them, from which no account that is added, left out or
        put in the place of another lowers the total."""
        some, total = list(start), self.total(start)
        while True:
            kept = [some, *([n for n in some if n != out] for out in some if out not in start)]
            tried = [*kept[1:], *(each for base in kept for each in self._with_best(base, plain))]
            best = min(tried, key=self.total, default=some)
            if self.total(best) >= total - 1e-9:
                return some
            some, total = best, self.total(best)

    def _with_best(self, base: Sequence[int], plain: Sequence[int]) -> list[list[int]]:
        """Accounts and the one besides that lowers their total most."""
        if not plain:
            return []
        gained = np.minimum(self.left[list(plain)], self._least(base)).sum(axis=1)
        best = int(np.argmin(gained + self.cost[list(plain)]))
        return [[*base, plain[best]]] if plain[best] not in base else []
