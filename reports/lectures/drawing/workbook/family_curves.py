"""What is drawn of a family: position, velocity and acceleration of its members over the crank's
angle."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from models.array import Array
from reports.lectures.drawing.workbook.family import member_columns, varied
from reports.lectures.drawing.workbook.formula_table import FormulaTable
from reports.output.numbers import readable

KINDS = ("position", "velocity", "acceleration")


@dataclass(frozen=True)
class FamilyChart:
    """One quantity of all members: its ``kind``, its name with its unit, and a curve a member."""

    kind: str
    label: str
    curves: Sequence[Array]


@dataclass(frozen=True)
class FamilyCurves:
    """The charts of a family whose members differ in ``name``; ``angles_deg`` are the crank's,
    (rows,) for each member, and ``charts`` go by kind, so many of each."""

    name: str
    unit: str
    values: Sequence[float]
    angles_deg: Sequence[Array]
    charts: Sequence[FamilyChart]

    @property
    def members(self) -> list[str]:
        """What each is called: L = 3.5 m."""
        return [f"{self.name} = {readable(v, 6)} {self.unit}".rstrip() for v in self.values]

    def of_kind(self, kind: str) -> list[FamilyChart]:
        """The charts of a kind."""
        return [chart for chart in self.charts if chart.kind == kind]


def family_curves(table: FormulaTable, name: str, values: Sequence[float]) -> FamilyCurves:
    """The curves of a family of formulas. Raises CrankcheckError as `family`."""
    one = varied(table, name, values)
    members = member_columns(table, one, values, name)
    heads = {each.name: each.head for each in table.columns}
    charts = [
        FamilyChart(kind, with_unit(heads[column]), [member[column] for member in members])
        for kind, columns in zip(KINDS, table.charts.values(), strict=True)
        for column in columns
    ]
    angles = [np.degrees(member["phi"]) for member in members]
    return FamilyCurves(one.name, one.unit, values, angles, charts)


def with_unit(head: str) -> str:
    """X' [m/s] of a head X' m/s."""
    words, _, unit = head.rpartition(" ")
    return f"{words} [{unit.replace('^2', '²')}]"


def extremes(curves: FamilyCurves) -> list[Mapping[str, object]]:
    """Each member with the smallest and the largest of each chart, and the crank's angles there."""
    rows: list[Mapping[str, object]] = []
    for k, (member, angle) in enumerate(zip(curves.members, curves.angles_deg, strict=True)):
        own = [chart.curves[k] for chart in curves.charts]
        ends = [(curve, at) for curve in own for at in (np.argmin(curve), np.argmax(curve))]
        cells = [(float(curve[at]), float(angle[at])) for curve, at in ends]
        rows.append({"member": member, "cells": cells})
    return rows
