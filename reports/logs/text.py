"""A log that is text: its separator, header and units are found, its numbers read."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import pyarrow as pa  # type: ignore[import-untyped]  # ships no types

from models.array import Array
from reports.logs.text_fields import fields_of
from reports.logs.text_header import header_of, marked_rows
from reports.logs.text_lines import beginning, body
from reports.logs.text_rows import RowReader


@dataclass(frozen=True)
class Layout:
    """What a map says of a file: "" where it is to be found."""

    separator: str = ""
    decimal: str = "."
    sheet: str = ""


@dataclass(frozen=True)
class TextTable:
    """The table of a text, all names of its header, the line that its first row stands in, and of
    the lines from there on those that are no rows."""

    table: pa.Table
    names: Sequence[str]
    first: int
    passed: Array


def text_columns(
    raw: bytes,
    layout: Layout,
    wanted: Callable[[str], bool] = lambda name: True,
) -> TextTable:
    """Read the ``wanted`` columns of a text with a header; lines that are blank or remarks are
    passed over wherever they stand. Raises UnreadableError for what is no such text."""
    start = beginning(raw)
    header = header_of(start, layout.separator, wanted)
    names = header.names
    is_row = marked_rows(names, header.separator, wanted)
    below = body(raw, start.offsets[header.first], is_row)
    fields = fields_of(start.lines[header.first], header.separator)
    table = RowReader(header, below, layout.decimal).table(fields, wanted)
    kept = names[:-1] if header.ends else names
    return TextTable(table, kept, header.first + 1, below.passed)
