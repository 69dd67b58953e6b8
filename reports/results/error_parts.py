"""Split an error over the crank angle into parts that a user can adjust.

For the cells of a line, which differ in step only, at the instants that they share::

    total(t; dt)     = drive + geometric          geometric: against the logged crank angle
    geometric(t; dt) = floor(t) + discretisation(t; dt)
    floor(t)         = g1 + (g1 - g2) / (r^p - 1)

with g1 and g2 the geometric errors at the two finest steps, r the ratio of these steps and p the
order that was fitted to the line: Richardson's extrapolation to dt = 0 (Richardson, Phil. Trans.
R. Soc. A 210, 1911), instant by instant and with sign. The parts add up to the total exactly.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from models.array import Array
from reports.compare.last_turn import Trace
from reports.results.line_fit import LineFit
from reports.results.lines import Line

SHARED = 12
"""Least number of instants that two steps must share: fewer make no curve."""
SAME = 1e-9
"""Part of a period below which two instants are equal."""
UNTOLD_ORDER = 1.0
"""Order where the points show none because the floor is all of the error: at such a line the two
finest errors hardly differ, and the order hardly matters."""
LEAST_ORDER = 0.3
"""Order below which nothing falls with the step."""
LEFT = "the logged crank left the range of the mechanism"


@dataclass(frozen=True)
class CurveBody:
    """Link or slider of a curve: the series of its trace, and the divisor of that.

    ``scale`` is 1 for a link angle [rad] and the longest link [m] for a slider.
    """

    series: str
    scale: float

    @property
    def name(self) -> str:
        quantity, _, body = self.series.partition(".")
        return f"{'angle' if quantity == 'angle' else 'displacement'} of {body}"


@dataclass(frozen=True)
class ErrorParts:
    """Parts of the error of one cell, pure, with sign, shape (T,) each; their sum is ``total``.

    ``floor`` and ``discretisation`` are None where no floor is known, and ``drive`` and
    ``geometric`` where the logged crank left the range of the mechanism.
    """

    time_s: Array
    driver_rad: Array
    total: Array
    gap: Array
    drive: Array | None = None
    geometric: Array | None = None
    floor: Array | None = None
    discretisation: Array | None = None

    @property
    def curves(self) -> dict[str, Array]:
        """Parts that exist, by name; ``geometric`` only if it is not split."""
        names = ("total", "drive", "floor", "discretisation", "geometric", "gap")
        every = {name: getattr(self, name) for name in names}
        if self.floor is not None:
            del every["geometric"]
        return {name: curve for name, curve in every.items() if curve is not None}


@dataclass(frozen=True)
class Split:
    """Parts of every cell of a line that has a trace, by key.

    ``floor`` is the largest extrapolated error, and ``doubt`` its uncertainty: from the order, from
    the next coarser steps, and all of it where the line shows no floor (both NaN where there is
    none; ``why`` then says why). Only a floor above its doubt is seen.
    """

    cells: Mapping[str, ErrorParts]
    floor: float = math.nan
    doubt: float = math.nan
    why: str = ""

    @property
    def seen(self) -> bool:
        return self.floor > self.doubt


@dataclass(frozen=True)
class _Extrapolated:
    """The extrapolated error at the instants ``time_s``, and its doubt."""

    time_s: Array
    error: Array
    doubt: float


def worst_body(
    lines: Sequence[Line], trace: Callable[[str], Trace], longest_m: float
) -> CurveBody | None:
    """Return the link or slider of a scene with the largest error, over all its lines.

    The finest cell of each line that ended well counts, by the logarithm of its largest error: one
    line that is far off does not decide for the others.
    """
    sums: dict[str, float] = {}
    for line in lines:
        done = line.cells[line.cells["status"] == "ok"]
        if done.empty:
            continue
        for name, values in trace(str(done["key"].iloc[-1])).items():
            kind = name.partition(".")[0]
            if kind in ("angle", "displacement"):
                pure = float(np.max(np.abs(values))) / (1.0 if kind == "angle" else longest_m)
                sums[name] = sums.get(name, 0.0) + math.log10(max(pure, 1e-15))
    if not sums:
        return None
    worst = max(sums, key=lambda name: sums[name])
    return CurveBody(worst, 1.0 if worst.startswith("angle.") else longest_m)


def split(line: Line, trace: Callable[[str], Trace], body: CurveBody, longest_m: float) -> Split:
    """Return the parts of the error of every cell of a line.

    Parameters
    ----------
    line : Line
        Cells from the coarse to the fine step, with the fit of their error of place.
    trace : Callable
        From the key of a cell to its trace (`reports.compare.last_turn`), empty where there is
        none.
    body : CurveBody
        The body of the curves.
    longest_m : float
        The longest link, which gaps are divided by [m].
    """
    traces = {str(key): trace(str(key)) for key in line.cells["key"]}
    traces = {key: one for key, one in traces.items() if body.series in one}
    limit = _limit(line, traces, body)
    extrapolated = limit if isinstance(limit, _Extrapolated) else None
    cells = {
        key: _parts(one, body, longest_m, extrapolated, line.period_s)
        for key, one in traces.items()
    }
    if extrapolated is None:
        return Split(cells, why=str(limit))
    floor = float(np.max(np.abs(extrapolated.error)))
    # A line that falls as far as it was run has no floor: the rest is doubt.
    doubt = extrapolated.doubt if line.fit.kind == "floor" else max(extrapolated.doubt, floor)
    return Split(cells, floor=floor, doubt=doubt)


def _limit(line: Line, traces: Mapping[str, Trace], body: CurveBody) -> _Extrapolated | str:
    """Return the error at dt = 0 by Richardson's extrapolation, or why there is none."""
    order = _order(line.fit)
    if order is None:
        return "the error follows no order of the step"
    name = f"geometric.{body.series}"
    # Not the finest cells: the fit does not use one that timed out, or is at rounding.
    stood_on = line.cells.loc[list(line.fit.used), ["key", "dt_s"]]
    finest = [
        _Logged(float(dt), traces[key][name] / body.scale, traces[key]["time_s"])
        for key, dt in stood_on.iloc[::-1].itertuples(index=False)
        if name in traces.get(key, {})
    ][:3]
    if len(finest) < 3:
        left = any(key in traces for key in stood_on["key"])
        return LEFT if left else "no fitted run was logged"
    fine = _extrapolated(finest[0], finest[1], order, line.period_s)
    coarse = _extrapolated(finest[1], finest[2], order, line.period_s)
    if fine is None:
        return "the two finest steps were logged at different instants"
    if coarse is None:
        return fine
    # The difference to the next coarser steps is doubt as well.
    here, there = shared(fine.time_s, coarse.time_s, line.period_s)
    other = float(np.max(np.abs(fine.error[here] - coarse.error[there]), initial=0.0))
    return replace(fine, doubt=max(fine.doubt, other))


