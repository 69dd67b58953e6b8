"""The rules that decide how a hard run is graded: the first that has something to say says it."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from models.array import Array
from reports.compare.branch import CLOSED
from reports.stability.error_series import Seen
from reports.stability.matrix import Outcome

LEAST_TURNS = 4
"""Fewer whole turns do not tell a growing error from one that swings."""
GROWN = 2.0
"""An error that grows is that much larger in the last turn than in the first, at least."""
STANDS = 0.02
"""A crank that is slower than this share of its command, at the end, stands."""
STEADY: tuple[Outcome, ...] = ("ok", "degraded", "silently-open")
LAST = 10
"""The part of a run that is its end: one of so many."""


@dataclass(frozen=True)
class Ending:
    """An outcome, why, and where: sample of the run, None where it has no place."""

    outcome: Outcome
    reason: str
    sample: int | None = None


@dataclass(frozen=True)
class GradeRule:
    """One way to end: what it is called, what is meant, and how it is told.

    ``tell`` gives an ending for a run and its class, or None where the rule does not apply.
    """

    outcome: Outcome
    meaning: str
    tell: Callable[[Seen, float], Ending | None]


def outcome(seen: Seen, within: float) -> Ending:
    """The grade of a run by the first rule that applies; where errors keep to bounds, with what
    they grow by in a turn.

    Parameters
    ----------
    within : float
        The class: the largest pure error that counts as held.
    """
    found = next(ending for rule in RULES if (ending := rule.tell(seen, within)) is not None)
    slope, doubt = drift(seen)
    if found.outcome not in STEADY or math.isnan(slope):
        return found
    growth = f"drift {slope:.1e} +- {doubt:.0e} a turn"
    return replace(found, reason=f"{found.reason}; {growth}" if found.reason else growth)


def drift(seen: Seen) -> tuple[float, float]:
    """Growth of the worst error of place per turn, by a straight line through the turns' maxima,
    and its standard error; NaN where there are under four turns."""
    peaks = _peaks(seen)
    if len(peaks) < LEAST_TURNS or not np.isfinite(peaks).all():
        return math.nan, math.nan
    turns = np.arange(len(peaks), dtype=np.float64)
    away = turns - turns.mean()
    slope = float(away @ peaks / (away @ away))
    left = peaks - peaks.mean() - slope * away
    return slope, math.sqrt(float(left @ left) / (len(peaks) - 2) / float(away @ away))


def _peaks(seen: Seen) -> Array:
    """The worst error of place of each whole turn that counts."""
    turn = np.floor(seen.turn + 1e-9).astype(np.intp)
    whole = (np.arange(len(turn)) >= seen.settled) & (turn < int(seen.turn[-1] + 1e-9))
    if not whole.any():
        return np.zeros(0)
    first = turn[whole][0]
    peaks = np.zeros(turn[whole][-1] - first + 1)
    np.maximum.at(peaks, turn[whole] - first, seen.place[whole])
    return peaks


def _diverged(seen: Seen, _: float) -> Ending | None:
    if seen.status == "diverged":
        return Ending("diverged", seen.reason, len(seen.time_s) - 1)
    broken = np.flatnonzero(~np.isfinite(seen.place + seen.gap))
    if broken.size:
        return Ending("diverged", "numbers that are not finite", int(broken[0]))
    return None


def _crashed(seen: Seen, _: float) -> Ending | None:
    fault = seen.incomplete if seen.status == "ok" else seen.reason or seen.status
    return Ending("crashed", fault, len(seen.time_s) - 1) if fault else None


def _branch_changed(seen: Seen, _: float) -> Ending | None:
    if seen.departure is None or seen.worst(seen.gap)[0] > CLOSED:
        return None
    at = int(np.searchsorted(seen.time_s, seen.departure.time_s))
    reason = f"{seen.departure.link} went over to the other assembly"
    return Ending("branch-changed", reason, min(at, len(seen.time_s) - 1))


def _locked(seen: Seen, within: float) -> Ending | None:
    end = max(len(seen.time_s) // LAST, 1)
    turned = float(np.ptp(seen.crank[-end:]))
    told = float(np.ptp(seen.driver_rad[-end:]))
    if turned > STANDS * told or seen.drive[-1] <= within or seen.worst(seen.gap)[0] > within:
        return None
    if seen.limited and seen.worst(seen.place)[0] > within:
        return None  # it stands, and somewhere else than at its limit
    behind = math.degrees(float(seen.drive[-1]))
    return Ending(
        "locked", f"the crank stands, {behind:.3g} deg behind", seen.first(seen.drive, within)
    )


def _silently_open(seen: Seen, within: float) -> Ending | None:
    gap, _ = seen.worst(seen.gap)
    if gap <= within or seen.worst(seen.drive)[0] > within:
        return None
    reason = f"a joint is open by {gap:.2g} of the longest link, and the crank does not show it"
    return Ending("silently-open", reason, seen.first(seen.gap, within))


def _drifts(seen: Seen, within: float) -> Ending | None:
    peaks = _peaks(seen)
    slope, doubt = drift(seen)
    if seen.worst(seen.place)[0] <= within or not slope > 2.0 * doubt:
        return None
    if peaks[-1] < GROWN * peaks[0]:
        return None
    return Ending("drifts", f"grows by {slope:.2g} a turn", seen.first(seen.place, within))


def _degraded(seen: Seen, within: float) -> Ending | None:
    for what, series in (("a place", seen.place), ("the crank", seen.drive), ("a joint", seen.gap)):
        worst, at = seen.worst(series)
        if worst > within:
            return Ending("degraded", f"{what} is off by {worst:.2g}", at)
    return None


def _ok(seen: Seen, _: float) -> Ending:
    return Ending("ok", "")


RULES: tuple[GradeRule, ...] = (
    GradeRule(
        "diverged",
        "numbers blow up, a link turns wildly, or a joint is open by a whole link",
        _diverged,
    ),
    GradeRule(
        "crashed", "the engine failed, did not end in time, or left a log with holes", _crashed
    ),
    GradeRule("branch-changed", "the loops are closed, in the other assembly", _branch_changed),
    GradeRule("locked", "the loops are closed, and the crank stands short of its command", _locked),
    GradeRule(
        "silently-open", "the driven joint looks fine, and another has come apart", _silently_open
    ),
    GradeRule("drifts", "the error is over the class and grows with the turns", _drifts),
    GradeRule("degraded", "the error is over the class, and does not blow up", _degraded),
    GradeRule("ok", "within the class throughout", _ok),
)
MEANINGS: dict[Outcome, str] = {rule.outcome: rule.meaning for rule in RULES} | {
    "unsupported": "the engine cannot hold the scene",
}
"""What each outcome means, for people."""
