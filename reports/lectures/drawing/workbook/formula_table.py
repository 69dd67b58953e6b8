"""A table of formulas over inputs: columns that are written once, for all rows of a sheet.

Spreadsheets take -a^2 for (-a)^2: a square that is taken away stands in brackets.

A formula is written with names: ``{AB}`` an input, ``[phi]`` the same row's value of a column,
``[phi-1]`` that of the row before. The first row may have another formula, as nothing is before it.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

from openpyxl.utils import get_column_letter  # type: ignore[import-untyped]  # ships no stubs

NAME = re.compile(r"\{([\w]+)\}|\[([\w]+?)(-1)?\]")
STATE = "state"
"""The column that says in words whether a row's position can be assembled."""
ASSEMBLED = "assembled"
ZERO = "1E-14"
"""What is not told from 0: its root is 1e-7, and rates are that many times less certain."""
Range = Literal["any", "above 0", "not 0", "1 or -1"]


@dataclass(frozen=True)
class Input:
    """A number that may be changed: its name in formulas, its unit, what it is, which values it
    takes, and the link whose length it is, if it is one's."""

    name: str
    value: float
    unit: str
    told: str
    range: Range = "any"
    link: str = ""

    def allows(self, value: float) -> bool:
        """Whether the value is in its range."""
        return {
            "any": True,
            "above 0": value > 0.0,
            "not 0": value != 0.0,
            "1 or -1": abs(value) == 1.0,
        }[self.range]


@dataclass(frozen=True)
class Column:
    """A column of formulas; ``head`` is what stands above it, its unit with it, or a formula of
    inputs that says so."""

    name: str
    head: str
    formula: str
    first: str | None = None


@dataclass(frozen=True)
class FormulaTable:
    """Inputs and columns in ``count`` rows; ``charts`` are the names of the columns drawn over the
    time, by the title of their chart."""

    inputs: Sequence[Input]
    columns: Sequence[Column]
    count: int
    charts: Mapping[str, Sequence[str]]

    def place(self, column: str) -> int:
        """The number of a column by its name, from 1."""
        return [each.name for each in self.columns].index(column) + 1

    def letter(self, column: str) -> str:
        """The letter of a column by its name."""
        return str(get_column_letter(self.place(column)))

    @property
    def states(self) -> list[str]:
        """The columns that say whether a position can be assembled: one, or one a member."""
        names = [each.name for each in self.columns]
        return [name for name in names if name == STATE or name.startswith(f"{STATE}_")]


def state_column(inside: str) -> Column:
    """Says by the sign of the column ``inside``, the square of what the rates are divided by over
    its size, whether a row can be assembled."""
    words = f'"cannot be assembled",IF([{inside}]>{ZERO},"{ASSEMBLED}","rates not determined")'
    formula = f'IF(ISNUMBER([{inside}]),IF([{inside}]<-{ZERO},{words}),"not determined")'
    return Column(STATE, STATE, formula)
