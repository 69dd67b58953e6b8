"""Search for the causes of the errors of a log."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace

import numpy as np

from models.errors import CrankcheckError
from reports.causes.account import CAUSE, NUMBER, Account, chosen, sentence
from reports.causes.cause import Cause, LogCase
from reports.causes.hypotheses import frames, other_world
from reports.causes.hypotheses.clock import drift, stamps, time_unit
from reports.causes.hypotheses.dimension import dimension
from reports.causes.hypotheses.filtered import filtered, forth_and_back, smoothed
from reports.causes.hypotheses.late import late
from reports.causes.hypotheses.lost_rows import lost_rows
from reports.causes.hypotheses.misnamed import misnamed, swapped
from reports.causes.hypotheses.samples import rounded, samples
from reports.causes.hypotheses.straight import straight, turns
from reports.causes.hypotheses.two_faults import two_faults
from reports.causes.inquiry import Inquiry

Hypothesis = Callable[[Inquiry], Iterator[Account | None]]
Hypotheses = Sequence[Hypothesis]
OF_SAMPLES: Hypotheses = (turns, samples)
"""Faults of some samples, besides any fault of all samples."""
OF_CHANNELS: Hypotheses = (
    straight, swapped, misnamed, *OF_SAMPLES, frames.turned_points, late, filtered,
    forth_and_back, rounded,
)  # fmt: skip
"""Faults of some channels."""
OF_LOGS: Hypotheses = (
    other_world.backwards, other_world.assembly, frames.mirrored, time_unit, stamps, lost_rows,
    frames.moved, frames.turned, frames.sized, other_world.start_angle, dimension,
    drift, smoothed, two_faults,
)  # fmt: skip
"""Faults of the log as a whole, or of the scene; the expensive ones come last, for channels without
a good explanation so far."""

FEWEST_ROWS = 8
MOSTLY = 0.5
"""Part of the wrong channels without a cause, from which on single numbers are doubted."""


@np.errstate(divide="ignore", invalid="ignore", over="ignore")  # rates where there are none
def causes(case: LogCase) -> tuple[Cause, ...]:
    """Return the causes of the errors of a log over their limits, and of delays within them.

    A cause leaves at most a tenth of the error of each of its channels, or a third where the error
    is then within the limit; of several, the ones that leave least for their numbers are chosen.
    Unexplained errors have none. Raises CrankcheckError where the scene has no reference.
    """
    inquiry = Inquiry.of(case)
    if inquiry.rows < FEWEST_ROWS:  # numbers could be found for anything; or it has gaps alone
        return ()
    accounts = _accounts(inquiry, (*OF_CHANNELS, *OF_LOGS))
    told = chosen(accounts, inquiry.open)
    world = next((account for account in told if account.world is not None), None)
    told = _advised(inquiry, accounts, told) if world is None else _beside(inquiry, world, told)
    return tuple(_as_one_cause(inquiry, same) for same in _sure(inquiry, _merged(told)))


def _advised(
    inquiry: Inquiry, accounts: Sequence[Account], told: Sequence[Account]
) -> list[Account]:
    """Return the chosen accounts, and accounts of channels within their limits."""
    explained = _columns_of(told)
    within = [c for account in accounts for c in account.rests if c not in inquiry.open]
    left = [column for column in dict.fromkeys(within) if column not in explained]
    return [*told, *chosen(accounts, left)]


def _beside(inquiry: Inquiry, world: Account, told: Sequence[Account]) -> list[Account]:
    """Return the account of another world, and the accounts of channels still off in it: their
    explanation in that world, else their explanation in the scene as driven."""
    assert world.world is not None
    others = [column for column in inquiry.open if column not in world.columns]
    there = inquiry.within(world.world, inquiry.open)
    if there is None:
        return list(told)
    found = [world, *chosen(_accounts(replace(there, open=tuple(others)), OF_CHANNELS), others)]
    still = tuple(c for c in world.columns if there.excerpts[c].out)
    found += chosen(_accounts(replace(there, open=still), OF_SAMPLES), still)
    explained = _columns_of(found)
    return [*found, *(each for each in told if not explained & set(each.columns))]


def _sure(inquiry: Inquiry, told: Sequence[list[Account]]) -> list[list[Account]]:
    """Return the accounts without fitted numbers of a single channel where most wrong channels have
    no cause and are off by as much: the unknown fault of the others is probably its fault too."""
    explained = _columns_of([account for same in told for account in same])
    taken = {c: inquiry.excerpts[c].worst / inquiry.excerpts[c].limit for c in inquiry.open}
    left = [taken[column] for column in inquiry.open if column not in explained]
    if len(left) < max(2, MOSTLY * len(inquiry.open)):
        return list(told)
    return [
        same
        for same in told
        if sum(len(account.columns) for account in same) > 1
        or same[0].cost < CAUSE + NUMBER
        or taken.get(same[0].columns[0], 0.0) > max(left)
    ]


def _columns_of(told: Sequence[Account]) -> set[str]:
    return {column for account in told for column in account.columns}


def _accounts(inquiry: Inquiry, hypotheses: Hypotheses) -> tuple[Account, ...]:
    """Return the accounts of each hypothesis, with its place; each sees those before it."""
    for order, hypothesis in enumerate(hypotheses):
        told = (replace(account, order=order) for account in _said(hypothesis, inquiry))
        inquiry = replace(inquiry, accounts=(*inquiry.accounts, *told))
    return inquiry.accounts


def _said(hypothesis: Hypothesis, inquiry: Inquiry) -> Iterator[Account]:
    """Yield the accounts of a hypothesis, up to a missing mechanism or an arithmetic failure: a log
    of odd numbers gets its verdict without this hypothesis."""
    try:
        yield from filter(None, hypothesis(inquiry))
    except (CrankcheckError, ArithmeticError, ValueError, IndexError):
        return


def _merged(told: Sequence[Account]) -> list[list[Account]]:
    """Return accounts with the same phrase together; those of the whole log come first."""
    same: dict[tuple[str, str], list[Account]] = {}
    for account in sorted(told, key=lambda each: each.world is None):
        same.setdefault((account.name, account.phrase), []).append(account)
    return list(same.values())


def _as_one_cause(inquiry: Inquiry, same: Sequence[Account]) -> Cause:
    of = {column: account for account in same for column in account.columns}
    columns = tuple(column for column in inquiry.excerpts if column in of)
    every = [excerpt.channel for excerpt in inquiry.excerpts.values()]
    channels = [inquiry.channel(column) for column in columns]
    corrections = {c: dict(of[c].corrections.get(c, {})) for c in columns}
    first = corrections[columns[0]]
    alike = all(each == first for each in corrections.values())
    return Cause(
        name=same[0].name,
        columns=columns,
        text=sentence(same[0].phrase, channels, every),
        correction=first if alike else {},
        left=max(of[column].lefts[column] for column in columns),
        of_column={} if alike else corrections,
    )
