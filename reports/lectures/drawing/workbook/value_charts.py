"""Charts of a sheet of values: angles, rates and accelerations of links and sliders over time."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from openpyxl import Workbook  # type: ignore[import-untyped]  # ships no stubs

from reports.lectures.drawing.workbook.charts import Curves, add_chart

KINDS = (
    ("angles of links [rad]", "_theta_rad"),
    ("angular velocities [rad/s]", "_omega_rad_s"),
    ("angular accelerations [rad/s^2]", "_alpha_rad_s2"),
    ("displacements of sliders [m]", "_displacement_m"),
    ("speeds of sliders [m/s]", "_speed_m_s"),
    ("accelerations of sliders [m/s^2]", "_acceleration_m_s2"),
)
MOST_CURVES = 8
MARGIN, NARROWEST = 2, 12
"""Of the width of a column over that of its head, and the smallest [characters]."""


def add_value_charts(book: Workbook, sheet: str, columns: Sequence[str], rows: int) -> None:
    """A chart for each kind of column that the sheet has, over its first."""
    number = 0
    for title, ending in KINDS:
        places = [k for k, name in enumerate(columns, 1) if name.endswith(ending)]
        if places:
            pairs = [(1, place) for place in places[:MOST_CURVES]]
            add_chart(book, number, title, Curves(sheet, pairs, rows))
            number += 1


def widen(sheet: Any) -> None:
    """Columns as wide as their heads."""
    for cell in sheet[1]:
        width = max(len(str(cell.value)) + MARGIN, NARROWEST)
        sheet.column_dimensions[cell.column_letter].width = width
