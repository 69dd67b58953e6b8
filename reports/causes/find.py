"""What explains the errors of a log."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

import numpy as np

from models.errors import CrankcheckError
from reports.causes.account import Account
from reports.causes.cause import Case, Cause
from reports.causes.choice import chosen
from reports.causes.hypotheses import OF_CHANNELS, OF_LOGS, Hypothesis
from reports.causes.inquiry import Inquiry
from reports.causes.words import sentence


@np.errstate(divide="ignore", invalid="ignore", over="ignore")  # rates where there are none
def causes(case: Case) -> tuple[Cause, ...]:
    """What explains the errors of a log that are over their limits, and delays within them.

    A cause leaves at most a tenth of the error of each channel that it is told of, or a third where
    that is within the limit; of several those that leave least for the numbers that they need. What
    nothing explains is in none. Raises CrankcheckError where the scene has no reference.
    """
    inquiry = Inquiry.of(case)
    accounts = _accounts(inquiry, {**OF_CHANNELS, **OF_LOGS})
    told = chosen(accounts, inquiry.open)
    world = next((account.world for account in told if account.world is not None), None)
    if world is None:
        explained = {column for account in told for column in account.columns}
        within = [c for account in accounts for c in account.rests if c not in inquiry.open]
        told += chosen(accounts, [c for c in dict.fromkeys(within) if c not in explained])
    else:
        explained = {column for account in told for column in account.columns}
        left = [column for column in inquiry.open if column not in explained]
        again = inquiry.within(world, left) if left else None
        if again is not None:
            told += chosen(_accounts(again, OF_CHANNELS), again.open)
    return tuple(_cause(inquiry, same) for same in _merged(told))


def _accounts(inquiry: Inquiry, hypotheses: Mapping[str, Hypothesis]) -> tuple[Account, ...]:
    """What each hypothesis says, with its place in the list; each knows what those before said."""
    for order, hypothesis in enumerate(hypotheses.values()):
        told = (replace(account, order=order) for account in _said(hypothesis, inquiry))
        inquiry = replace(inquiry, accounts=(*inquiry.accounts, *told))
    return inquiry.accounts


def _said(hypothesis: Hypothesis, inquiry: Inquiry) -> Iterator[Account]:
    """What a hypothesis says, up to where it leads to no mechanism."""
    try:
        yield from hypothesis(inquiry)
    except CrankcheckError:
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
