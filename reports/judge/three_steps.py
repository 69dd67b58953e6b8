"""Convergence of an error when the step is halved, in words and numbers.

Three steps are the least that separate a floor from a slope: from errors e1, e2, e3 at dt, dt/2,
dt/4 the model floor + C dt^p gives 2^p = (e1 - e2) / (e2 - e3) and the floor e3 - (e2 - e3) / (2^p
- 1).
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from reports.output.numbers import floor_words
from sim.engine import AT_ROUNDING

Trend = Literal[
    "shrinks",
    "levels off",
    "does not shrink",
    "grows",
    "at rounding",
    "as solved",
    "as the reference",
    "diverges",
]

STAYS, GROWS = 0.6, 2.0
"""Ratios of the last error to the first: first order makes 0.25, and a floor wanders a little."""


@dataclass(frozen=True)
class Convergence:
    """The largest position-like error [``unit``] at each step, and its trend.

    ``order`` is the mean slope over the steps, NaN where there is none; ``floor`` the error that
    remains for dt to 0, NaN where none is seen. For the finer runs ``faults`` are bad endings,
    ``over`` errors over the limit of that step, and ``copied`` numbers from another run, or from
    the reference.
    """

    dt_s: tuple[float, ...]
    error: tuple[float, ...]
    unit: str
    trend: Trend
    order: float
    floor: float
    faults: tuple[str, ...] = ()
    over: tuple[str, ...] = ()
    copied: tuple[str, ...] = ()

    @property
    def words(self) -> str:
        """A few words for a table."""
        if self.faults:
            return "finer run failed"
        if self.trend == "shrinks":
            return f"order {self.order:.1f}"
        if self.trend == "grows":
            return "does not shrink: it grows"
        if self.trend in ("does not shrink", "levels off"):
            return f"{self.trend}: {floor_words(self.floor)}"
        return self.trend


def convergence(
    dt_s: Sequence[float],
    error: Sequence[float],
    unit: str,
    rounding: float = AT_ROUNDING,
    *,
    faults: Sequence[str] = (),
    over: Sequence[str] = (),
    copied: Sequence[str] = (),
    cancels: bool = False,
    known: float = 0.0,
    solved: float = 0.0,
) -> Convergence:
    """Read three errors at dt, dt/2, dt/4 (see the module); below ``rounding`` no step matters.

    Where errors of several kinds may cancel at one of the steps, as those of a phase, a floor
    counts only where the last halving leaves most of the error. An error up to ``known`` is no
    engine's: it is the reference's own, or the model's. One up to ``solved`` that does not shrink
    is as near as the engine solves its joints.

    Raises ValueError for not exactly three steps.
    """
    if len(dt_s) != 3 or len(error) != 3:
        raise ValueError(f"{len(error)} steps: a floor needs three")
    first, second, third = error
    trend, order, floor = _read(first, second, third, rounding)
    if trend in ("grows", "does not shrink") and max(second, third) <= solved:
        trend, order, floor = "as solved", math.nan, math.nan
    stays_or_shrinks = trend in ("shrinks", "levels off", "does not shrink")
    if stays_or_shrinks and max(second, third) <= known:
        trend, order, floor = "as the reference", math.nan, math.nan
    elif trend == "levels off" and floor <= known:
        trend, floor = "shrinks", math.nan
    if cancels and trend == "levels off" and third <= STAYS * second:
        trend, floor = "shrinks", math.nan
    told = (tuple(texts) for texts in (faults, over, copied))
    return Convergence(tuple(dt_s), tuple(error), unit, trend, order, floor, *told)


def _read(e1: float, e2: float, e3: float, rounding: float) -> tuple[Trend, float, float]:
    """Return trend, order and floor of three errors, each step half the one before."""
    if not all(math.isfinite(e) for e in (e1, e2, e3)):
        return "diverges", math.nan, math.nan
    if max(e2, e3) <= rounding:
        return "at rounding", math.nan, math.nan
    order = math.log2(e1 / e3) / 2 if e3 > 0.0 and e1 > 0.0 else math.nan
    if e3 > GROWS * e1:
        return "grows", order, math.nan
    if e3 > STAYS * e1:
        return "does not shrink", order, _floor(e1, e2, e3)
    floor = _floor(e1, e2, e3)
    if floor > 0.5 * e3:
        return "levels off", order, floor
    return "shrinks", order, math.nan


def _floor(e1: float, e2: float, e3: float) -> float:
    """Return the limit for dt to 0 of floor + C dt^p through three errors; the last one where the
    errors do not fall like that."""
    first, second = e1 - e2, e2 - e3
    if second <= 0.0 or first <= second:
        return e3
    return max(e3 - second / (first / second - 1.0), 0.0)
