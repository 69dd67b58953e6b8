"""The head of a text above its rows: separator, names of the columns, and their units."""

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from models.files.inputs import UnreadableError
from reports.logs.kinds import spelled_unit
from reports.logs.text_lines import (
    LOOK,
    Beginning,
    are_numbers,
    fields_of,
    is_number,
    is_remark,
    refuse_columns,
    separator_of,
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
    at = _required(text, 0, "empty but for remarks")
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
    """Return the last remark above numbers that has a name for each, as numpy writes a header, and
    the units in a remark below it, "" for none; None for no such remark."""
    units = ""
    for text in _remarks(lines[:at]):
        mark = separator or separator_of(text, lines[at])
        names, fields = fields_of(text, mark), fields_of(lines[at], mark)
        if len(names) != len(fields) or not all(names) or are_numbers(names):
            continue
        if not are_numbers(fields):
            return None
        if units or not _are_units(names):
            return text, units
        units = text
    return (units, "") if units else None


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
            more = ", or say separator = ' ' in [file] of the map if several tabs are one"
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
