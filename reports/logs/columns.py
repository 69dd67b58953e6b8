"""The columns of a log: read from a file of a bounded size, or taken from a frame."""

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from decimal import Decimal
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pyarrow as pa  # type: ignore[import-untyped]  # ships no types
import pyarrow.parquet as pq  # type: ignore[import-untyped]  # ships no types

from models.array import NO_NUMBERS, Array
from models.errors import CrankcheckError, cut, suggestion
from models.files.inputs import UnreadableError, regular_bytes
from reports.logs.map_file import FileTable
from reports.logs.text_lines import COMMA, is_number, refuse_columns, refuse_rows, row_line
from reports.logs.text_rows import text_columns
from reports.logs.workbook import plain, sheet_columns

ENDINGS = (".csv", ".tsv", ".txt", ".parquet", ".xlsx")
MOST_BYTES = 600_000_000
SPARSE = 0.2
"""Part of cells without a number from which on a column may be of another rate."""
ONE_FILE = "write a file for each, with its own times and rows, and judge one after the other"


@dataclass(frozen=True)
class Columns:
    """A log as in its file: columns by name, with any content.

    ``first`` is the place of the first row of numbers to a reader: its line in a file of text, its
    row in a sheet, 0 in a frame; ``passed`` are the lines from there on, by number, that are no
    rows. ``decimal`` is the decimal mark of numbers that are text.
    """

    source: str
    raw: Mapping[str, Any]
    first: int = 0
    passed: Array = field(default_factory=lambda: np.empty(0, dtype=np.int64))
    decimal: str = "."

    def numbers(self, name: str) -> Array:
        """Return a column as numbers, all of them finite. Raises CrankcheckError for a cell that is
        empty, NaN, infinite or no number; the message has its row. Also for durations and dates."""
        values = np.asarray(self.raw[name])
        if values.dtype.kind in "mM":  # which numpy would count in nanoseconds
            raise CrankcheckError(
                f"{self.source}, column {cut(name)!r}: found {NO_NUMBERS[values.dtype.kind]} "
                f"({values.dtype}); give floats, such as seconds"
            )
        if values.dtype.kind not in "iuf":
            values = self._parsed(name, values)
        found = values.astype(np.float64)
        bad = np.flatnonzero(~np.isfinite(found))
        if bad.size:
            row = int(bad[0])
            what = self.cell(name, row)
            cure = "fill it, cut the log there, or leave the column out ([[channel]] ignore = true)"
            if bad.size >= SPARSE * found.size:
                cure = f"if it has another rate or clock than the rest, {ONE_FILE}; else {cure}"
            more = f" ({bad.size} such cells)" if bad.size > 1 else ""
            raise CrankcheckError(f"{self.at(name, row)}: {what}{more}; {cure}")
        return found

    def exact(self, name: str, row: int) -> Decimal:
        """Return the number in a cell with all its digits."""
        cell = np.asarray(self.raw[name])[row : row + 1].tolist()[0]
        return Decimal(cell.strip().replace(",", ".") if isinstance(cell, str) else cell)

    def less(self, name: str, zero: Decimal) -> Array:
        """Return a column as numbers, like `numbers`, less a number that is subtracted before they
        are rounded: of a clock in nanoseconds since 1970 a float has but every 256th."""
        found, values = self.numbers(name), np.asarray(self.raw[name])
        if not zero:
            return found
        if values.dtype.kind == "f":
            return found - float(zero)
        if values.dtype.kind == "i":
            whole = int(zero)
            return np.asarray((values.astype(np.int64) - whole) - float(zero - whole))
        return np.array([float(self.exact(name, row) - zero) for row in range(found.size)])

    def require(self, asked: Iterable[str], where: str) -> None:
        """Refuse names in a map, at ``where``, that the log lacks. Raises CrankcheckError."""
        for name in asked:
            if name not in self.raw:
                hint = suggestion(name, self.raw, "it has") if len(self.raw) < 40 else ""
                raise CrankcheckError(
                    f"{where}: {cut(name)!r} is not in {self.source}; {hint or 'see its header'}"
                )

    def at(self, name: str, row: int) -> str:
        """Return the words for a cell."""
        line = self.first + row_line(self.passed, row)
        return f"{self.source}, row {line}, column {cut(name)!r}"

    def cell(self, name: str, row: int) -> str:
        """Return the content of a cell that is no finite number."""
        found = self.raw[name][row]
        return "the cell is empty" if _is_empty(found) else f"found {cut(str(found), 40)}"

    def _parsed(self, name: str, values: np.ndarray[Any, Any]) -> Array:
        """Return cells that are not all numbers as numbers; NaN for empty ones."""
        found = np.empty(values.shape[0])
        for row, cell in enumerate(values.tolist()):
            if _is_empty(cell):
                found[row] = np.nan
                continue
            try:
                if isinstance(cell, bool) or not isinstance(cell, int | float | str):
                    raise ValueError
                found[row] = written_number(cell, self.decimal) if isinstance(cell, str) else cell
            except (ValueError, OverflowError):
                text = cell if isinstance(cell, str) else ""
                raise CrankcheckError(
                    f"{self.at(name, row)}: found {cut(repr(cell), 40)}, not a number; "
                    f"{cure_of(text, self.decimal)}"
                ) from None
        return found


def _is_empty(cell: object) -> bool:
    return cell is None or cell is pd.NA or (isinstance(cell, str) and not cell.strip())


