"""Fit error = floor + C dt^p to a line of cells that differ only in their step.

A fit uses points that ended well, at their own and at every finer step, and are above rounding;
from the finest on, it uses as many coarser ones as one curve goes through. A floor counts as seen
only where it is most of the finest error, the error hardly falls any more, and no power of dt
alone goes through the same points. Five points can show parts that work against each other
(`reports.results.floor_fit`).
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Literal

import numpy as np

from models.array import Array
from reports.output.numbers import count, floor_words, short
from reports.results import fit_forms
from reports.results.floor_fit import ALIGNMENTS, ORDERS, ErrorCurve, reach, straight, within
from sim.engine import AT_ROUNDING

FitKind = Literal[
    "order", "floor", "grows", "irregular", "too few", "at rounding", "diverges", "not run"
]


@dataclass(frozen=True)
class LineFit:
    """Fit of the errors of a line; runs in the order in which they were given.

    ``used`` marks the runs of the fit, ``measured`` the runs that ended well, as did every finer
    one. ``stable_from_s`` is their coarsest step (NaN: none); ``failed`` the status of the finest
    run that did not end well, "" where all did, and ``fails_from_s`` its step.

    ``floor`` and ``floor_error`` are NaN where no floor is seen, ``order`` where the error follows
    no power of the step. Uncertainties hold the true value two times in three, and more often next
    to a floor, where they allow floor and step to add or to oppose in any proportion
    (`reports.results.floor_fit`). ``floor_below`` is the largest floor that two such uncertainties
    allow, NaN where the line says nothing about it; a floor that works against the step, rather
    than adds to it, may hide up to about the finest error where none is seen. ``scatter`` is the
    distance of errors from the curve as a share of them. ``curve`` is None where no curve goes
    through the points.
    """

    dt_s: tuple[float, ...]
    error: tuple[float, ...]
    statuses: tuple[str, ...]
    kind: FitKind
    used: tuple[bool, ...]
    measured: tuple[bool, ...]
    stable_from_s: float = math.nan
    fails_from_s: float = math.nan
    failed: str = ""
    order: float = math.nan
    order_error: float = math.nan
    floor: float = math.nan
    floor_error: float = math.nan
    floor_below: float = math.nan
    scatter: float = math.nan
    curve: ErrorCurve | None = None

    @property
    def runs(self) -> tuple[tuple[float, float], ...]:
        """Pairs (step [s], error) of the runs that ended well, finest first."""
        every = zip(self.dt_s, self.error, self.measured, strict=True)
        return tuple(sorted((dt, e) for dt, e, well in every if well))

    @property
    def finest_error(self) -> float:
        """Error at the finest step without failure; NaN where none did."""
        return self.runs[0][1] if self.runs else math.nan

    @property
    def used_range_s(self) -> tuple[float, float]:
        """Finest and coarsest step of the fit; NaN where it uses none."""
        steps = [dt for dt, yes in zip(self.dt_s, self.used, strict=True) if yes]
        return (min(steps), max(steps)) if steps else (math.nan, math.nan)

    def error_at(self, dt_s: float) -> float | None:
        """Return the error at a step, along the fit; None outside the steps of the fit."""
        low, high = self.used_range_s
        near = 1e-12 * high  # a step that was computed as period / n
        if self.curve is None or not low - near <= dt_s <= high + near:
            return None
        return self.curve.at(dt_s)

    def dt_for(self, target: float) -> float | None:
        """Return the coarsest step from which on every error is at most ``target`` [s].

        Along the fit, or between measured points where there is none; None where the target is
        below the floor or the finest error, or every measured step reaches it: nothing is
        extrapolated.
        """
        knots = []
        for dt, error in self.runs:
            fitted = self.error_at(dt)
            knots.append((dt, error if fitted is None else fitted))
        return reach(knots, target, self.error_at)


def fit_line(
    dt_s: Sequence[float],
    error: Sequence[float],
    *,
    rounding: float = AT_ROUNDING,
    statuses: Sequence[str] | None = None,
) -> LineFit:
    """Fit a line: steps [s], the largest error at each, and how each run ended (None: all well).

    An error up to ``rounding`` (same unit) needs no step to explain it.

    Raises
    ------
    ValueError
        Lengths differ, a step is not positive and finite, or an error is negative.
    """
    ends = ("ok",) * len(dt_s) if statuses is None else tuple(statuses)
    return _fit_line(tuple(dt_s), tuple(error), rounding, ends)


@lru_cache(maxsize=256)
def _fit_line(
    dt_s: tuple[float, ...], error: tuple[float, ...], rounding: float, ends: tuple[str, ...]
) -> LineFit:
    """Fit a line, which several sections of a page show."""
    sorted_out = points(dt_s, error, ends, rounding)
    failed = "" if sorted_out.bad is None else ends[sorted_out.bad]
    line = LineFit(
        dt_s,
        error,
        ends,
        "too few",
        used=(False,) * len(ends),
        measured=_mask(sorted_out.well, len(ends)),
        stable_from_s=dt_s[sorted_out.well[-1]] if sorted_out.well else math.nan,
        fails_from_s=math.nan if sorted_out.bad is None else dt_s[sorted_out.bad],
        failed="diverged" if failed == "ok" else failed,
    )
    if not sorted_out.well:
        return replace(line, kind="not run" if sorted_out.bad is None else "diverges")
    if len({dt_s[i] for i in sorted_out.fit}) < 3:
        return replace(line, kind="at rounding" if sorted_out.at_rounding else "too few")
    fitted = _fitted(line, sorted_out.fit)
    if fitted.kind == "floor" and fitted.floor <= NEAR_ROUNDING * rounding:
        return _fit_line(dt_s, error, NEAR_ROUNDING * rounding, ends)
    return fitted


def _fitted(line: LineFit, fit: tuple[int, ...]) -> LineFit:
    """Fit a form to the points ``fit`` (indices, finest first)."""
    dts, errors = np.array(line.dt_s)[list(fit)], np.array(line.error)[list(fit)]
    if not fit_forms.slower(
        fit_forms.LOWEST, dts, errors
    ):  # a floor would not be seen: do not look for one
        return _without_floor(line, fit, dts, errors)
    against = fit_forms.opposed_seen(dts, errors)
    if against is not None:
        return _with_floor(_on(line, fit, against), dts, errors, against)
    bend = fit_forms.longest(fit_forms.FLOOR, dts, errors)
    if bend is not None and fit_forms.floor_seen(bend, dts, errors):
        return _with_floor(_on(line, fit, bend), dts, errors, bend)
    return _without_floor(line, fit, dts, errors)


def _with_floor(line: LineFit, dts: Array, errors: Array, curve: ErrorCurve) -> LineFit:
    """Return a floor, with the doubt of curves of any alignment; its order if points show it."""
    dts, errors, more = dts[: curve.points], errors[: curve.points], fit_forms.uncertainty(curve)
    (alone,) = within(dts, errors, curve, [more**2])
    ordered = alone.order[0] > ORDERS[0] or alone.order[1] < ORDERS[-1]
    near, far = within(dts, errors, curve, [more**2, (2.0 * more) ** 2], ALIGNMENTS)
    return replace(
        line,
        kind="floor",
        order=curve.order if ordered else math.nan,
        order_error=_farthest(curve.order, near.order) if ordered else math.nan,
        floor=curve.floor,
        floor_error=_farthest(curve.floor, near.floor),
        floor_below=far.floor[1],
    )


def _without_floor(line: LineFit, fit: tuple[int, ...], dts: Array, errors: Array) -> LineFit:
    """Fit a power of dt, where one goes through the points."""
    curve = fit_forms.longest(fit_forms.POWER, dts, errors) or straight(dts, errors)
    dts, errors, more = dts[: curve.points], errors[: curve.points], fit_forms.uncertainty(curve)
    if (
        curve.scatter > fit_forms.WILD
        or abs(curve.order) < fit_forms.FLAT
        or fit_forms.leaves(dts, errors)
    ):
        return replace(line, kind="irregular", scatter=curve.scatter)
    (far,) = within(dts, errors, curve, [(2.0 * more) ** 2])
    x, falls = np.log(dts), curve.order > 0.0
    return replace(
        _on(line, fit, curve),
        kind="order" if falls else "grows",
        order=curve.order,
        order_error=more / math.sqrt(float(np.sum((x - x.mean()) ** 2))),
        floor_below=min(far.floor[1], float(errors.min())) if falls else math.nan,
    )


def _on(line: LineFit, fit: tuple[int, ...], curve: ErrorCurve) -> LineFit:
    used = _mask(fit[: curve.points], len(line.used))
    return replace(line, used=used, curve=curve, scatter=curve.scatter)


def _mask(indices: Sequence[int], number: int) -> tuple[bool, ...]:
    there = set(indices)
    return tuple(i in there for i in range(number))


def _farthest(value: float, bounds: tuple[float, float]) -> float:
    return max(bounds[1] - value, value - bounds[0])


NEVER_RUN = ("timeout", "unsupported")
"""Statuses that say nothing about the step."""
NEAR_ROUNDING = 10.0
"""Factor of rounding up to which an error at the finest steps still counts as rounding."""


@dataclass(frozen=True)
class Points:
    """Runs of a line by their step, as indices into the input, finest first.

    ``well`` ended well, as did every finer run; ``fit`` are those of them above rounding. ``bad``
    is the finest run that did not end well, None where all did.
    """

    well: tuple[int, ...]
    fit: tuple[int, ...]
    bad: int | None
    at_rounding: bool


def points(
    dt_s: Sequence[float], error: Sequence[float], statuses: Sequence[str], rounding: float
) -> Points:
    """Sort out a line (see `Points`).

    Raises
    ------
    ValueError
        Lengths differ, a step is not positive and finite, or an error is negative.
    """
    if not len(dt_s) == len(error) == len(statuses):
        raise ValueError(f"{len(dt_s)} steps, {len(error)} errors, {len(statuses)} statuses")
    if not all(math.isfinite(dt) and dt > 0.0 for dt in dt_s) or any(e < 0.0 for e in error):
        raise ValueError("steps must be positive and finite, errors not negative")
    order = sorted(range(len(dt_s)), key=lambda i: (dt_s[i], error[i], statuses[i]))
    ended = [statuses[i] == "ok" and math.isfinite(error[i]) for i in range(len(dt_s))]
    bad = next((i for i in order if not ended[i] and statuses[i] not in NEVER_RUN), None)
    stable = math.inf if bad is None else dt_s[bad]
    well = [i for i in order if ended[i] and dt_s[i] < stable]
    coarsest = max((dt_s[i] for i in well if error[i] <= rounding), default=0.0)

    def rounded(i: int) -> bool:
        """True if at rounding: finer than a step at rounding, it may grow a little."""
        near = NEAR_ROUNDING if dt_s[i] < coarsest else 1.0
        return error[i] <= near * rounding

    fit = [i for i in well if not rounded(i)]
    return Points(tuple(well), tuple(fit), bad, bool(well) and rounded(well[0]))


FAILS = {
    "diverged": "diverges",
    "branch-changed": "changes branch",
    "locked": "locks",
    "crashed": "crashes",
}
NOT_RUN = {"timeout": "timed out at every step", "unsupported": "unsupported"}
VAGUE = 0.15
"""Uncertainty of an order above which it is stated."""


def words(fit: LineFit, unit: str, period_s: float, turn: str = "turn") -> str:
    """Return the verdict in words: 'order 2.0; a floor below 7.2e-9 rad is not excluded by these
    steps', 'diverges below 90 steps per turn'.

    ``period_s`` is the time of a ``turn`` [s], which may have another name.
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
    if fit.kind == "order":
        return _order(fit, unit)
    if fit.kind == "floor":
        return f"converges to the wrong answer: {floor_words(fit.floor, unit=unit)}"
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


def _order(fit: LineFit, unit: str) -> str:
    if fit.order + fit.order_error < fit_forms.LEVEL:
        return f"order {fit.order:.1f}: slower than any integrator, a floor may be near"
    vague = f" +- {fit.order_error:.1f}" if fit.order_error > VAGUE else ""
    return f"order {fit.order:.1f}{vague}; {floor_words(math.nan, fit.floor_below, unit)}"


def _irregular(fit: LineFit, unit: str) -> str:
    least, last = min(error for _, error in fit.runs), fit.finest_error
    if least < last:
        return f"irregular: falls to {short(least)} {unit}, then rises to {short(last)}"
    return f"irregular: follows no order, {short(last)} {unit} at the finest step"


def _per_turn(dt_s: float, period_s: float, turn: str) -> str:
    return f"{period_s / dt_s:.4g} steps per {turn}"
