"""The lines of a text and their fields, the largest readable log, and the head above the rows."""

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from models.array import Array
from models.files.inputs import UnreadableError
from reports.logs.kinds import spelled_unit

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


def row_line(passed: Array, row: int) -> int:
    """Return the line of a row, both counted from the first row; some lines are ``passed``."""
    rows_before = passed - np.arange(passed.size)
    return row + int(np.searchsorted(rows_before, row, side="right"))


def is_remark(line: str) -> bool:
    """True if a line is a remark."""
    return line.lstrip().startswith(REMARKS)


def beginning(raw: bytes) -> Beginning:
    """Return the first lines of a text. Raises UnreadableError for no text."""
    mark = 3 if raw.startswith(b"\xef\xbb\xbf") else 0
    look = raw[mark : mark + LOOK]
    if b"\0" in look:
        raise UnreadableError(
            "not a text: it holds null bytes; give the file the ending of its format"
        )
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


def body(raw: bytes, start: int, is_row: Callable[[str], bool]) -> tuple[memoryview, Array]:
    """Return the rows of a text from a byte on, without lines that are blank or remarks, and the
    numbers of these lines, from the first row on. A line within a quoted field is no remark, nor is
    a row by ``is_row``."""
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
    return text, np.asarray(passed, dtype=np.int64)


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
            f"{columns} columns; at most {MOST_COLUMNS} are read: leave out those of other things"
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


EXCEL = re.compile(r"sep=(.)", re.IGNORECASE)
"""The line that sets the separator in Excel."""
UNITLESS = ("", "-", "1", "none")
TITLE = "put # before a title that stands above the header"
IsRow = Callable[[str], bool]


@dataclass(frozen=True)
class Header:
    """The names of the columns with the units below them, the separator, and the first line of
    numbers; ``ends`` where all lines end in an extra separator."""

    names: Sequence[str]
    separator: str
    first: int
    ends: bool


def marked_rows(names: Sequence[str], separator: str, wanted: Callable[[str], bool]) -> IsRow:
    """Return a test of lines that begin as a remark: a row has as many fields as there are names,
    the first in an unwanted column, such as #1."""
    if not names or wanted(names[0]):
        return lambda line: False
    return lambda line: len(fields_of(line, separator)) == len(names)


def header_of(text: Beginning, separator: str, wanted: Callable[[str], bool]) -> Header:
    """Return the header of a text; a ``separator`` "" is found here. Raises UnreadableError for a
    header without names, and where no row follows."""
    lines = text.lines
    at = _required(text, 0, "empty except remarks")
    if told := EXCEL.fullmatch(lines[at]):
        separator = separator or told[1]
        at = _required(text, at + 1, "no header")
    in_remarks = _header_in_remarks(lines, at, separator)
    header, units = in_remarks or (lines[at], "")
    below = at if in_remarks else _next(lines, at + 1)
    row = "" if below is None else lines[below]
    separator = separator or separator_of(header, row)
    names = fields_of(header, separator)
    refuse_columns(len(names))
    # Some programs end all lines, the header as well, in a separator.
    ends = len(names) > 1 and not names[-1] and row.rstrip(" ").endswith(separator)
    _refuse_missing_names(header, names[:-1] if ends else names, at, separator)
    is_row = marked_rows(names, separator, wanted)
    if not in_remarks:
        below = _required(text, at + 1, "a header and no rows", is_row)
        units = _units_remark(lines[at + 1 : below], len(names), separator)
    assert below is not None
    units_told = units_below(fields_of(lines[below], separator), len(names))
    if units_told:
        below = _required(text, below + 1, "a header and units, and no rows", is_row)
    elif units:
        units_told = units_below(fields_of(units, separator), len(names))
    _refuse_bad_row(lines, at, below, separator)
    return Header(with_units(names, units_told), separator, below, ends)


def with_units(names: Sequence[str], units: Sequence[str]) -> list[str]:
    """Return names with the units in a row below them, if any."""
    if not units:
        return list(names)
    pairs = zip(names, units, strict=True)
    return [f"{name} [{unit}]" if unit else name for name, unit in pairs]


def units_below(fields: Sequence[str], columns: int) -> list[str]:
    """Return the units in a row of words, some of them known, "" for none; [] for another row."""
    bare = [field.strip("[]() ") for field in fields]
    words = [field for field in bare if field not in UNITLESS]
    if len(bare) != columns or not any(map(spelled_unit, words)) or any(map(is_number, words)):
        return []
    return ["" if field in UNITLESS else field for field in bare]


