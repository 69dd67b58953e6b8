"""A failing cell is run again with what its engine has against that, and says what came of it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

from models.scene import Same
from reports.compare.beside import truth_of
from reports.judge.cell import Cell, Checked, check
from reports.judge.rules import PLACES, RATES, TUNABLE, judge
from sim.engine import Settings
from sim.remedies import remedies

HELPS = 3.0
"""How many times less error makes a remedy; less than that may be chance."""
ENDS = ("ok", "diverged", "locked", "branch-changed")
"""How runs end that other settings may mend."""


def advised(cell: Cell) -> Checked:
    """As `judge.cell.check`; where profile tuned fails by what settings can mend, the remedies of
    its engine are tried at the same step, and the cures say what came of it."""
    checked = check(cell)
    if not _mendable(checked):
        return checked
    choices = remedies(cell.engine, cell.scene, truth_of(Same(cell.scene)).start)
    if not choices:
        return checked
    checked = replace(checked, remedy=_remedy(checked, choices))
    return replace(checked, findings=judge(checked))


def _mendable(checked: Checked) -> bool:
    """A servo lags by itself; other profiles are told to use this one."""
    cell = checked.cell
    return (
        (cell.profile, cell.drive) == ("tuned", "prescribed")
        and checked.status in ENDS
        and any(finding.rule in (*TUNABLE, *RATES) for finding in checked.failures)
    )


def _remedy(checked: Checked, choices: Sequence[Settings]) -> str:
    """What came of the first choice that leaves the cell within its limits with `HELPS` times less
    error, or of the best of all."""
    cell = checked.cell
    before, finer = _share(checked), False
    if before <= 1.0:  # only finer steps fail: those are to be seen, then
        before, finer = math.inf, True
    best, least, tried = "", math.inf, []
    for settings in choices:
        tried.append(" ".join(f"{cell.engine}.{name}={value}" for name, value in settings.items()))
        share = _tried(replace(cell, settings={**cell.settings, **settings}), finer)
        if share < least:
            best, least = tried[-1], share
        if least <= min(1.0, before / HELPS):
            break
    instead = f" instead of {before:.2g}" if math.isfinite(before) else ""
    left = f"sweep --set {best} leaves {least:.2g} of the limit{instead}"
    if least < math.inf and HELPS * least <= before:
        return f"Tried at the same step: {left}."
    none = f"Nothing tried at the same step lowers the error threefold: {', '.join(tried)}."
    if least <= 1.0:
        return f"{none} But {left}."
    half = _tried(replace(cell, dt_s=cell.dt_s / 2, steps=2 * cell.steps), finer)
    return f"{none} Half the step leaves {half:.2g} of its own limit{instead}."


def _tried(cell: Cell, finer: bool) -> float:
    """What is left of the error; infinite where a finer step fails, if those are asked for."""
    again = check(replace(cell, converge=finer))
    fails = finer and any(finding.rule == "CC110" for finding in again.failures)
    return math.inf if fails else _share(again)


def _share(checked: Checked) -> float:
    """The largest share of a limit that an error takes; infinite for a run that did not end well.

    The limits are the same for all settings: they follow from the step and the geometry.
    """
    if checked.status != "ok":
        return math.inf
    shares = [
        finding.number / finding.limit
        for finding in checked.findings
        if finding.rule in (*PLACES, *RATES) and finding.number is not None and finding.limit
    ]
    return max((math.inf if math.isnan(share) else share for share in shares), default=math.inf)
