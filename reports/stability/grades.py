"""The rules that grade a hard run: the first one that applies gives the grade."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from models.array import Array
from reports.compare.branch import CLOSED
from reports.stability.error_series import ErrorSeries
from reports.stability.matrix import Outcome

LEAST_TURNS = 4
"""Least number of whole turns that distinguishes a growing error from a swinging one."""
GROWN = 2.0
"""Least ratio of a growing error in the last turn to the one in the first."""
STANDS = 0.02
"""Share of its command below which the speed of a crank, at the end, counts as standing."""
STEADY: tuple[Outcome, ...] = ("ok", "degraded", "silently-open")
LAST = 10
"""Divisor of a run that gives its end: one part of so many."""


@dataclass(frozen=True)
class Grade:
    """An outcome, why, and where: sample of the run, None where it has no place."""

    outcome: Outcome
    reason: str
    sample: int | None = None


Reason = tuple[str, int | None]
"""Reason for which a rule applies to a run, and sample."""


@dataclass(frozen=True)
class GradeRule:
    """One way to end: its name, its meaning, and its test.

    ``tell`` gives the reason for a run and its class, or None where the rule does not apply.
    """

    outcome: Outcome
    meaning: str
    tell: Callable[[ErrorSeries, float], Reason | None]


def outcome(errors: ErrorSeries, within: float) -> Grade:
    """Return the grade of a run by the first rule that applies; for bounded errors with their
    growth in a turn.

    Parameters
    ----------
    within : float
        The class: the largest pure error that counts as held.
    """
    grade = next(
        Grade(rule.outcome, *reason)
        for rule in RULES
        if (reason := rule.tell(errors, within)) is not None
    )
    slope, doubt = drift(errors)
    if grade.outcome not in STEADY or math.isnan(slope):
        return grade
    growth = f"drift {slope:.1e} +- {doubt:.0e} {errors.per_turn}"
    return replace(grade, reason=f"{grade.reason}; {growth}" if grade.reason else growth)


def drift(errors: ErrorSeries) -> tuple[float, float]:
    """Return the growth of the worst error of place per turn, by a straight line through the turns'
    maxima, and its standard error; NaN where there are under four turns."""
    peaks = _peaks(errors)
    if len(peaks) < LEAST_TURNS or not np.isfinite(peaks).all():
        return math.nan, math.nan
    turns = np.arange(len(peaks), dtype=np.float64)
    away = turns - turns.mean()
    slope = float(away @ peaks / (away @ away))
    left = peaks - peaks.mean() - slope * away
    return slope, math.sqrt(float(left @ left) / (len(peaks) - 2) / float(away @ away))


def _peaks(errors: ErrorSeries) -> Array:
    """Return the worst error of place of each whole turn that counts."""
    turn = np.floor(errors.turn + 1e-9).astype(np.intp)
    whole = (np.arange(len(turn)) >= errors.settled) & (turn < int(errors.turn[-1] + 1e-9))
    if not whole.any():
        return np.zeros(0)
    first = turn[whole][0]
    peaks = np.zeros(turn[whole][-1] - first + 1)
    np.maximum.at(peaks, turn[whole] - first, errors.place[whole])
    return peaks


def _diverged(errors: ErrorSeries, _: float) -> Reason | None:
    if errors.status == "diverged":
        return errors.reason, len(errors.time_s) - 1
    broken = np.flatnonzero(~np.isfinite(errors.place + errors.gap))
    if broken.size:
        return "numbers that are not finite", int(broken[0])
    return None


def _crashed(errors: ErrorSeries, _: float) -> Reason | None:
    fault = errors.incomplete if errors.status == "ok" else errors.reason or errors.status
    return (fault, len(errors.time_s) - 1) if fault else None


def _branch_changed(errors: ErrorSeries, _: float) -> Reason | None:
    if errors.departure is None or errors.worst(errors.gap)[0] > CLOSED:
        return None
    at = int(np.searchsorted(errors.time_s, errors.departure.time_s))
    reason = f"{errors.departure.link} moved to the other assembly"
    return reason, min(at, len(errors.time_s) - 1)


def _locked(errors: ErrorSeries, within: float) -> Reason | None:
    end = max(len(errors.time_s) // LAST, 1)
    turned = float(np.ptp(errors.crank[-end:]))
    commanded = float(np.ptp(errors.driver_rad[-end:]))
    if (
        turned > STANDS * commanded
        or not errors.drive[-1] > within  # nothing is commanded where it is NaN
        or errors.worst(errors.gap)[0] > within
    ):
        return None
    if errors.limited and errors.worst(errors.place)[0] > within:
        return None  # it stands, and somewhere else than at its limit
    behind = float(errors.drive[-1])
    far = (
        f"{behind:.2g} of the longest link" if errors.slides else f"{math.degrees(behind):.3g} deg"
    )
    return f"{errors.driver} stands, {far} behind", errors.first(errors.drive, within)


def _silently_open(errors: ErrorSeries, within: float) -> Reason | None:
    gap, _ = errors.worst(errors.gap)
    if gap <= within or errors.worst(errors.drive)[0] > within:
        return None
    unshown = f", and {errors.driver} does not show it" if errors.driven else ""
    reason = f"a joint is open by {gap:.2g} of the longest link{unshown}"
    return reason, errors.first(errors.gap, within)


def _drifts(errors: ErrorSeries, within: float) -> Reason | None:
    peaks = _peaks(errors)
    slope, doubt = drift(errors)
    if errors.worst(errors.place)[0] <= within or not slope > 2.0 * doubt:
        return None
    if peaks[-1] < GROWN * peaks[0]:
        return None
    return f"grows by {slope:.2g} {errors.per_turn}", errors.first(errors.place, within)


def _degraded(errors: ErrorSeries, within: float) -> Reason | None:
    for what, series in (
        (errors.worst_of_place, errors.place),
        (errors.driver, errors.drive),
        ("a joint", errors.gap),
    ):
        worst, at = errors.worst(series)
        if worst > within:
            return f"{what} is off by {worst:.2g}", at
    return None


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
    GradeRule("silently-open", "a joint has come apart; driven links look fine", _silently_open),
    GradeRule("drifts", "the error is over the class and grows with the turns", _drifts),
    GradeRule("degraded", "the error is over the class, and does not blow up", _degraded),
    GradeRule("ok", "within the class throughout", lambda *_: ("", None)),
)
MEANINGS: dict[Outcome, str] = {rule.outcome: rule.meaning for rule in RULES} | {
    "unsupported": "the engine cannot hold the scene"
}
"""Meaning of each outcome."""
