"""Channels with two faults at once: what is found where the first of them is put right.

What is put right is what needs no number that is fitted: another unit or sign, or some samples that
stick or jump, which are left out. Another fault is looked for in what is there then.
"""

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np

from models.array import Array, Mask
from models.errors import CrankcheckError
from reports.causes.account import CHOICE, Account
from reports.causes.cause import TIGHT, CauseSize, Excerpt
from reports.causes.hypotheses.filtered import filtered
from reports.causes.hypotheses.late import late
from reports.causes.hypotheses.misnamed import misnamed
from reports.causes.hypotheses.samples import places_text, runs, samples
from reports.causes.hypotheses.straight import straight, turns
from reports.causes.inquiry import Inquiry
from reports.logs.channel import Channel, Reading
from reports.logs.kinds import UNITS

MOST = 4
"""Channels that are looked at twice."""
NEARER = 0.6
"""The part of an error that may be left where another unit or sign is put right."""
LIKE = 3.0
"""Times that readings may then be larger, or smaller, than what is expected."""
FEW, FEWEST = 0.03, 3
"""The part of the readings that may jump, or be in stretches that stick, and how many in any
log."""
FAR = 20.0
"""A reading jumps that is so many times as far from those beside it as four in five are."""


@dataclass(frozen=True)
class First:
    """A fault that is put right: its name, what it costs to believe it, its phrase, what to write
    in the map, the inquiry into its column then, and what else is looked for there."""

    name: str
    cost: float
    phrase: str
    correction: Mapping[str, object]
    inquiry: Inquiry
    others: tuple[Callable[[Inquiry], Iterator[Account | None]], ...]


def two_faults(inquiry: Inquiry) -> Iterator[Account]:
    """The accounts of two faults of each channel that one does not explain well."""
    for column in _unclear(inquiry)[:MOST]:
        for first in (*_read_otherwise(inquiry, column), *_without_samples(inquiry, column)):
            for hypothesis in first.others:
                try:
                    found = [*filter(None, hypothesis(first.inquiry))]
                except (CrankcheckError, ArithmeticError, ValueError, IndexError):
                    continue
                yield from (_both(inquiry, column, first, each) for each in found
                            if _well(first, column, each))  # fmt: skip


def _unclear(inquiry: Inquiry) -> list[str]:
    """The channels that one fault does not explain well, nor one of the log with several others."""
    clear = {
        column
        for account in inquiry.accounts
        for column, rest in account.rests.items()
        if rest <= TIGHT or (account.world is not None and len(account.rests) > 1)
    }
    return [column for column in inquiry.open if column not in clear]


def _well(first: First, column: str, second: Account) -> bool:
    """Whether two faults leave so little that they are no chance."""
    excerpt = first.inquiry.excerpts[column]
    largest = second.lefts[column] * CauseSize.of(excerpt.error).largest
    return second.rests[column] <= TIGHT or largest <= excerpt.limit


def _both(inquiry: Inquiry, column: str, first: First, second: Account) -> Account:
    """The account of both, beside the error that there was."""
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
    """A channel in other units and of the other sign, as far as its readings are of the size that
    they should be then, and nearer."""
    excerpt = inquiry.excerpts[column]
    channel = excerpt.channel
    units = UNITS[channel.kind.dimension]
    for unit, size in units.items():
        for sign in (1, -1):
            gain = sign * units[channel.unit] / size
            if gain == 1.0:
                continue
            fresh = _reread(excerpt, replace(channel, unit=unit, sign=sign * channel.sign), gain)
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


def _reread(excerpt: Excerpt, channel: Channel, gain: float) -> Excerpt:
    """The readings, which are ``gain`` times what they should be, as another channel has them."""
    reading = Reading(channel, excerpt.reading.values / gain, excerpt.reading.instants)
    fresh = replace(excerpt, reading=reading, values=excerpt.values / gain)
    return fresh.in_world(excerpt.expected)


def _likely(excerpt: Excerpt, fresh: Excerpt) -> bool:
    """Whether readings are of the size that is expected, and nearer to it than before; of angles
    whatever whole turns they lost."""
    error = fresh.error
    if fresh.channel.kind.turns:
        error = np.remainder(error + math.pi, math.tau) - math.pi
    expected = CauseSize.of_signal(fresh.expected, fresh.nothing).rms
    ratio = CauseSize.of_signal(fresh.expected + error).rms / expected
    nearer = CauseSize.of(error).rms < NEARER * CauseSize.of(excerpt.error).rms
    small = CauseSize.of(error).rms < NEARER * expected
    return (nearer or small) and 1.0 / LIKE < ratio < LIKE


def _without_samples(inquiry: Inquiry, column: str) -> Iterator[First]:
    """A channel without some samples that stick or jump, where that is what few do."""
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
    """Where readings repeat the one before for as long as they should move by more than their
    limit."""
    where = np.zeros(values.shape, dtype=bool)
    where[1:] = values[1:] == values[:-1]
    expected = values - error
    for first, last in runs(where):
        where[first : last + 1] = abs(expected[last] - expected[first - 1]) > excerpt.limit
    return where


def _jumps(excerpt: Excerpt, error: Array) -> Mask:
    """Where an error is far from those of the samples beside it, by more than its limit."""
    off = np.abs(error[1:-1] - 0.5 * (error[:-2] + error[2:]))
    padded = np.pad(off, 1)
    peak = (off >= padded[:-2]) & (off >= padded[2:])
    where = np.zeros(error.shape, dtype=bool)
    where[1:-1] = peak & (off > FAR * float(np.quantile(off, 0.8)) + excerpt.limit)
    return where
