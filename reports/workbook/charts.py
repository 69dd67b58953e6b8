"""Charts of a workbook, one below the other in a sheet of their own."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from openpyxl import Workbook  # type: ignore[import-untyped]  # ships no stubs
from openpyxl.chart import (  # type: ignore[import-untyped]  # as above
    Reference,
    ScatterChart,
    Series,
)
from openpyxl.worksheet.properties import (  # type: ignore[import-untyped]  # as above
    PageSetupProperties,
)

SHEET = "charts"
WIDE_CM, HIGH_CM, ROWS_EACH = 24.0, 9.0, 19


@dataclass(frozen=True)
class Curves:
    """Columns of a sheet by number, over the column ``over``, in rows below a head."""

    sheet: str
    over: int
    columns: Sequence[int]
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
    chart.x_axis.title, chart.x_axis.delete, chart.y_axis.delete = "time [s]", False, False
    chart.x_axis.tickLblPos, chart.legend.position = "low", "b"
    across = Reference(source, min_col=curves.over, min_row=2, max_row=last)
    for column in curves.columns:
        drawn = Reference(source, min_col=column, min_row=1, max_row=last)
        series = Series(drawn, across, title_from_data=True)
        series.marker.symbol, series.smooth = "none", False
        chart.series.append(series)
    sheet.add_chart(chart, f"A{1 + ROWS_EACH * number}")
