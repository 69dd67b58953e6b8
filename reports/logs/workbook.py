"""A log in a sheet of a workbook: its header, the units below it, and its cells."""

import io
import warnings
import zipfile
from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd

from models.errors import cut, few, suggestion
from models.files.inputs import UnreadableError
from reports.logs import text_lines

MOST_SHEET_BYTES = 400_000_000
"""Limit of an unpacked workbook."""
MOST_CELLS = 20_000_000
"""Limit of a sheet, from the first cell to the last."""


SheetTable = tuple[Sequence[str], Sequence[Any], int]
"""The names and columns of a sheet, and the row of its first numbers."""


def sheet_columns(raw: bytes, asked: str) -> SheetTable:
    """Read the ``asked`` sheet, or the first. Raises UnreadableError for no log in it."""
    try:
        with zipfile.ZipFile(io.BytesIO(raw)) as packed:
            unpacked = sum(each.file_size for each in packed.infolist())
        if unpacked > MOST_SHEET_BYTES:
            raise UnreadableError(
                f"{unpacked} bytes when it is unpacked; at most {MOST_SHEET_BYTES} are read: "
                "save it as CSV"
            )
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of styles and the like, which are not read
            book = pd.ExcelFile(io.BytesIO(raw), engine="openpyxl")
            sheets = [str(name) for name in book.sheet_names]
            if asked and asked not in sheets:
                hint = suggestion(asked, sheets, "the sheets are")
                raise UnreadableError(f"no sheet {asked!r}; {hint}")
            name = asked or sheets[0]
            rows = _rows(book.book[name])
    except UnreadableError:
        raise
    except Exception as error:  # whatever a damaged archive makes of its reader
        why = cut(f"{type(error).__name__}: {error}".splitlines()[0], 200)
        raise UnreadableError(f"not readable as a workbook: {why}") from None
    try:
        return _of_rows(rows)
    except UnreadableError as error:
        at = sheets.index(name)
        others, which = [*sheets[at + 1 :], *sheets[:at]], ""
        if others:
            which = (
                f"; if the log is another, as {few(others, 8)}, set sheet = {others[0]!r} in [file]"
            )
        raise UnreadableError(f"sheet {name!r}{error}{which}") from None


def _rows(sheet: Any) -> list[Sequence[object]]:
    """Return the rows of a sheet, each up to its last cell that is not empty. Raises
    UnreadableError where cells are far apart: a table is as long and wide as the last of them,
    whatever size the file states."""
    sheet.reset_dimensions()
    rows: list[Sequence[object]] = []
    for row in sheet.iter_rows(values_only=True):
        last = max((at for at, cell in enumerate(row) if cell is not None), default=-1)
        rows.append(row[: last + 1])
    while rows and not rows[-1]:
        rows.pop()
    wide = max(map(len, rows), default=0)
    text_lines.refuse_columns(wide)
    text_lines.refuse_rows(len(rows), 1)
    if len(rows) * wide > MOST_CELLS:
        raise UnreadableError(
            f"cells up to row {len(rows)} and column {wide}; at most {MOST_CELLS} are read: clear "
            "those that are far away, or save the sheet as CSV"
        )
    return rows


def _of_rows(rows: list[Sequence[object]]) -> SheetTable:
    """Return the columns of a sheet whose first row that is not empty is the header. Raises
    UnreadableError, whose message continues after the name of the sheet."""
    at = next((n for n, row in enumerate(rows) if row), None)
    if at is None:
        raise UnreadableError(" is empty; a log has a header and rows of numbers")
    wide = max(map(len, rows))
    names = _row_texts(rows[at], wide)
    blank = next((n for n, name in enumerate(names) if not name), None)
    if blank is not None:
        raise UnreadableError(
            f": column {blank + 1} has no name in row {at + 1}; that row holds the names of the "
            "columns: clear what stands above them, or beside"
        )
    if text_lines.are_numbers(names):
        raise UnreadableError(
            f": row {at + 1} holds numbers and no names; put a header above them, such as time_s "
            "and rocker_deg"
        )
    first = at + 1
    if first < len(rows) and (units := text_lines.units_below(_row_texts(rows[first], wide), wide)):
        names, first = text_lines.with_units(names, units), first + 1
    if first == len(rows):
        raise UnreadableError(": a header and no rows; a log has rows of numbers")
    text_lines.refuse_rows(len(rows) - first, wide)
    cells = ([row[n] if n < len(row) else None for row in rows[first:]] for n in range(wide))
    columns = [np.array([plain(cell) for cell in each], dtype=object) for each in cells]
    return names, columns, first + 1


def _row_texts(row: Sequence[object], wide: int) -> list[str]:
    found = ["" if cell is None else str(cell).strip() for cell in row]
    return found + [""] * (wide - len(found))


def plain(cell: object) -> object:
    """Return a cell; as text if it is neither a number nor text."""
    return cell if cell is None or isinstance(cell, str | int | float | bool) else str(cell)
