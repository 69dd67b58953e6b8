"""Channels with two faults at once: the second is sought with the first put right.

The first fault needs no fitted number: another unit or sign, or some samples that stick or jump,
which are left out. The second is sought in the corrected readings.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np

from models.array import Array, Mask
from models.errors import CrankcheckError
from reports.causes.account import CHOICE, Account
from reports.causes.cause import TIGHT, CauseSize, Excerpt, within_half_a_turn
from reports.causes.hypotheses.filtered import filtered
from reports.causes.hypotheses.late import late
from reports.causes.hypotheses.misnamed import misnamed
from reports.causes.hypotheses.samples import places_text, runs, samples
from reports.causes.hypotheses.straight import straight, turns
from reports.causes.inquiry import Inquiry
from reports.logs.channel import Reading
from reports.logs.kinds import TYPICAL, UNITS

MOST = 4
"""Channels that are examined twice."""
NEARER = 0.6
"""Part of an error that may be left with another unit or sign put right."""
LIKE = 3.0
"""Largest ratio of the corrected readings to the reference, or of the reference to them."""
FEW, FEWEST = 0.03, 3
"""Part of the readings that may jump, or be in stuck stretches, and their number in any log."""
FAR = 20.0
"""A reading jumps if it is so many times as far from its neighbours as four in five are."""


@dataclass(frozen=True)
class First:
    """Fault that is put right: its name, cost, phrase, map entries, the inquiry into its column
    after that, and the further hypotheses for it."""

    name: str
    cost: float
    phrase: str
    correction: Mapping[str, object]
    inquiry: Inquiry
    others: tuple[Callable[[Inquiry], Iterator[Account | None]], ...]


def two_faults(inquiry: Inquiry) -> Iterator[Account]:
    """Yield the accounts of two faults of each channel that one does not explain well."""
    for column in _unclear(inquiry)[:MOST]:
        for first in (*_read_otherwise(inquiry, column), *_without_samples(inquiry, column)):
            for hypothesis in first.others:
                try:
                    found = [*filter(None, hypothesis(first.inquiry))]
                except (CrankcheckError, ArithmeticError, ValueError, IndexError):
                    continue
                yield from (_both(inquiry, column, first, each) for each in found
                            if _is_no_chance(first, column, each))  # fmt: skip


def _unclear(inquiry: Inquiry) -> list[str]:
    """Return the channels that neither one fault nor one of several channels explains well."""
    clear = {
        column
        for account in inquiry.accounts
        for column, rest in account.rests.items()
        if rest <= TIGHT or (account.world is not None and len(account.rests) > 1)
    }
    return [column for column in inquiry.open if column not in clear]


def _is_no_chance(first: First, column: str, second: Account) -> bool:
    excerpt = first.inquiry.excerpts[column]
    largest = second.lefts[column] * CauseSize.of(excerpt.error).largest
    return second.rests[column] <= TIGHT or largest <= excerpt.limit


def _both(inquiry: Inquiry, column: str, first: First, second: Account) -> Account:
    """Return the account of both, against the original error."""
    before, after = inquiry.excerpts[column], first.inquiry.excerpts[column]
    share = after.size.largest / before.size.largest
    left = CauseSize.of(after.error).largest / CauseSize.of(before.error).largest
    phrase = f"{first.phrase}, and beside that {second.phrase.removeprefix('{who} ')}"
    return replace(
        second,
        name=f"{first.name} and {second.name}",
        cost=first.cost + second.cost + CHOICE,
        rests={column: second.rests[column] * share},
        lefts={column: second.lefts[column] * left},
        phrase=phrase,
        corrections={column: {**first.correction, **second.corrections.get(column, {})}},
        world=None,
    )


def _read_otherwise(inquiry: Inquiry, column: str) -> Iterator[First]:
    """Yield a channel in another unit or sign, if it then has the right size and is nearer."""
    excerpt = inquiry.excerpts[column]
    channel = excerpt.channel
    units = UNITS[channel.kind.dimension]
    for unit, size in TYPICAL[channel.kind.dimension].items():
        for sign in (1, -1):
            gain = sign * units[channel.unit] / size
            if gain == 1.0:
                continue
            instead = replace(channel, unit=unit, sign=sign * channel.sign)
            reading = Reading(instead, excerpt.reading.values / gain, excerpt.reading.instants)
            fresh = replace(excerpt, reading=reading, values=excerpt.values / gain)
            fresh = fresh.in_world(excerpt.expected)
            if not _likely(excerpt, fresh):
                continue
            told = {"unit": unit} if unit != channel.unit else {}
            turned = {"sign": fresh.channel.sign} if sign < 0 else {}
            words = [f"{{is}} in {unit}, not in {channel.unit}"] if told else []
            words += ["{has} the wrong sign"] if turned else []
            yield First(
                " and ".join([*told, *turned]),
                CHOICE * len(words),
                "{who} " + " and ".join(words),
                {**told, **turned},
                replace(inquiry, excerpts={column: fresh}, open=(column,), accounts=()),
                (turns, samples, late, filtered, misnamed),
            )


def _likely(excerpt: Excerpt, fresh: Excerpt) -> bool:
    """True if readings are of the size of the reference, and nearer to it than before; angles may
    have lost any whole turns."""
    error = fresh.error
    if fresh.channel.kind.turns:
        error = within_half_a_turn(error)
    expected = CauseSize.of_signal(fresh.expected, fresh.nothing).rms
    ratio = CauseSize.of_signal(fresh.expected + error).rms / expected
    nearer = CauseSize.of(error).rms < NEARER * CauseSize.of(excerpt.error).rms
    small = CauseSize.of(error).rms < NEARER * expected
    return (nearer or small) and 1.0 / LIKE < ratio < LIKE


def _without_samples(inquiry: Inquiry, column: str) -> Iterator[First]:
    """Yield a channel without some samples that stick or jump, if these are few."""
    excerpt = inquiry.excerpts[column]
    values, error = inquiry.whole(column)
    for name, where in (("stuck", _stuck(excerpt, values, error)),
                        ("spike", _jumps(excerpt, error))):  # fmt: skip
        count = int(np.sum(where))
        kept = np.flatnonzero(~where[excerpt.rows])
        if not 0 < count <= max(FEWEST, FEW * where.size) or kept.size < excerpt.rows.size / 2:
            continue
        part = excerpt.part(kept).in_world(excerpt.expected[kept])
        stretches = runs(where)
        verb = "repeat" if name == "stuck" else ""
        places = places_text(inquiry, stretches, verb)
        stuck = f"{{who}} stick{{s}}: {places} the one before"
        yield First(
            name,
            CHOICE * min(len(stretches), 4),
            stuck if verb else f"{{who}} {{is}} off at single samples: {places}",
            {},
            replace(inquiry, excerpts={column: part}, open=(column,), accounts=()),
            (straight, late, misnamed),
        )


def _stuck(excerpt: Excerpt, values: Array, error: Array) -> Mask:
    """Return a mask of readings that repeat the one before, but should move by over their limit."""
    where = np.zeros(values.shape, dtype=bool)
    where[1:] = values[1:] == values[:-1]
    expected = values - error
    for first, last in runs(where):
        where[first : last + 1] = abs(expected[last] - expected[first - 1]) > excerpt.limit
    return where


def _jumps(excerpt: Excerpt, error: Array) -> Mask:
    """Return a mask of errors that are far from their neighbours', by more than the limit."""
    off = np.abs(error[1:-1] - 0.5 * (error[:-2] + error[2:]))
    padded = np.pad(off, 1)
    peak = (off >= padded[:-2]) & (off >= padded[2:])
    where = np.zeros(error.shape, dtype=bool)
    where[1:-1] = peak & (off > FAR * float(np.quantile(off, 0.8)) + excerpt.limit)
    return where