@dataclass(frozen=True)
class _Logged:
    """The geometric error of one run [pure] at the instants of its log, (T,), and its step."""

    dt_s: float
    error: Array
    time_s: Array


def _extrapolated(
    fine: _Logged, coarse: _Logged, order: tuple[float, float], period_s: float
) -> _Extrapolated | None:
    """Return Richardson's extrapolation of two runs; None where they share too few instants."""
    here, there = shared(fine.time_s, coarse.time_s, period_s)
    if len(here) < SHARED:
        return None
    p, more = order
    ratio = coarse.dt_s / fine.dt_s
    growth = ratio**p
    step = fine.error[here] - coarse.error[there]
    # d floor / d p, times the uncertainty of p
    slope = growth * math.log(ratio) / (growth - 1.0) ** 2
    doubt = slope * more * float(np.max(np.abs(step)))
    return _Extrapolated(fine.time_s[here], fine.error[here] + step / (growth - 1.0), doubt)


def _order(fit: LineFit) -> tuple[float, float] | None:
    """Return the order to extrapolate with and twice its uncertainty; None where there is none."""
    if fit.kind == "floor" and not math.isfinite(fit.order):
        return UNTOLD_ORDER, 1.0
    if fit.kind not in ("order", "floor") or not fit.order > LEAST_ORDER:
        return None
    return fit.order, 2.0 * fit.order_error if math.isfinite(fit.order_error) else 0.5


def _parts(
    trace: Trace, body: CurveBody, longest_m: float, limit: _Extrapolated | None, period_s: float
) -> ErrorParts:
    """Return the parts of one cell, at the instants where all of them are known."""
    series = {
        "time_s": trace["time_s"],
        "driver_rad": trace["driver_rad"],
        "total": trace[body.series] / body.scale,
        "gap": trace["gap"] / longest_m,
    }
    logged = trace.get(f"geometric.{body.series}")
    if logged is None:
        return ErrorParts(**series)
    geometric = logged / body.scale
    series |= {"drive": series["total"] - geometric, "geometric": geometric}
    if limit is None:
        return ErrorParts(**series)
    here, there = shared(series["time_s"], limit.time_s, period_s)
    if len(here) < SHARED:
        return ErrorParts(**series)
    series = {name: values[here] for name, values in series.items()}
    floor = limit.error[there]
    return ErrorParts(**series, floor=floor, discretisation=series["geometric"] - floor)


def shared(a_s: Array, b_s: Array, period_s: float) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Return indices of the instants that two rising series of times [s] have in common."""
    if not (len(a_s) and len(b_s)):
        return np.zeros(0, np.intp), np.zeros(0, np.intp)
    right = np.clip(np.searchsorted(b_s, a_s), 1, max(len(b_s) - 1, 1))
    left = right - 1
    right = np.minimum(right, len(b_s) - 1)
    near = np.where(np.abs(b_s[left] - a_s) <= np.abs(b_s[right] - a_s), left, right)
    here = np.flatnonzero(np.abs(b_s[near] - a_s) <= SAME * period_s)
    return here, near[here]
