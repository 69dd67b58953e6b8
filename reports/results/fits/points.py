"""Which runs of a line a fit may stand on: those that ended well, above rounding."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

NOT_RUN = ("timeout", "unsupported")
"""Statuses that say nothing about the step."""
NEAR_ROUNDING = 10.0
"""Up to so many times the rounding an error at the finest steps is still taken for rounding."""


@dataclass(frozen=True)
class Points:
    """The runs of a line by their step, as indices into what was given, finest first.

    ``well`` ended well, as did every finer run; ``fit`` are those of them above rounding.
    ``bad`` is the finest run that did not end well, None where all did.
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
    bad = next((i for i in order if not ended[i] and statuses[i] not in NOT_RUN), None)
    stable = math.inf if bad is None else dt_s[bad]
    well = [i for i in order if ended[i] and dt_s[i] < stable]
    coarsest = max((dt_s[i] for i in well if error[i] <= rounding), default=0.0)

    def rounded(i: int) -> bool:
        """Finer than a step at rounding an error is rounding too, and grows a little."""
        near = NEAR_ROUNDING if dt_s[i] < coarsest else 1.0
        return error[i] <= near * rounding

    fit = [i for i in well if not rounded(i)]
    return Points(tuple(well), tuple(fit), bad, bool(well) and rounded(well[0]))
