"""Charts of a workbook, one below the other in a sheet of their own."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from openpyxl import Workbook  # type: ignore[import-untyped]  # ships no stubs  # type: ignore[import-untyped]  # ships no stubs
from openpyxl.chart import (  # type: ignore[import-untyped]  # as above
    Reference,
    ScatterChart,
    Series,
)
from openpyxl.chart.axis import ChartLines  # type: ignore[import-untyped]  # as above
from openpyxl.chart.shapes import GraphicalProperties  # type: ignore[import-untyped]  # as above
from openpyxl.drawing.line import LineProperties  # type: ignore[import-untyped]  # as above
from openpyxl.worksheet.properties import (  # type: ignore[import-untyped]  # as above
    PageSetupProperties,
)

SHEET = "charts"
WIDE_CM, HIGH_CM, ROWS_EACH = 24.0, 9.0, 19
GRID, LINE_EMU = "D9DDE3", 15875
"""Colour of the lines of a grid, and width of a curve, 1.25 pt."""


@dataclass(frozen=True)
class Curves:
    """Pairs of columns of a sheet by number, across and up, in rows below a head."""

    sheet: str
    pairs: Sequence[tuple[int, int]]
    rows: int


def _on_one_page(sheet: Any) -> Any:
    """The sheet, set to be printed on one page."""
    sheet.sheet_properties.pageSetUpPr = PageSetupProperties(fitToPage=True)
    return sheet


def add_chart(book: Workbook, number: int, title: str, curves: Curves) -> None:
    """The chart below ``number`` others."""
    sheet = book[SHEET] if SHEET in book.sheetnames else _on_one_page(book.create_sheet(SHEET))
    source, last = book[curves.sheet], curves.rows + 1
    chart = ScatterChart()
    chart.title, chart.style, chart.scatterStyle = title, 2, "lineMarker"
    chart.width, chart.height = WIDE_CM, HIGH_CM
    chart.x_axis.title, chart.legend.position = "time [s]", "b"
    for axis in (chart.x_axis, chart.y_axis):
        axis.delete, axis.tickLblPos = False, "low"
        axis.number_format = "General"  # its own, and not the many digits of the cells
        axis.numFmt.sourceLinked = False
        grey = GraphicalProperties(ln=LineProperties(solidFill=GRID))
        axis.majorGridlines = ChartLines(spPr=grey)
    for over, up in curves.pairs:
        across = Reference(source, min_col=over, min_row=2, max_row=last)
        drawn = Reference(source, min_col=up, min_row=1, max_row=last)
        series = Series(drawn, across, title_from_data=True)
        series.marker.symbol, series.smooth = "none", False
        series.graphicalProperties.line.width = LINE_EMU
        chart.series.append(series)
    sheet.add_chart(chart, f"A{1 + ROWS_EACH * number}")


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