def _next(lines: Sequence[str], at: int, is_row: IsRow = lambda line: False) -> int | None:
    """Return the first line from there on that is neither blank nor a remark."""
    for n in range(at, len(lines)):
        if lines[n].strip() and (not is_remark(lines[n]) or is_row(lines[n])):
            return n
    return None


def _required(text: Beginning, at: int, found: str, is_row: IsRow = lambda line: False) -> int:
    """Return the next line of the log from there on. Raises UnreadableError where there is none."""
    below = _next(text.lines, at, is_row)
    if below is None and not text.whole:
        raise UnreadableError(
            f"{found} within the first {LOOK} bytes; the header and a row have to stand there: "
            "leave out remarks, or columns"
        )
    if below is None:
        raise UnreadableError(f"{found}; a log has a header and rows of numbers")
    return below


def _remarks(lines: Sequence[str]) -> list[str]:
    """Return the text of the remarks of some lines, the last one first."""
    return [line.lstrip("#%/ \t") for line in reversed(lines) if is_remark(line)]


def _are_units(fields: Sequence[str]) -> bool:
    bare = [field.strip("[]() ") for field in fields]
    return any(map(spelled_unit, bare)) and all(f in UNITLESS or spelled_unit(f) for f in bare)


def _header_in_remarks(lines: Sequence[str], at: int, separator: str) -> tuple[str, str] | None:
    """Return the last remark above a row that has a name for each cell, as numpy writes a header,
    and the units in a remark below it, "" for none; None for no such remark."""
    units = ""
    for text in _remarks(lines[:at]):
        mark = separator or separator_of(text, lines[at])
        names, fields = fields_of(text, mark), fields_of(lines[at], mark)
        if len(names) != len(fields) or not all(names) or are_numbers(names):
            continue
        if not are_numbers(fields) and not _goes_on(lines, at, mark):
            return None
        if units or not _are_units(names):
            return text, units
        units = text
    return (units, "") if units else None


def _goes_on(lines: Sequence[str], at: int, separator: str) -> bool:
    """True if a line is a row with words in it, such as a message with a name, and no header: most
    of its cells are numbers, or it has some, and one is empty or its words are in the columns of
    those in the line below."""
    below = _next(lines, at + 1)
    fields = fields_of(lines[at], separator)
    count = sum(map(is_number, fields))
    if below is None or not count:
        return False
    pairs = zip(fields, fields_of(lines[below], separator), strict=False)
    alike = all(is_number(field) == is_number(other) for field, other in pairs if other)
    return alike or not all(fields) or 2 * count > len(fields)


def _units_remark(lines: Sequence[str], columns: int, separator: str) -> str:
    """Return the remark between the header and the rows that has the units, "" for none."""
    for text in _remarks(lines):
        fields = fields_of(text, separator)
        if len(fields) == columns and _are_units(fields):
            return text
    return ""


def _refuse_missing_names(header: str, names: Sequence[str], at: int, separator: str) -> None:
    if are_numbers(names):
        raise UnreadableError(
            f"line {at + 1} holds numbers and no names; put a header above them, such as "
            "time_s,rocker_deg"
        )
    blank = next((n for n, name in enumerate(names) if not name), None)
    if blank is not None:
        more = ""
        if separator == "\t":
            more = ", or set separator = ' ' in [file] of the map if several tabs are one"
        raise UnreadableError(f"line {at + 1}: column {blank + 1} has no name; give it one{more}")
    if header.count('"') % 2:
        raise UnreadableError(f"line {at + 1}: a quote that is not closed")


def _refuse_bad_row(lines: Sequence[str], at: int, below: int, separator: str) -> None:
    fields = [field for field in fields_of(lines[below], separator) if field]
    if fields and all(field[0].isalpha() and not is_number(field) for field in fields):
        raise UnreadableError(
            f"line {below + 1} holds words and no numbers, below the names in line {at + 1}: a log "
            f"has one line of names, and below it one of units at most; join them, or {TITLE}"
        )
    parts = lines[below].split()
    if len(fields) == 1 and len(parts) > 1 and are_numbers(parts):
        raise UnreadableError(
            f"line {below + 1} has {len(parts)} numbers between spaces, and line {at + 1} not as "
            "many names between spaces; separate both by commas"
        )
