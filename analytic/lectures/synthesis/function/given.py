"""The function that a mechanism is to generate: a formula, a table or Python's own function."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from models.array import Array
from models.errors import CrankcheckError
from models.lectures.formula import parse_formula
from models.tabulated import Tabulated

LOOKS = 2001
"""Looks at a function over its range."""
HALVINGS = 45
"""Of the widest step between two looks, in search of a jump: a root, the steepest of what is
continuous, rises by 2e-7 of that step over what is left of it."""
JUMP = 1e-3
"""Of the range of y: what is left of the widest step at a jump."""
FLAT = 1e-12
"""Of the largest value: a function that changes by less is constant."""


@dataclass(frozen=True)
class GivenFunction:
    """A function by its name; ``at`` gives its values (T,) at x (T,), no numbers where it has none.

    ``rows`` is the range of x that a table has.
    """

    name: str
    at: Callable[[Array], Array]
    rows: tuple[float, float] | None = None

    @staticmethod
    def of_formula(text: str) -> GivenFunction:
        """That of a text such as ``x^1.6``. Raises CrankcheckError for what is no formula."""
        formula = parse_formula(text)
        return GivenFunction(f"y = {formula.text}", formula.at)

    @staticmethod
    def of_table(x: Sequence[float], y: Sequence[float], name: str = "a table") -> GivenFunction:
        """That of rows, with cubics between them that rise and fall where the rows do.

        Raises CrankcheckError for fewer than two rows, places that do not increase, and values that
        are no numbers.
        """
        places, values = tuple(map(float, x)), tuple(map(float, y))
        if not np.isfinite([*places, *values]).all():
            raise CrankcheckError(f"{name}: the rows of a function have to be finite numbers")
        try:
            table = Tabulated(places, values, "pchip")
        except ValueError as fault:
            raise CrankcheckError(f"{name}: {fault}") from None
        return GivenFunction(name, table.at, (places[0], places[-1]))

    @staticmethod
    def of_callable(function: Callable[[float], float], name: str = "y = f(x)") -> GivenFunction:
        """That of a Python function of one number, which may raise where it is not defined."""
        return GivenFunction(
            name, lambda x: np.array([_value(function, one) for one in x.tolist()])
        )

    def extremes(self, low: float, high: float) -> tuple[float, float]:
        """The least and the largest y between two x.

        Raises
        ------
        CrankcheckError
            A range that is none; one on which the function is not defined, jumps or is constant.
        """
        if not (np.isfinite([low, high]).all() and low < high):
            raise CrankcheckError(
                f"{self.name}: a range of x from {low:g} to {high:g} was asked for; give two "
                "numbers, the smaller one first"
            )
        if self.rows is not None and not self.rows[0] <= low < high <= self.rows[1]:
            raise CrankcheckError(
                f"{self.name}: x from {low:g} to {high:g} was asked for, and its rows go from "
                f"{self.rows[0]:g} to {self.rows[1]:g}; ask for what lies within them"
            )
        x = np.linspace(low, high, LOOKS)
        y = self._defined(x)
        least, most = float(np.min(y)), float(np.max(y))
        if most - least <= FLAT * float(np.max(np.abs(y))):
            raise CrankcheckError(
                f"{self.name} is constant from x = {low:g} to {high:g}: an output that stands "
                "still needs no mechanism; give a function that changes"
            )
        self._refuse_jump(x, y, most - least)
        return min(least, self._tip(x, y, -1.0)), max(most, self._tip(x, y, 1.0))

    def _defined(self, x: Array) -> Array:
        """The values; raises CrankcheckError that names the first x without one."""
        y = self.at(x)
        bad = ~np.isfinite(y)
        if bad.any():
            at = x[int(np.argmax(bad))]
            raise CrankcheckError(
                f"{self.name} is not defined at x = {at:.6g}; give a range without this place"
            )
        return y

    def _refuse_jump(self, x: Array, y: Array, span: float) -> None:
        """Halve the widest step: what is continuous gets flat."""
        k = int(np.argmax(np.abs(np.diff(y))))
        ends, values = x[k : k + 2], y[k : k + 2]
        for _ in range(HALVINGS):
            three = np.array([ends[0], ends.mean(), ends[1]])
            along = np.array([values[0], self._defined(three[1:2])[0], values[1]])
            later = int(abs(along[2] - along[1]) > abs(along[1] - along[0]))
            ends, values = three[later : later + 2], along[later : later + 2]
        if abs(values[1] - values[0]) > JUMP * span:
            raise CrankcheckError(
                f"{self.name} jumps at x = {ends[0]:.6g}; give a range in which it is continuous"
            )

    def _tip(self, x: Array, y: Array, sign: float) -> float:
        """The largest value, with sign -1 the least, looked for closer about the largest look."""
        k = int(np.argmax(sign * y))
        low, high = x[max(k - 1, 0)], x[min(k + 1, len(x) - 1)]
        best = sign * y[k]
        for _ in range(4):
            looks = np.linspace(low, high, 65)
            values = sign * self._defined(looks)
            k = int(np.argmax(values))
            best = max(best, values[k])
            low, high = looks[max(k - 1, 0)], looks[min(k + 1, 64)]
        return float(sign * best)


def _value(function: Callable[[float], float], x: float) -> float:
    """Of a Python function; nan where it raises what arithmetic raises, or gives no real number."""
    try:
        y = function(x)
        return float("nan") if isinstance(y, complex) else float(y)
    except (ArithmeticError, ValueError):
        return float("nan")
