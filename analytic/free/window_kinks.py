"""Where a window comes to a change of formula, so that it may end there."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.polynomial import legendre

from analytic.free.coordinate_history import MOST
from analytic.free.formula_change import FormulaChange, first_crossing, precisely
from analytic.free.gauss import Gauss, gauss
from analytic.free.kinks import Kinked, kinked
from analytic.free.machine import Machine
from analytic.free.window import WindowSolution
from models.array import Array
from models.errors import CrankcheckError

LEAST_AHEAD = 0.02
"""The share of a window from which on a change of formula is foretold before it is solved."""
PRECISELY = 4e-14
"""To what share of a window a change of formula is found: to rounding of what its formula goes
over, some hundred times that of the time."""
SHORT_OF, BEYOND = 1.0 - 2e-4, MOST
"""Windows are solved to a little before it, and used up to it."""


@dataclass(frozen=True)
class WindowKinks:
    """The changes of formula in a window; ``smooth`` says that it does not start in one."""

    machine: Machine
    rule: Gauss
    smooth: bool

    def ahead(self, long_s: float, start: tuple[float, float, float]) -> float | None:
        """When a formula first gives way in a window that starts with u, u' and u'', as far as
        these tell [s after the start]."""
        u, v, a = start
        if not math.isfinite(a):
            return None
        looks = long_s * looked_at(self.rule.count, 1.0, smooth=self.smooth)[0]
        try:
            rows = kinked(self.machine, u + looks * (v + 0.5 * a * looks), v + a * looks)
        except CrankcheckError:  # out of its reach, where the motion itself does not come
            return None
        change = first_crossing(rows, looks)
        return change.at_s if change and change.at_s > LEAST_AHEAD * long_s else None

    def within(self, solved: WindowSolution, *, beyond: bool) -> FormulaChange | None:
        """Where in a window, or a little beyond it, a formula first gives way to another."""
        end = BEYOND if beyond else 1.0
        shares, polynomials = looked_at(self.rule.count, end, smooth=self.smooth)
        u, v, _ = solved.series
        rows = kinked(self.machine, polynomials[:, : u.size] @ u, polynomials[:, : v.size] @ v)
        return first_crossing(rows, shares * solved.long_s)

    def landing(self, solved: WindowSolution, change: FormulaChange) -> float:
        """How long after the start of a window a formula has just given way [s]."""

        def formulas(after_s: Array) -> list[Kinked]:
            return kinked(self.machine, *solved.at(after_s))

        shares, _ = looked_at(self.rule.count, 1.0, smooth=self.smooth)
        first, least_s = float(shares[0]) * solved.long_s, PRECISELY * solved.long_s
        return precisely(formulas, change, first, least_s)


@lru_cache(maxsize=32)
def looked_at(count: int, end: float, *, smooth: bool) -> tuple[Array, Array]:
    """The shares of a window at which formulas are looked at, (T,): its nodes and ``end``, and its
    start if it is not between two formulas; and Legendre's polynomials there, (T, count + 2)."""
    shares = np.append(gauss(count).places, end)
    if smooth:
        shares = np.append(0.0, shares)
    return shares, np.asarray(legendre.legvander(2.0 * shares - 1.0, count + 1), dtype=np.float64)
