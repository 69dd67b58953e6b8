"""A log that is text: its separator, header and units are found, its numbers read."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import pyarrow as pa  # type: ignore[import-untyped]  # ships no types
import pyarrow.csv as pc  # type: ignore[import-untyped]  # ships no types

from models.errors import cut
from models.regular import UnreadableError
from reports.logs.extent import refuse_columns, refuse_rows
from reports.logs.spelling import spelled_unit

LOOK = 200_000
"""Bytes at the beginning in which the header, and what follows it, must stand."""
SEPARATORS = {"\t": "a tab", ";": "a semicolon", ",": "a comma", " ": "spaces"}
REMARKS = ("#", "%", "//")
NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?|[-+]?(nan|inf(inity)?)", re.I)
SEPARATOR = re.compile(r"sep=(.)", re.IGNORECASE)
"""The line that tells Excel."""
COMMA = re.compile(r"[-+]?\d+,\d+([eE][-+]?\d+)?")

DIGITS = re.compile(r"[-+]?\d+(e[-+]?\d+)?", re.IGNORECASE)
"""What is left of a number on either side of its decimal comma."""


@dataclass(frozen=True)
class Layout:
    """What a map says of a file: "" where it is to be found."""

    separator: str = ""
    decimal: str = "."
    sheet: str = ""


@dataclass(frozen=True)
class TextTable:
    """The table of a text, all names of its header, and the line that its first row stands in."""

    table: pa.Table
    names: Sequence[str]
    first: int


def text_columns(
    raw: bytes,
    layout: Layout,
    wanted: Callable[[str], bool] = lambda name: True,
) -> TextTable:
    """Read the ``wanted`` columns of a text with a header. Raises UnreadableError for what is no
    such text."""
    lines, offsets = _first_lines(raw)
    at = next(
        (n for n, line in enumerate(lines) if line.strip() and not line.startswith(REMARKS)), None
    )
    if at is None:
        raise UnreadableError("empty but for remarks; a log has a header and rows of numbers")
    told = SEPARATOR.fullmatch(lines[at])
    if told and at + 1 < len(lines):
        at += 1
    separator = layout.separator or (told[1] if told else "")
    header, below = lines[at], _next(lines, at + 1)
    if remark := _header_of_remark(lines, at, separator):
        header, below = remark, at
    separator = separator or _separator(header, lines[at + (header is lines[at]) :])
    names = _fields(header, separator)
    refuse_columns(len(names))
    # Some programs end all lines, the header as well, in a separator.
    ends = len(names) > 1 and not names[-1] and below is not None
    ends = ends and lines[below or 0].rstrip(" ").endswith(separator)
    _check_header(header, names[:-1] if ends else names, at)
    if below is None:
        raise UnreadableError("a header and no rows; a log has rows of numbers")
    units = _units(_fields(lines[below], separator), len(names))
    if units:
        names = [
            f"{name} [{unit}]" if unit else name for name, unit in zip(names, units, strict=True)
        ]
        below = _next(lines, below + 1)
        if below is None:
            raise UnreadableError("a header and units, and no rows; a log has rows of numbers")
    fields = _fields(lines[below], separator)
    _check_row(fields, names, below, separator, layout)
    pairs = zip(names, fields, strict=True)
    types = {
        name: pa.float64() if NUMBER.fullmatch(field) or COMMA.fullmatch(field) else None
        for name, field in pairs
        if wanted(name) or not name
    }
    body = memoryview(raw)[offsets[below] :]
    table = _table(body, names, types, separator, layout.decimal, below)
    if ends:
        table, names = _without_last(table, below, len(names)), names[:-1]
    return TextTable(table, names, below + 1)


def _next(lines: Sequence[str], at: int) -> int | None:
    """The first line from there on that is not blank."""
    return next((n for n in range(at, len(lines)) if lines[n].strip()), None)


def _header_of_remark(lines: Sequence[str], at: int, separator: str) -> str:
    """The last remark above numbers, as numpy writes a header, where it has a name for each; ""
    for none."""
    remarks = [line for line in lines[:at] if line.startswith(REMARKS)]
    if not remarks:
        return ""
    text = remarks[-1].lstrip("#%/ ")
    separator = separator or _separator(text, lines[at:])
    names, fields = _fields(text, separator), _fields(lines[at], separator)
    fits = len(names) == len(fields) and all(names) and not _are_numbers(names)
    return text if fits and _are_numbers(fields) else ""


def _without_last(table: pa.Table, below: int, place: int) -> pa.Table:
    """The table without the column behind the separator that ends all lines. Raises
    UnreadableError where something stands in it."""
    last = table.column("")
    if last.null_count < table.num_rows:
        cells = last.to_pylist()
        row = next((n for n, cell in enumerate(cells) if str(cell or "").strip()), None)
        if row is not None:
            raise UnreadableError(
                f"row {below + 1 + row}: found {cut(str(cells[row]), 40)!r} in column {place}, "
                "which has no name; give it one"
            )
    return table.drop_columns([""])


def _first_lines(raw: bytes) -> tuple[list[str], list[int]]:
    """The first lines, and the byte that each begins at. Raises UnreadableError for no text."""
    if raw[:2] in (b"\xff\xfe", b"\xfe\xff"):
        raise UnreadableError("UTF-16 text; save the file as UTF-8")
    mark = 3 if raw.startswith(b"\xef\xbb\xbf") else 0
    look = raw[mark : mark + LOOK]
    if b"\0" in look:
        raise UnreadableError("no text: it holds null bytes; the ending says what a file is")
    if b"\n" not in look and b"\r" in look:
        raise UnreadableError("lines end in \\r alone; save the file with \\n or \\r\\n")
    parts = look.split(b"\n")
    if len(raw) > mark + LOOK:
        parts.pop()  # cut somewhere in it
        if not parts:
            raise UnreadableError(f"its first line is longer than {LOOK} bytes")
    offsets, place = [], mark
    for part in parts:
        offsets.append(place)
        place += len(part) + 1
    try:
        return [part.decode("utf-8").rstrip("\r") for part in parts], offsets
    except UnicodeDecodeError:
        raise UnreadableError("not UTF-8 text; save the file as UTF-8") from None


def _separator(header: str, rest: Sequence[str]) -> str:
    """What stands between the fields: the first of tab, semicolon, comma and space that the header
    has, outside of brackets and quotes."""
    bare = re.sub(r'"[^"]*"|\[[^\]]*\]|\([^)]*\)', "", header)
    for separator in SEPARATORS:
        if separator in bare.strip():
            row = next((line for line in rest if line.strip()), "")
            # Names with spaces in a file of one column, or of a separator that comes next.
            if separator != " " or len(row.split()) == len(header.split()):
                return separator
    return ","


def _fields(line: str, separator: str) -> list[str]:
    """The fields of a line, quotes taken off."""
    if separator == " ":
        return line.split()
    found = re.findall(rf'(?:^|{re.escape(separator)})\s*("(?:[^"]|"")*"|[^{separator}]*)', line)
    return [_unquoted(field.strip()).strip() for field in found]


def _unquoted(field: str) -> str:
    """A field without its quotes; those in it are written twice."""
    if len(field) > 1 and field[0] == field[-1] == '"':
        return field[1:-1].replace('""', '"')
    return field


def _are_numbers(fields: Sequence[str]) -> bool:
    """Whether no field that is not blank is a name."""
    return all(NUMBER.fullmatch(field) or COMMA.fullmatch(field) for field in fields if field)


def _check_header(header: str, names: Sequence[str], at: int) -> None:
    """Refuse a header that names nothing. Raises UnreadableError."""
    if _are_numbers(names):
        raise UnreadableError(
            f"line {at + 1} holds numbers and no names; put a header above them, such as "
            "time_s,rocker_deg"
        )
    blank = next((n for n, name in enumerate(names) if not name), None)
    if blank is not None:
        raise UnreadableError(f"line {at + 1}: column {blank + 1} has no name; give it one")
    if header.count('"') % 2:
        raise UnreadableError(f"line {at + 1}: a quote that is not closed")


def _units(fields: Sequence[str], columns: int) -> list[str]:
    """The units of a row that holds nothing else, "" for a column without; none for other rows."""
    bare = [field.strip("[]() ") for field in fields]
    known = [spelled_unit(field) for field in bare]
    if len(bare) != columns or not any(known):
        return []
    if all(
        unit or field in ("", "-", "1", "none") for unit, field in zip(known, bare, strict=True)
    ):
        return [field if unit else "" for unit, field in zip(known, bare, strict=True)]
    return []


def _check_row(
    fields: Sequence[str], names: Sequence[str], at: int, separator: str, layout: Layout
) -> None:
    """Refuse a first row that does not fit the header. Raises UnreadableError."""
    pairs = len(fields) >= 2 * len(names) - 1 and separator == "," and len(names) > 1
    if pairs and all(DIGITS.fullmatch(field) for field in fields):
        raise UnreadableError(
            f"line {at + 1} has {len(fields)} fields, the header {len(names)}: decimal commas "
            "between commas; write decimal points, or separate the columns by semicolons"
        )
    if len(fields) != len(names):
        mark = SEPARATORS.get(separator, repr(separator))
        if len(fields) == len(names) + 1 and not fields[-1]:
            raise UnreadableError(
                f"line {at + 1} has {len(fields)} fields, the header {len(names)}: it ends in a "
                f"separator, {mark}, and the header does not; end both so, or neither"
            )
        raise UnreadableError(
            f"line {at + 1} has {len(fields)} fields, the header {len(names)}, separated by "
            f"{mark}; say separator in [file] of the map if "
            "that is another"
        )
    if layout.decimal == ".":
        for name, field in zip(names, fields, strict=True):
            if COMMA.fullmatch(field):
                raise UnreadableError(
                    f"row {at + 1}, column {cut(name)!r}: found {cut(field)!r}, a decimal comma; "
                    "write decimal points, or say decimal = ',' in [file] of the map"
                )


def _table(
    body: memoryview,
    names: Sequence[str],
    types: Mapping[str, pa.DataType | None],
    separator: str,
    decimal: str,
    below: int,
) -> pa.Table:
    """The rows of the columns that have ``types``, as a table; what is a number in the first row is
    taken for one, if it stays so. Raises UnreadableError for rows that do not fit, and for too
    many."""
    if separator == " ":
        text = re.sub(rb"[ \t]+", b" ", re.sub(rb"(?m)^[ \t]+|[ \t\r]+$", b"", bytes(body)))
        body = memoryview(text)
    refuse_rows(_count(body), len(types))
    misfits: list[str] = []

    def misfit(row: pc.InvalidRow) -> str:
        misfits.append(
            f"row {below + (row.number or 0)}: {row.actual_columns} fields, the header "
            f"{row.expected_columns}: {cut(row.text, 60)!r}"
        )
        return "error"

    def table(told: Mapping[str, pa.DataType]) -> pa.Table:
        return pc.read_csv(
            pa.BufferReader(pa.py_buffer(body)),
            read_options=pc.ReadOptions(
                column_names=list(names), use_threads=False, block_size=1 << 24
            ),
            parse_options=pc.ParseOptions(delimiter=separator, invalid_row_handler=misfit),
            convert_options=pc.ConvertOptions(
                column_types=told,
                include_columns=list(types),
                null_values=[""],
                strings_can_be_null=True,
                decimal_point=decimal,
                timestamp_parsers=[],
            ),
            memory_pool=pa.system_memory_pool(),
        )

    try:
        try:  # where a type is told, the text is let go block by block
            return table({name: each for name, each in types.items() if each is not None})
        except pa.ArrowInvalid:
            if misfits:
                raise
            return table({})
    except (pa.ArrowException, OSError, ValueError) as error:
        why = misfits[0] if misfits else cut(str(error).splitlines()[0], 200)
        raise UnreadableError(f"{why}; every row has as many fields as the header") from None


def _count(body: memoryview) -> int:
    """The number of lines."""
    count, step = 0, 1 << 24
    for first in range(0, len(body), step):
        count += bytes(body[first : first + step]).count(b"\n")
    return count + (len(body) > 0 and body[-1] != 10)
