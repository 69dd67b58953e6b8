"""What a fitted line says, in words."""

from __future__ import annotations

from reports.output.numbers import count, short
from reports.results.fits.forms import LEVEL
from reports.results.fits.line import LineFit

FAILS = {
    "diverged": "diverges",
    "branch-changed": "changes branch",
    "locked": "locks",
    "crashed": "crashes",
}
NOT_RUN = {"timeout": "timed out at every step", "unsupported": "unsupported"}
VAGUE = 0.15
"""An order that is known no better than this is told with its uncertainty."""


def words(fit: LineFit, unit: str, period_s: float, turn: str = "turn") -> str:
    """The verdict in a few words: 'order 2.0, no floor seen', 'diverges below 90 steps per turn'.

    ``period_s`` is the time of a turn [s], or of what else is called ``turn``.
    """
    if fit.kind == "diverges":
        verb = FAILS.get(fit.failed, "fails")
        if "ok" not in fit.statuses:
            return f"{verb} at every step"
        return f"{verb} at {_per_turn(fit.fails_from_s, period_s, turn)}"
    verdict = _told(fit, unit)
    if not fit.failed:
        return verdict
    below = _per_turn(fit.stable_from_s, period_s, turn)
    return f"{verdict}; {FAILS.get(fit.failed, 'fails')} below {below}"


def _told(fit: LineFit, unit: str) -> str:
    """The verdict on the runs that ended well."""
    if fit.kind == "order":
        return _order(fit)
    if fit.kind == "floor":
        return f"converges to the wrong answer: floor {short(fit.floor)} {unit}"
    if fit.kind == "grows":
        return f"does not shrink: grows to {short(fit.finest_error)} {unit}"
    if fit.kind == "irregular":
        return _irregular(fit, unit)
    if fit.kind == "too few":
        number = len({dt for dt, _ in fit.runs})
        return f"{count(number, 'step')}: too few to tell"
    if fit.kind == "not run":
        return NOT_RUN.get(next(iter(fit.statuses), ""), "not run")
    return "at rounding"


def _order(fit: LineFit) -> str:
    """An order, and that no floor is seen."""
    if fit.order + fit.order_error < LEVEL:
        return f"order {fit.order:.1f}: slower than any integrator, a floor may be near"
    vague = f" +- {fit.order_error:.1f}" if fit.order_error > VAGUE else ""
    return f"order {fit.order:.1f}{vague}, no floor seen"


def _irregular(fit: LineFit, unit: str) -> str:
    """How far an error falls that follows no curve."""
    least, last = min(error for _, error in fit.runs), fit.finest_error
    if least < last:
        return f"irregular: falls to {short(least)} {unit}, then rises to {short(last)}"
    return f"irregular: follows no order, {short(last)} {unit} at the finest step"


def _per_turn(dt_s: float, period_s: float, turn: str) -> str:
    return f"{period_s / dt_s:.4g} steps per {turn}"
