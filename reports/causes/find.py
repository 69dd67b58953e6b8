"""What explains the errors of a log."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

import numpy as np

from models.errors import CrankcheckError
from reports.causes.account import CAUSE, NUMBER, Account, chosen, sentence
from reports.causes.cause import Cause, LogCase
from reports.causes.hypotheses import OF_CHANNELS, OF_LOGS, OF_SAMPLES, Hypothesis
from reports.causes.inquiry import Inquiry

FEWEST_ROWS = 8
MOSTLY = 0.5
"""The part of what is off that has no cause, from which on single numbers are doubted."""


@np.errstate(divide="ignore", invalid="ignore", over="ignore")  # rates where there are none
def causes(case: LogCase) -> tuple[Cause, ...]:
    """What explains the errors of a log that are over their limits, and delays within them.

    A cause leaves at most a tenth of the error of each channel that it is told of, or a third where
    that is within the limit; of several those that leave least for the numbers that they need. What
    nothing explains is in none. Raises CrankcheckError where the scene has no reference.
    """
    inquiry = Inquiry.of(case)
    if inquiry.rows < FEWEST_ROWS:  # numbers could be found for anything; or it has gaps alone
        return ()
    accounts = _accounts(inquiry, {**OF_CHANNELS, **OF_LOGS})
    told = chosen(accounts, inquiry.open)
    world = next((account for account in told if account.world is not None), None)
    told = _advised(inquiry, accounts, told) if world is None else _beside(inquiry, world, told)
    return tuple(_cause(inquiry, same) for same in _sure(inquiry, _merged(told)))


def _advised(
    inquiry: Inquiry, accounts: Sequence[Account], told: Sequence[Account]
) -> list[Account]:
    """What is told, and what explains channels that are within their limits."""
    explained = _columns(told)
    within = [c for account in accounts for c in account.rests if c not in inquiry.open]
    left = [column for column in dict.fromkeys(within) if column not in explained]
    return [*told, *chosen(accounts, left)]


def _beside(inquiry: Inquiry, world: Account, told: Sequence[Account]) -> list[Account]:
    """The account of another world, and what is told of channels that are off in it as well: what
    explains them there, else what explains them in the scene as it is driven."""
    assert world.world is not None
    others = [column for column in inquiry.open if column not in world.columns]
    there = inquiry.within(world.world, inquiry.open)
    if there is None:
        return list(told)
    found = [world, *chosen(_accounts(replace(there, open=tuple(others)), OF_CHANNELS), others)]
    still = tuple(c for c in world.columns if there.excerpts[c].out)
    found += chosen(_accounts(replace(there, open=still), OF_SAMPLES), still)
    explained = _columns(found)
    return [*found, *(each for each in told if not explained & set(each.columns))]


def _sure(inquiry: Inquiry, told: Sequence[list[Account]]) -> list[list[Account]]:
    """What is told, without numbers of a single channel where most of what is off has no cause and
    is off by as much: what is wrong with the others is likely to be wrong with that one too."""
    explained = _columns([account for same in told for account in same])
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


def _columns(told: Sequence[Account]) -> set[str]:
    """The columns that are told of."""
    return {column for account in told for column in account.columns}


def _accounts(inquiry: Inquiry, hypotheses: Mapping[str, Hypothesis]) -> tuple[Account, ...]:
    """What each hypothesis says, with its place in the list; each knows what those before said."""
    for order, hypothesis in enumerate(hypotheses.values()):
        told = (replace(account, order=order) for account in _said(hypothesis, inquiry))
        inquiry = replace(inquiry, accounts=(*inquiry.accounts, *told))
    return inquiry.accounts


def _said(hypothesis: Hypothesis, inquiry: Inquiry) -> Iterator[Account]:
    """What a hypothesis says, up to where it leads to no mechanism, or to nothing that can be
    reckoned with: a log of odd numbers has its verdict without it."""
    try:
        yield from filter(None, hypothesis(inquiry))
    except (CrankcheckError, ArithmeticError, ValueError, IndexError):
        return


def _merged(told: Sequence[Account]) -> list[list[Account]]:
    """Accounts that say the same of different channels, together; those of all the log first."""
    same: dict[tuple[str, str], list[Account]] = {}
    for account in sorted(told, key=lambda each: each.world is None):
        same.setdefault((account.name, account.phrase), []).append(account)
    return list(same.values())


def _cause(inquiry: Inquiry, same: Sequence[Account]) -> Cause:
    """Accounts that say the same as one cause."""
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
