"""The lines of a model, run: as written first, then what may be recommended, to choose of it."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

from models.errors import CrankcheckError
from reports.judge.cell import unfinished
from reports.own_model.account import Account, Line, Proposal, checked_line
from reports.own_model.checked_line import CheckedLine, without_run
from reports.own_model.judged import SAYS, JudgedModel, errors_of, judged_model
from reports.workers.isolated import Isolated, Limits, Lost

Run = Callable[[Line], CheckedLine]


def run_lines(
    account: Account, limits: Limits, done: Callable[[CheckedLine], None] = lambda _: None
) -> JudgedModel:
    """Run all lines of an account, each in a process that is ended when it fails or hangs."""
    child: Isolated[CheckedLine] = Isolated(limits)

    def run(line: Line) -> CheckedLine:
        result = child.call(checked_line, line)
        if not isinstance(result, Lost):
            return result
        if isinstance(result.error, CrankcheckError):
            raise result.error
        return without_run(unfinished(line.cell, result.status, result.reason))

    try:
        return judged_lines(account, run, done)
    finally:
        child.close()


def judged_lines(account: Account, run: Run, done: Callable[[CheckedLine], None]) -> JudgedModel:
    """All lines, as ``run`` does each; what is recommended is chosen once the first is there."""
    lines: list[CheckedLine] = []
    for profile in account.profiles:
        if len(lines) == 1:
            account = chosen(account, lines[0], run)
        lines.append(run(Line(account, profile)))
        done(lines[-1])
    return judged_model(account, lines)


def chosen(account: Account, own: CheckedLine, run: Run) -> Account:
    """The account with the first of its proposals that gains on the model as written; contacts
    are off only where that makes the error `SAYS` times less. Where none gains, it says so."""
    limit = _error(own)
    quick = replace(account, request=replace(account.request, converge=False))

    def error(proposal: Proposal) -> float:
        if not proposal.patch:
            return limit
        return _error(run(Line(replace(quick, recommended=proposal), account.profiles[-1])))

    for integrator in (True, False):
        found = [
            (error(each), each)
            for each in account.proposals
            if each.advised.integrator == integrator
        ]
        kept = next(pair for pair in found if not pair[1].advised.contacts_off)
        least = min(found, key=lambda pair: pair[0])
        best = least if SAYS * least[0] < kept[0] else kept
        if best[0] < limit:
            return replace(account, recommended=best[1])
    there = [each for each in account.proposals if not each.patch]
    if there and math.isfinite(limit):
        return replace(account, recommended=there[0])
    return replace(account, helps=False)


def _error(one: CheckedLine) -> float:
    """The largest error of place, without an end where the run did not end well."""
    error = errors_of(one)[0]
    return math.inf if math.isnan(error) else error
