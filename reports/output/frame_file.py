"""A table as a file of the kind that its ending says: CSV, Parquet, a workbook; with all digits."""

from __future__ import annotations

import io
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from reports.output.provenance import crankcheck_version
from reports.output.write import clean, write

if TYPE_CHECKING:
    import pandas as pd  # a third of a second: not for what is only shown

ENDINGS = (".csv", ".parquet", ".xlsx")
SHEET_ROWS = 1_048_575
"""Rows of a sheet below its head."""


def write_frame(
    path: Path,
    frame: pd.DataFrame,
    sheet: str,
    origin: Mapping[str, str],
    more: Callable[[Any], None] | None = None,
) -> None:
    """Write a table whole, or not at all.

    A workbook has it in ``sheet``, and beside it where it comes from, and what ``more`` puts into
    the openpyxl workbook; the other kinds have no room for that. Raises CrankcheckError where the
    system refuses.
    """
    ending = path.suffix.lower()
    if ending == ".csv":
        write(path, csv(frame))
    elif ending == ".parquet":
        write(path, parquet(frame))
    else:
        write(path, workbook(frame, sheet, origin, more))


def csv(frame: pd.DataFrame) -> str:
    """The text of a CSV file that holds the frame, without its index."""
    return frame.to_csv(index=False, lineterminator="\n")


def parquet(frame: pd.DataFrame) -> bytes:
    """The content of a Parquet file that holds the frame, without its index."""
    buffer = io.BytesIO()
    frame.to_parquet(buffer, index=False)
    return buffer.getvalue()


def workbook(
    frame: pd.DataFrame,
    sheet: str,
    origin: Mapping[str, str],
    more: Callable[[Any], None] | None = None,
) -> bytes:
    """The content of a workbook: the frame, where it comes from, and what ``more`` puts into it."""
    facts = {**origin, "crankcheck": crankcheck_version()}
    buffer = io.BytesIO()
    import pandas as pd

    with pd.ExcelWriter(buffer, engine="openpyxl") as book:
        shown = frame.rename(columns=clean)
        shown.to_excel(book, sheet_name=sheet, index=False, freeze_panes=(1, 1))
        about = pd.DataFrame({"what": list(facts), "value": [clean(v) for v in facts.values()]})
        about.to_excel(book, sheet_name="source", index=False)
        for row in book.sheets[sheet].iter_rows(min_row=2):
            for cell in row:
                if isinstance(cell.value, float):
                    # openpyxl would leave out the 17th digit; the kind stays that of a number.
                    cell._value = repr(float(cell.value))
        for row in book.sheets["source"].iter_rows():
            for cell in row:
                cell.data_type = "s"  # a text that begins with "=" is no formula
        if more is not None:
            more(book.book)
    return buffer.getvalue()
