"""Accounts of errors by hypotheses: their cost, which together tell most, and their words."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from models.array import Array
from models.errors import CrankcheckError, few
from reports.causes.world import World
from reports.logs.channel import Channel
from reports.output.numbers import duration, listed

CAUSE, CHOICE, NUMBER = 0.5, 0.5, 1.0
"""What it takes to believe that there is a cause at all, that it is one of several, and that a
number in it is what it is, in powers of ten of what is left of an error: a cause with one more
number has to leave ten times less."""

BOUNDED = 0.05
"""What counts as left of an error that has the size and the shape that it may have from some fault,
where that does not tell each number."""


@dataclass(frozen=True)
class Account:
    """What one hypothesis says.

    ``rests`` is what it leaves of each error that it explains, by column, and ``lefts`` the largest
    error that is left over the one that there was. ``phrase`` has ``{who}`` for the channels, and
    verbs as ``{is}``, ``{has}``, ``{belongs}`` or ``{s}``; without them it is about the log as a
    whole, and accounts with the same phrase are told as one. ``corrections`` is what to write in
    the map, by column. A ``world`` is what the whole log is of, if this is so. ``order`` is the
    place of the hypothesis in its list.
    """

    name: str
    cost: float
    rests: Mapping[str, float]
    lefts: Mapping[str, float]
    phrase: str
    corrections: Mapping[str, Mapping[str, object]] = field(default_factory=dict)
    world: World | None = None
    order: int = 0

    @property
    def columns(self) -> tuple[str, ...]:
        return tuple(self.rests)


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
    table = _AccountTable.of(accounts, columns)
    worlds = [n for n, account in enumerate(accounts) if account.world is not None]
    plain = [n for n, account in enumerate(accounts) if account.world is None]
    starts = [[], *([world] for world in worlds)]
    best = min((table.descended(start, plain) for start in starts), key=table.total)
    told = []
    for number in sorted(best):
        own = [c for n, c in enumerate(columns) if table.owner(best, worlds, n) == number]
        if own:
            rests, lefts = accounts[number].rests, accounts[number].lefts
            rests, lefts = ({c: each[c] for c in own} for each in (rests, lefts))
            told.append(replace(accounts[number], rests=rests, lefts=lefts))
    return told


class _AccountTable:
    """What each account (a,) leaves of each column (c,), in powers of ten, and what it costs."""

    def __init__(self, left: Array, cost: Array) -> None:
        self.left, self.cost = left, cost

    @staticmethod
    def of(accounts: Sequence[Account], columns: Sequence[str]) -> _AccountTable:
        left = np.full((len(accounts), len(columns)), UNTOLD)
        for number, account in enumerate(accounts):
            for place, column in enumerate(columns):
                if column in account.rests:
                    rest = max(account.rests[column], LEAST_REST)
                    left[number, place] = np.log10(rest) + ORDER * account.order
        return _AccountTable(left, np.array([account.cost for account in accounts]))

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


NAMED = 3
"""Channels that are named each; of more the columns are listed."""
SHOWN = 8
CLASSES: Mapping[str, Callable[[Channel], bool]] = {
    "channels": lambda channel: True,
    "rates": lambda channel: channel.kind.order > 0,
    "velocities": lambda channel: channel.kind.order == 1,
    "accelerations": lambda channel: channel.kind.order == 2,
    "places": lambda channel: channel.kind.order == 0,
    "angles": lambda channel: channel.kind.turns,
    "angles and their rates": lambda channel: channel.kind.body_kind == "link",
    "lengths": lambda channel: channel.kind.dimension == "length",
    "lengths and their rates": lambda channel: channel.kind.body_kind != "link",
}
"""Classes of channels, by what they are called together."""


def who(channels: Sequence[Channel], every: Sequence[Channel]) -> str:
    """Channels in a sentence; a class of ``every`` channel of the log by its name."""
    columns = f"(columns {few([channel.column for channel in channels], SHOWN)})"
    chosen = {channel.column for channel in channels}
    for name, belongs in CLASSES.items():
        if len(chosen) > 1 and chosen == {c.column for c in every if belongs(c)}:
            return f"all {name} {columns}"
    if len(channels) > NAMED:
        return f"{len(channels)} channels {columns}"
    return listed([f"{channel.name} (column {channel.column})" for channel in channels])


def sentence(phrase: str, channels: Sequence[Channel], every: Sequence[Channel]) -> str:
    """A phrase with its channels and the verbs that go with them."""
    many = len(channels) > 1
    verbs = {"is": "are", "has": "have", "was": "were", "does": "do", "s": ""}
    words = {one: other if many else one for one, other in verbs.items()}

    def word(match: re.Match[str]) -> str:
        name = match.group(1)
        if name == "who":
            return who(channels, every)
        if name in words:
            return words[name]
        return name.removesuffix("s") if many else name

    return re.sub(r"\{(\w+)\}", word, phrase)


def later(by_s: float, step_s: float) -> str:
    """A delay in samples and seconds: 0.50 samples (0.69 ms) later."""
    samples = abs(by_s) / step_s
    digits = 2 if samples < 100 else 0
    direction = "later" if by_s > 0.0 else "earlier"
    return f"{samples:.{digits}f} samples ({duration(abs(by_s))}) {direction}"


def number(value: float, digits: int = 4) -> str:
    """A number with few digits, 0 where it is nothing."""
    return f"{value:.{digits}g}"


def change(now: float, before: float) -> str:
    """How much more a number is than another one that is not 0: +1 %, -120 ppm."""
    share = now / before - 1.0
    if abs(share) < 0.9995e-3:
        return f"{1e6 * share:+.3g} ppm"
    return f"{100.0 * share:+.3g} %"


ROUNDS = 30
HALVINGS = 5
SETTLED = 1e-4
"""A round that takes less of what is left than this part of it is the last one."""

Residual = Callable[[Array], Array]
"""Of parameters (p,) the residuals (n,); it raises CrankcheckError where there are none."""


def fitted(
    residual: Residual, start: Sequence[float], delta: Sequence[float], rounds: int = ROUNDS
) -> Array | None:
    """The parameters (p,) near ``start`` that leave the least, with differences of ``delta``, after
    at most so many rounds; a step that leaves more is halved. None where there are no residuals at
    the start."""
    at = np.array(start, dtype=float)
    left = _at(residual, at)
    if left is None:
        return None
    for _ in range(rounds):
        slopes = _slopes(residual, at, left, delta)
        if slopes is None:
            break
        step = np.linalg.lstsq(slopes, -left, rcond=None)[0]
        size, better = float(left @ left), None
        for _ in range(HALVINGS):
            better = _at(residual, at + step)
            if better is not None and float(better @ better) < size:
                break
            step, better = 0.5 * step, None
        if better is None:
            break
        at, left = at + step, better
        if float(left @ left) > (1.0 - SETTLED) * size:
            break
    return at


def _slopes(residual: Residual, at: Array, left: Array, delta: Sequence[float]) -> Array | None:
    """The change of the residuals (n, p) with each parameter."""
    columns = []
    for number, each in enumerate(delta):
        moved = at.copy()
        moved[number] += each
        found = _at(residual, moved)
        if found is None:
            return None
        columns.append((found - left) / each)
    return np.stack(columns, axis=1)


def _at(residual: Residual, parameters: Array) -> Array | None:
    """The residuals; None where there are none, or numbers that are none."""
    try:
        found = residual(parameters)
    except CrankcheckError:
        return None
    return found if np.all(np.isfinite(found)) else None
