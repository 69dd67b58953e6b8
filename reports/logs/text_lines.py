"""The lines of a text and their fields, and the largest readable log."""

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from models.array import Array
from models.files.inputs import UnreadableError

LOOK = 200_000
"""Bytes at the beginning that must hold the header and the first row."""
REMARKS = ("#", "%", "//")
PASSED = re.compile(rb"\n[ \t]*(?:\r*(?=\n|\Z)|(?:#|%|//)[^\n]*)")
"""A line that is blank or a remark, with the line end before it."""


@dataclass(frozen=True)
class Beginning:
    """The first lines of a text, the first byte of each, and whether they are all of it."""

    lines: Sequence[str]
    offsets: Sequence[int]
    whole: bool


@dataclass(frozen=True)
class Body:
    """The text of the rows, and the numbers of skipped lines, from the first row on."""

    text: memoryview
    passed: Array


def row_line(passed: Array, row: int) -> int:
    """Return the line of a row, both counted from the first row; some lines are ``passed``."""
    rows_before = passed - np.arange(passed.size)
    return row + int(np.searchsorted(rows_before, row, side="right"))


def is_remark(line: str) -> bool:
    """True if a line is a remark."""
    return line.lstrip().startswith(REMARKS)


def beginning(raw: bytes) -> Beginning:
    """Return the first lines of a text. Raises UnreadableError for no text."""
    if raw[:2] in (b"\xff\xfe", b"\xfe\xff"):
        raise UnreadableError("UTF-16 text; save the file as UTF-8")
    mark = 3 if raw.startswith(b"\xef\xbb\xbf") else 0
    look = raw[mark : mark + LOOK]
    if b"\0" in look:
        raise UnreadableError("no text: it holds null bytes; the ending says what a file is")
    if b"\n" not in look and b"\r" in look:
        raise UnreadableError("lines end in \\r alone; save the file with \\n or \\r\\n")
    parts = look.split(b"\n")
    whole = len(raw) <= mark + LOOK
    if not whole:
        parts.pop()  # cut somewhere in it
        if not parts:
            raise UnreadableError(f"its first line is longer than {LOOK} bytes")
    offsets, place = [], mark
    for part in parts:
        offsets.append(place)
        place += len(part) + 1
    try:
        lines = [part.decode("utf-8").rstrip("\r") for part in parts]
    except UnicodeDecodeError:
        raise UnreadableError("not UTF-8 text; save the file as UTF-8") from None
    return Beginning(lines, offsets, whole)


def body(raw: bytes, start: int, is_row: Callable[[str], bool]) -> Body:
    """Return the rows of a text from a byte on, without lines that are blank or remarks. A line
    within a quoted field is no remark, nor is a row by ``is_row``."""
    passed: list[int] = []
    kept: list[memoryview] = []
    view = memoryview(raw)
    at, counted, line, quotes = start, start, 0, 0
    for hit in PASSED.finditer(raw, start):
        first, last = hit.span()
        line += raw.count(b"\n", counted, first)
        quotes += raw.count(b'"', counted, first)
        counted = first
        words = raw[first:last].strip()
        if quotes % 2 or (words and is_row(words.decode("utf-8", "replace"))):
            continue
        line, counted = line + 1, last  # its own quotes are none
        passed.append(line)
        if raw[first:last].strip(b"\r\n"):  # arrow passes over lines with nothing in them itself
            kept.append(view[at:first])
            at = last
    kept.append(view[at:])
    parts = [part for part in kept if len(part)]
    text = parts[0] if len(parts) == 1 else memoryview(b"".join(parts))
    return Body(text, np.asarray(passed, dtype=np.int64))


SEPARATORS = {"\t": "a tab", ";": "a semicolon", ",": "a comma", " ": "spaces"}
NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?|[-+]?(nan|inf(inity)?)", re.I)
COMMA = re.compile(r"[-+]?\d+,\d+([eE][-+]?\d+)?")
"""A number with a decimal comma."""
SPACED = re.compile(
    r"""[\[(][^\[\]()]*[\])] | "(?:[^"]|"")*" | [^\s"\[(]\S*(?:[ ]+[\[(][^\[\]()]*[\])])?""", re.X
)
"""A field between spaces: a unit in brackets belongs to the name before it."""


def separator_of(header: str, row: str) -> str:
    """Return the separator of the fields: the first of tab, semicolon, comma and space in the
    header, outside of brackets and quotes; spaces where ``row`` has as many fields between them."""
    bare = re.sub(r'"[^"]*"|\[[^\]]*\]|\([^)]*\)', "x", header).strip()
    for separator in SEPARATORS:
        # Names with spaces in a file of one column, or of a separator that comes next.
        if separator in bare and (
            separator != " " or len(fields_of(row, " ")) == len(fields_of(header, " "))
        ):
            return separator
    return ","


def fields_of(line: str, separator: str) -> list[str]:
    """Return the fields of a line, without quotes."""
    if separator == " ":
        return [_unquoted(field) for field in SPACED.findall(line)]
    mark = re.escape(separator)
    found = re.findall(rf'(?:^|{mark})[^\S{mark}]*("(?:[^"]|"")*"|[^{mark}]*)', line)
    return [_unquoted(field.strip()).strip() for field in found]


def _unquoted(field: str) -> str:
    """Return a field without its quotes; those in it are written twice."""
    if len(field) > 1 and field[0] == field[-1] and field[0] in "\"'":
        return field[1:-1].replace(field[0] * 2, field[0])
    return field


def is_number(field: str) -> bool:
    """True if a field is a number, with a decimal point or comma."""
    return bool(NUMBER.fullmatch(field) or COMMA.fullmatch(field))


def are_numbers(fields: Sequence[str]) -> bool:
    """True if all fields are blank or numbers."""
    return all(is_number(field) for field in fields if field)


MOST_ROWS = 2_000_000
"""Ten hours of samples at 60 Hz, half an hour at 1 kHz; judging them takes seconds."""
MOST_COLUMNS = 2_000
MOST_NUMBERS = 80_000_000
"""Numbers in columns with a meaning."""


def refuse_columns(columns: int) -> None:
    """Raise UnreadableError for more columns than are examined."""
    if columns > MOST_COLUMNS:
        raise UnreadableError(
            f"{columns} columns; at most {MOST_COLUMNS} are read: leave out what is not of the "
            "mechanism"
        )


def refuse_rows(rows: int, columns: int) -> None:
    """Raise UnreadableError for more rows, or more numbers in the columns read, than allowed."""
    if rows > MOST_ROWS:
        raise UnreadableError(
            f"{rows} rows; at most {MOST_ROWS} are read: cut the log, or keep every n-th row"
        )
    if rows * columns > MOST_NUMBERS:
        raise UnreadableError(
            f"{rows} rows of {columns} columns; at most {MOST_NUMBERS} numbers are read: keep "
            "every n-th row, or fewer columns"
        )
