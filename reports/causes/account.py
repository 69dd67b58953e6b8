"""Accounts of errors by hypotheses: their cost, the best choice among them, and their words."""

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
"""Cost of a cause at all, of a choice among several causes, and of one fitted number, in powers of
ten of the remaining error: a cause with one more number has to leave ten times less."""

BOUNDED = 0.05
"""Part of an error that counts as left where the error has the size and shape that a fault may give
it, but not each number follows."""


@dataclass(frozen=True)
class Account:
    """Explanation of errors by one hypothesis.

    ``rests`` is the remaining part of each explained error, by column, and ``lefts`` the largest
    remaining error over the original one. ``phrase`` has ``{who}`` for the channels, and verbs as
    ``{is}``, ``{has}``, ``{belongs}`` or ``{s}``; without them it is about the log as a whole, and
    accounts with the same phrase are merged. ``corrections`` are the entries for the map, by
    column. A ``world`` holds for the whole log if the account is true. ``order`` is the place of
    the hypothesis in its list.
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
"""A smaller remaining part of an error counts as nothing."""
UNTOLD = 2.0
"""Cost of a channel without explanation, in powers of ten of its remaining error."""
ORDER = 0.01
"""Cost of one place farther down the list of hypotheses: many accounts leave the same."""

EQUAL = 0.3
"""Remaining errors that differ by no more, in powers of ten, count as equal."""


def chosen(accounts: Sequence[Account], columns: Sequence[str]) -> list[Account]:
    """Return the accounts that leave least of ``columns`` for their cost, each with the columns
    that it explains best. At most one account is of another world, as a log has one."""
    if not accounts or not columns:
        return []
    table = _AccountTable(accounts, columns)
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
    """Remaining error of each account (a,) in each column (c,), in powers of ten, and its cost."""

    def __init__(self, accounts: Sequence[Account], columns: Sequence[str]) -> None:
        self.cost = np.array([account.cost for account in accounts])
        self.left = np.full((len(accounts), len(columns)), UNTOLD)
        for number, account in enumerate(accounts):
            for place, column in enumerate(columns):
                if column in account.rests:
                    rest = max(account.rests[column], LEAST_REST)
                    self.left[number, place] = np.log10(rest) + ORDER * account.order

    def total(self, some: Sequence[int]) -> float:
        """Return the remaining error and the cost of some accounts together."""
        return float(self._least_left(some).sum() + self.cost[list(some)].sum())

    def _least_left(self, some: Sequence[int]) -> Array:
        return np.asarray(self.left[list(some)].min(axis=0, initial=UNTOLD))

    def owner(self, some: Sequence[int], worlds: Sequence[int], place: int) -> int | None:
        """Return the account that leaves least of a column, preferably an account of a world if it
        leaves about as little; None where none explains the column."""

        def left(number: int) -> float:
            return float(self.left[number, place]) - (EQUAL if number in worlds else 0.0)

        best = min(some, key=left, default=None)
        return None if best is None or self.left[best, place] >= UNTOLD else best

    def descended(self, start: Sequence[int], plain: Sequence[int]) -> list[int]:
        """Return accounts whose total no addition, removal or exchange of one lowers."""
        some, total = list(start), self.total(start)
        while True:
            kept = [some, *([n for n in some if n != out] for out in some if out not in start)]
            tried = [*kept[1:], *(each for base in kept for each in self._with_best(base, plain))]
            best = min(tried, key=self.total, default=some)
            if self.total(best) >= total - 1e-9:
                return some
            some, total = best, self.total(best)

    def _with_best(self, base: Sequence[int], plain: Sequence[int]) -> list[list[int]]:
        """Return the accounts with the further account that lowers their total most."""
        if not plain:
            return []
        gained = np.minimum(self.left[list(plain)], self._least_left(base)).sum(axis=1)
        best = int(np.argmin(gained + self.cost[list(plain)]))
        return [[*base, plain[best]]] if plain[best] not in base else []


NAMED = 3
"""Channels that are named one by one; longer lists show columns only."""
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
"""Classes of channels, by their common name."""


def who(channels: Sequence[Channel], every: Sequence[Channel]) -> str:
    """Return channels as words; a class of ``every`` channel of the log by its name."""
    columns = f"(columns {few([channel.column for channel in channels], SHOWN)})"
    chosen = {channel.column for channel in channels}
    for name, belongs in CLASSES.items():
        if len(chosen) > 1 and chosen == {c.column for c in every if belongs(c)}:
            return f"all {name} {columns}"
    if len(channels) > NAMED:
        return f"{len(channels)} channels {columns}"
    return listed([f"{channel.name} (column {channel.column})" for channel in channels])


def sentence(phrase: str, channels: Sequence[Channel], every: Sequence[Channel]) -> str:
    """Return a phrase with its channels and the matching forms of its verbs."""
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
    """Return a delay in samples and seconds: 0.50 samples (0.69 ms) later."""
    samples = abs(by_s) / step_s
    digits = 2 if samples < 100 else 0
    direction = "later" if by_s > 0.0 else "earlier"
    return f"{samples:.{digits}f} samples ({duration(abs(by_s))}) {direction}"


def number(value: float, digits: int = 4) -> str:
    """Return a number with few digits, and 0 for rounding."""
    return f"{round(value, 12) + 0.0:.{digits}g}"


def change(now: float, before: float) -> str:
    """Return the excess of a number over another that is not 0: +1 %, -120 ppm."""
    share = now / before - 1.0
    if abs(share) < 0.9995e-3:
        return f"{1e6 * share:+.3g} ppm"
    return f"{100.0 * share:+.3g} %"


ROUNDS = 30
HALVINGS = 5
SETTLED = 1e-4
"""The last round is the one that reduces the residual by less than this part."""

Residual = Callable[[Array], Array]
"""Function from parameters (p,) to residuals (n,); raises CrankcheckError where there are none."""


def fitted(
    residual: Residual, start: Sequence[float], delta: Sequence[float], rounds: int = ROUNDS
) -> Array | None:
    """Return the parameters (p,) near ``start`` with the least residual, by differences of
    ``delta``, after at most ``rounds`` rounds. A step that increases the residual is halved. None
    where there are no residuals at the start."""
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
    """Return the change of the residuals (n, p) with each parameter."""
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
    """Return the residuals; None where there are none, or some are not finite."""
    try:
        found = residual(parameters)
    except CrankcheckError:
        return None
    return found if np.all(np.isfinite(found)) else None
