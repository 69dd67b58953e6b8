"""Remedies of a failing cell: another run with the remedies of its engine, and their result."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from reports.judge.cell import Cell, Checked, check, unfinished
from reports.judge.rules import FORCES, PLACES, RATES, TUNABLE, judge
from reports.workers.isolated import Limits, Lost, run_all
from sim.engine import Settings
from sim.engine.settings import profile_of, resolved
from sim.registry import apart, engine
from sim.registry.offers import remedies

HELPS = 3.0
"""Factor by which a remedy reduces the error; less may be chance."""
ENDS = ("ok", "diverged", "locked", "branch-changed")
"""Status of runs that other settings may repair."""


def advised(cell: Cell) -> Checked:
    """Return `judge.cell.check` with remedies."""
    return remedied(check(cell))


def remedied(checked: Checked) -> Checked:
    """Return a checked cell; where profile tuned fails by an error that settings can repair, the
    remedies of its engine are tried at the same step, and the cures give their results."""
    if not _mendable(checked):
        return checked
    cell = checked.cell
    adapter = engine(cell.engine)
    settings = resolved(profile_of(adapter, cell.profile), cell.settings)
    choices = remedies(cell.engine, cell.given, cell.truth.start, settings)
    if not choices:
        return checked
    checked = replace(checked, remedy=_remedy(checked, choices))
    return replace(checked, findings=judge(checked))


def _mendable(checked: Checked) -> bool:
    """True if settings may help: a servo lags by itself; other profiles are to use this one."""
    cell = checked.cell
    return (
        (cell.profile, cell.drive, cell.worlds) == ("tuned", "prescribed", 0)
        and checked.status in ENDS
        and any(finding.rule in (*TUNABLE, *RATES, *FORCES) for finding in checked.failures)
    )


@dataclass(frozen=True)
class _Outcome:
    """Result of a run: the rules that it fails, and its error as a part of the limit (infinite
    where it fails a further rule)."""

    failing: tuple[str, ...]
    share: float


def _remedy(checked: Checked, choices: Sequence[Settings]) -> str:
    """Return the result of the first choice that repairs the cell with `HELPS` times less error, or
    of the best of all; the error is the one with the largest part of its limit."""
    cell, rule = checked.cell, _worst(checked)
    before = _share(checked, rule) if rule else math.inf
    outcomes: dict[str, _Outcome] = {}
    for settings in choices:
        words = " ".join(f"{cell.engine}.{name}={value}" for name, value in settings.items())
        changed = replace(cell, settings={**cell.settings, **settings})
        outcomes[words] = found = _outcome(checked, changed, rule)
        if not found.failing and HELPS * found.share <= before:
            break
    best = min(outcomes, key=lambda words: (bool(outcomes[words].failing), outcomes[words].share))
    left = f"sweep --set {best} leaves {_of_limit(outcomes[best].share, before)}"
    still = ", ".join(outcomes[best].failing)
    if outcomes[best].share < math.inf and HELPS * outcomes[best].share <= before:
        return f"Tried at the same step: {left}" + (f"; still out by {still}." if still else ".")
    none = f"No tried setting lowers the error threefold at the same step: {', '.join(outcomes)}."
    if not still:
        return f"{none} But {left}."
    half = _outcome(checked, replace(cell, dt_s=cell.dt_s / 2, steps=2 * cell.steps), rule)
    if half.share == math.inf:
        return f"{none} Half the step does not help."
    return f"{none} Half the step leaves {_of_limit(half.share, before)}."


def _outcome(checked: Checked, changed: Cell, rule: str) -> _Outcome:
    """Return the result of a changed cell; with finer steps where these failed, or nothing ran."""
    again = check(replace(changed, converge=changed.converge and not rule))
    failing = {finding.rule for finding in again.failures}
    mended = failing <= {finding.rule for finding in checked.failures} if rule else not failing
    return _Outcome(tuple(sorted(failing)), _share(again, rule) if mended else math.inf)


def _worst(checked: Checked) -> str:
    """Return the failing rule with the largest part of its limit; "" where there is none, and for a
    run that did not end well."""
    if checked.status != "ok":
        return ""
    failing = [f.rule for f in checked.failures if f.rule in (*PLACES, *RATES, *FORCES)]
    return max(failing, key=lambda rule: _share(checked, rule), default="")


def _share(checked: Checked, rule: str) -> float:
    """Return the error of a rule as a part of its limit, "" for the largest of all.

    The limits are the same for all settings: they follow from the step and the geometry.
    """
    if checked.status != "ok":
        return math.inf
    parts = [
        finding.taken
        for finding in checked.findings
        if finding.rule in ([rule] if rule else (*PLACES, *RATES, *FORCES))
    ]
    return max((part for part in parts if not math.isnan(part)), default=math.inf)


def _of_limit(after: float, before: float) -> str:
    instead = f" instead of {before:.2g}" if math.isfinite(before) else ""
    return f"{after:.2g} of its limit{instead}"


LIMITS = Limits(3600.0, 16.0)
"""Limits far beyond any sound cell: one that hangs, or fills the memory, is a row all the same.
Longer runs need one job, which has no limits."""


def check_all(
    cells: Sequence[Cell], jobs: int, done: Callable[[Checked], None] = lambda _: None
) -> list[Checked]:
    """Check all cells, in the order of ``cells``; ``done`` gets each as it ends.

    Parameters
    ----------
    jobs : int
        Processes; 0 for one per processor.
    """
    own_process = apart(cell.engine for cell in cells)
    return run_all(advised, cells, jobs, LIMITS, _lost, done, own_process)


def _lost(cell: Cell, lost: Lost) -> Checked:
    return unfinished(cell, lost.status, lost.reason)
