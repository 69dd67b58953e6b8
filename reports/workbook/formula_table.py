"""A table of formulas over inputs, as cells of a sheet.

Spreadsheets take -a^2 for (-a)^2: a square that is taken away stands in brackets.

A formula is written with names: ``{AB}`` an input, ``[phi]`` the same row's value of a column,
``[phi-1]`` that of the row before. The first row may have another formula, as nothing is before it.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from openpyxl.utils import get_column_letter  # type: ignore[import-untyped]  # ships no stubs
from openpyxl.worksheet.worksheet import (  # type: ignore[import-untyped]  # as above
    Worksheet,
)

NAME = re.compile(r"\{([\w]+)\}|\[([\w]+?)(-1)?\]")
HEAD_ROWS = 1


@dataclass(frozen=True)
class Input:
    """A number that may be changed: its name in formulas, its unit, and what it is."""

    name: str
    value: float
    unit: str
    told: str


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

    def letter(self, column: str) -> str:
        """The letter of a column by its name."""
        names = [each.name for each in self.columns]
        return str(get_column_letter(names.index(column) + 1))


def write_inputs(sheet: Worksheet, inputs: Sequence[Input]) -> None:
    """The inputs, one a row: name, value, unit, and what it is."""
    sheet.append(["name", "value", "unit", "what it is"])
    for each in inputs:
        sheet.append([each.name, each.value, each.unit or None, each.told])
    for letter, width in zip("ABCD", (14, 24, 10, 70), strict=True):
        sheet.column_dimensions[letter].width = width


def write_columns(sheet: Worksheet, table: FormulaTable, inputs_of: str) -> None:
    """The columns, with the inputs in a sheet of the name ``inputs_of``."""
    places = {each.name: f"'{inputs_of}'!$B${row}" for row, each in enumerate(table.inputs, 2)}
    sheet.append([_head(each.head, table, places) for each in table.columns])
    for number in range(table.count):
        row = number + HEAD_ROWS + 1
        cells = []
        for column in table.columns:
            plain = column.first if number == 0 and column.first is not None else column.formula
            cells.append("=" + _placed(plain, table, places, row))
        sheet.append(cells)
    sheet.freeze_panes = "B2"
    for column in table.columns:
        sheet.column_dimensions[table.letter(column.name)].width = 16


def _head(head: str, table: FormulaTable, inputs: Mapping[str, str]) -> str:
    """A head; one that has an input in it shows what that is now."""
    return _placed(head, table, inputs, 0) if head.startswith("=") else head


def _placed(formula: str, table: FormulaTable, inputs: Mapping[str, str], row: int) -> str:
    """The formula with cells in place of names."""

    def cell(match: re.Match[str]) -> str:
        given, column, before = match.groups()
        if given:
            return inputs[given]
        return f"{table.letter(column)}{row - 1 if before else row}"

    return NAME.sub(cell, formula)
