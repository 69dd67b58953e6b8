"""The numbers of a table of formulas, worked out here: what a spreadsheet will show."""

from __future__ import annotations

import re
from collections.abc import Mapping

import numpy as np

from models.array import Array
from reports.lectures.drawing.workbook.formula_table import NAME, FormulaTable

FUNCTIONS = {
    "SIN": np.sin,
    "COS": np.cos,
    "ACOS": np.arccos,
    "SQRT": np.sqrt,
    "RADIANS": np.radians,
    "ABS": np.abs,
    "ATAN2": lambda x, y: np.arctan2(y, x),  # a spreadsheet has x first
    "PI": lambda: np.pi,
    "IF": np.where,
    "ISNUMBER": np.isfinite,
    "NA": lambda: np.nan,
}


def evaluated(table: FormulaTable) -> dict[str, Array]:
    """Every column by name, (rows,); NaN where a mechanism can not be assembled. Columns of words
    are arrays of text.

    Columns that build on the row before are told by what they end in: numbers of rows, and angles
    that go on continuously.
    """
    values: dict[str, Array] = {}
    given = {each.name: each.value for each in table.inputs}
    with np.errstate(invalid="ignore", divide="ignore"):
        for column in table.columns:
            if column.first is None:
                value = _of(column.formula, values, given)  # one number where all rows have it
                values[column.name] = np.broadcast_to(value, table.count)
            elif column.first == "0":
                values[column.name] = np.arange(table.count, dtype=float)
            else:
                values[column.name] = np.unwrap(_of(column.first, values, given))
    return values


def _of(formula: str, values: Mapping[str, Array], given: Mapping[str, float]) -> Array:
    """A formula that stands in one row."""
    names: dict[str, object] = {f"in_{name}": value for name, value in given.items()}
    names |= {f"at_{name}": value for name, value in values.items()}
    plain = NAME.sub(lambda m: f"in_{m[1]}" if m[1] else f"at_{m[2]}", formula).replace("^", "**")
    code = compile(re.sub(r"\s+", " ", plain), "<formula>", "eval")  # of ours alone
    return np.asarray(eval(code, {"__builtins__": {}}, names | FUNCTIONS))
