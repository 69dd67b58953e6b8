"""A family of mechanisms that differ in one length, side by side in one table of formulas."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from models.errors import CrankcheckError, suggestion
from reports.workbook.drive_inputs import DRIVE_COLUMNS
from reports.workbook.evaluated import evaluated
from reports.workbook.formula_table import NAME, Column, FormulaTable

MOST_MEMBERS = 20
SHARED = frozenset(column.name for column in DRIVE_COLUMNS)
OF_THE_DRIVE = ("omega", "start_deg", "step_deg", "branch")
"""Inputs that all members share: they move as one."""


def family(table: FormulaTable, name: str, values: Sequence[float]) -> FormulaTable:
    """The table with a group of columns for each value of the input ``name``.

    Raises CrankcheckError for an input that the table has not, or has for all members; too many
    values; and a member that can not be assembled, which it names.
    """
    names = [each.name for each in table.inputs if each.name not in OF_THE_DRIVE]
    if name not in names:
        raise CrankcheckError(f"--family {name}: {suggestion(name, names, 'the lengths are')}")
    if not 1 < len(values) <= MOST_MEMBERS:
        raise CrankcheckError(
            f"--family {name}: {len(values)} values; give 2 to {MOST_MEMBERS}, such as "
            f"{name}=3.5,2.5"
        )
    for value in values:
        _check_member(table, name, value)
    members = range(1, len(values) + 1)
    (one,) = (each for each in table.inputs if each.name == name)
    inputs = [each for each in table.inputs if each is not one]
    inputs[:0] = [
        replace(one, name=f"{name}_{k}", value=value, told=f"{one.told}, member {k}")
        for k, value in zip(members, values, strict=True)
    ]
    own = [column for column in table.columns if column.name not in SHARED]
    columns = [column for column in table.columns if column.name in SHARED]
    columns += [_of_member(column, name, k) for k in members for column in own]
    charts = {
        title: [f"{column}_{k}" for k in members for column in drawn]
        for title, drawn in table.charts.items()
    }
    return FormulaTable(inputs, columns, table.count, charts)


def _check_member(table: FormulaTable, name: str, value: float) -> None:
    """Refuse a member that can not be assembled in every row."""
    inputs = [replace(i, value=value) if i.name == name else i for i in table.inputs]
    columns = evaluated(replace(table, inputs=inputs))
    open_at = ~np.isfinite(np.sum([columns[c.name] for c in table.columns], axis=0))
    if open_at.any():
        at = np.degrees(columns["phi"][int(np.argmax(open_at))])
        raise CrankcheckError(
            f"--family {name}={value:g}: this member can not be assembled with its crank at "
            f"{at:.4g} deg; leave it out, or choose another {name}"
        )


def _of_member(column: Column, name: str, k: int) -> Column:
    """A column of the member ``k``, with the member's own inputs and columns in its formula."""

    def own(formula: str) -> str:
        return NAME.sub(
            lambda m: (
                f"{{{m[1]}_{k}}}" if m[1] == name
                else m[0] if m[1] or m[2] in SHARED
                else f"[{m[2]}_{k}{m[3] or ''}]"
            ),
            formula,
        )  # fmt: skip

    first = None if column.first is None else own(column.first)
    head = f'="{column.head}, {name} = "&{{{name}_{k}}}'
    return Column(f"{column.name}_{k}", head, own(column.formula), first)