def read_columns(
    path: Path, layout: FileTable | None = None, wanted: Callable[[str], bool] = lambda name: True
) -> Columns:
    """Read the columns of a log: text with a header (.csv, .tsv, .txt; the separator is found),
    .parquet or .xlsx, in the ``layout`` of the user's map. Columns of a text whose names are not
    ``wanted`` are not read, and only named.

    Raises CrankcheckError for no plain file, one of another kind or too large, a damaged or empty
    one, two columns of one name.
    """
    layout = layout or FileTable()
    ending = path.suffix.lower()
    if ending not in ENDINGS:
        found = repr(ending) if ending else "no ending"
        raise CrankcheckError(f"log {path}: found {found}; use {', '.join(ENDINGS)}")
    try:
        raw = regular_bytes(path, MOST_BYTES)
        if not raw:
            raise UnreadableError("empty; a log has a header and rows of numbers")
        if ending == ".parquet":
            table, every = _parquet(raw, wanted)
            return _named(_of_table(str(path), [table]), every, path)
        if ending == ".xlsx":
            names, cells, first = sheet_columns(raw, layout.sheet)
            _refuse_twins(names, f"log {path}")
            by_name = dict(zip(names, cells, strict=True))
            return Columns(str(path), by_name, first, decimal=layout.decimal)
        *tables, names, first, passed = text_columns(raw, layout, wanted)
        del raw
        columns = _named(_of_table(str(path), tables, first), names, path)
        return replace(columns, passed=passed, decimal=layout.decimal)
    except UnreadableError as error:
        raise CrankcheckError(f"log {path}: {error}") from None


def _named(columns: Columns, names: Sequence[str], path: Path) -> Columns:
    """Return the columns with all names of a file, including columns not read."""
    _refuse_twins(names, f"log {path}")
    return replace(columns, raw={name: columns.raw.get(name, ()) for name in names})


def columns_of(frame: pd.DataFrame, source: str = "the frame") -> Columns:
    """Return the columns of a pandas frame. Raises CrankcheckError for repeated names."""
    names = [str(name) for name in frame.columns]
    _refuse_twins(names, source)
    raw = {name: frame.iloc[:, at].to_numpy() for at, name in enumerate(names)}
    return Columns(source, raw)


def _of_table(source: str, tables: list[pa.Table], first: int = 1) -> Columns:
    """Return the columns of the one arrow table in a list, which is removed from it: each column is
    freed as soon as it is an array, as a long log would be in memory twice. Text stays text."""
    table = tables.pop()
    names = [str(name) for name in table.column_names]
    if table.num_rows == 0:
        raise UnreadableError("a header and no rows; a log has rows of numbers")
    parts = table.columns[::-1]
    del table
    raw = {name: _values(parts.pop()) for name in names}
    return Columns(source, raw, first)


def _values(column: pa.ChunkedArray) -> Any:
    """Return numbers as an array; null values and other kinds as objects."""
    if pa.types.is_floating(column.type) or pa.types.is_integer(column.type):
        if column.null_count:
            return np.array(column.to_pylist(), dtype=object)
        # In numpy's memory, which goes back to the system; arrow keeps its own.
        return np.concatenate([chunk.to_numpy() for chunk in column.chunks])
    return np.array([plain(cell) for cell in column.to_pylist()], dtype=object)


def _refuse_twins(names: Sequence[str], source: str) -> None:
    seen = set[str]()
    for name in names:
        if name in seen:
            raise CrankcheckError(
                f"{source}: two columns are called {cut(name)!r}; give each a name of its own"
            )
        seen.add(name)


def _parquet(raw: bytes, wanted: Callable[[str], bool]) -> tuple[pa.Table, list[str]]:
    """Return the wanted columns of a Parquet file, counted before they are read, and all names."""
    try:
        file = pq.ParquetFile(pa.BufferReader(raw))
        rows, names = file.metadata.num_rows, list(file.schema_arrow.names)
        refuse_columns(len(names))
        chosen = [name for name in names if wanted(name)]
        refuse_rows(rows, len(chosen))
        return file.read(columns=chosen or names[:1]), names
    except (pa.ArrowException, OSError, ValueError) as error:
        raise UnreadableError(
            f"not readable as Parquet: {cut(str(error).splitlines()[0], 200)}"
        ) from None


FORTRAN = re.compile(r"[-+]?[\d.]+d[-+]?\d+", re.IGNORECASE)
"""A double of Fortran: 1.5D-3."""
CLOCK = re.compile(r"(\d+ days?, )?\d+:\d\d.*|\d{2,4}[-./]\d\d?[-./]\d\d?.*")
"""An hour, or a date: 00:00:01, 2026-01-01."""
THOUSANDS = re.compile(r"[-+]?\d{1,3}(?:[ ,.'\u2019]\d{3})+(?:[.,]\d*)?")
"""Digits in groups of three: 1,000.5."""


def written_number(text: str, decimal: str) -> float:
    """Return a text as a number, with that decimal mark. Raises ValueError for none."""
    if decimal == ",":
        if "." in text:
            raise ValueError
        text = text.replace(",", ".")
    if "_" in text:  # which Python takes for a number
        raise ValueError
    return float(text)


def cure_of(text: str, decimal: str) -> str:
    """Return advice to make a text a number."""
    text = text.strip()
    if COMMA.fullmatch(text) and decimal == ".":
        return "write decimal points, or set decimal = ',' in [file] of the map"
    if THOUSANDS.fullmatch(text):
        return "write numbers without marks between the thousands"
    if "." in text and decimal == "," and is_number(text):
        return "write a decimal comma, as the map has decimal = ','"
    if FORTRAN.fullmatch(text):
        return "write e for the d of the exponent"
    if CLOCK.fullmatch(text):
        return "write seconds from the start on"
    return "write numbers alone, or leave the column out ([[channel]] ignore = true)"
