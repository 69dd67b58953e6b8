"""The rows of a text below its header, read as numbers."""

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import pyarrow as pa  # type: ignore[import-untyped]  # ships no types
import pyarrow.csv as pc  # type: ignore[import-untyped]  # ships no types

from models.array import Array
from models.errors import cut
from models.files.inputs import UnreadableError
from reports.logs import text_lines
from reports.logs.map_file import FileTable
from reports.logs.text_lines import TITLE, Header, header_of, marked_rows

DIGITS = re.compile(r"[-+]?\d+(e[-+]?\d+)?", re.IGNORECASE)
"""Part of a number on either side of its decimal comma."""
HEXADECIMAL = re.compile(rb"0[xX]")
"""A prefix that arrow takes for a whole number."""
LONG = re.compile(r"-?(\d{16,}|\d{8,}[.,]\d+)")
"""A number whose last digits a float may lose, as that of a clock which counts from 1970."""


@dataclass(frozen=True)
class RowReader:
    """Reader of the rows below the header of a ``text``, with decimals after a point or comma;
    ``passed`` are the numbers of skipped lines, from the first row on."""

    header: Header
    text: memoryview
    passed: Array
    decimal: str

    def table(self, fields: Sequence[str], wanted: Callable[[str], bool]) -> pa.Table:
        """Return the wanted columns, as numbers where all of their cells are, as text else. Raises
        UnreadableError for rows that do not fit the header, and for too many."""
        self._refuse_misfit_first(fields)
        names = self.header.names
        types = {
            name: _type_of(field)
            for name, field in zip(names, fields, strict=True)
            if wanted(name) or not name
        }
        table = self._read(types)
        return self._without_last(table) if self.header.ends else table

    def _refuse_misfit_first(self, fields: Sequence[str]) -> None:
        names, separator, at = self.header.names, self.header.separator, self.header.first
        pairs = len(fields) >= 2 * len(names) - 1 and separator == "," and len(names) > 1
        if pairs and all(DIGITS.fullmatch(field) for field in fields):
            raise UnreadableError(
                f"line {at + 1} has {len(fields)} fields, the header {len(names)}: decimal commas "
                "between commas; write decimal points, or separate the columns by semicolons"
            )
        if len(fields) != len(names):
            _refuse_count(len(fields), len(names), at, separator, ends=not fields[-1])
        if self.decimal == ".":
            for name, field in zip(names, fields, strict=True):
                if text_lines.COMMA.fullmatch(field):
                    raise UnreadableError(
                        f"row {at + 1}, column {cut(name)!r}: found {cut(field)!r}, a decimal "
                        "comma; write decimal points, or set decimal = ',' in [file] of the map"
                    )

    def _read(self, types: Mapping[str, pa.DataType]) -> pa.Table:
        text = self.text
        if self.header.separator == " ":
            clean = re.sub(rb"[ \t]+", b" ", re.sub(rb"(?m)^[ \t]+|[ \t\r]+$", b"", bytes(text)))
            text = memoryview(clean)
        text_lines.refuse_rows(_count_lines(text), len(types))
        misfits: list[str] = []

        def misfit(row: pc.InvalidRow) -> str:
            misfits.append(
                f"row {self._line((row.number or 1) - 1)}: {row.actual_columns} fields, the header "
                f"{row.expected_columns}: {cut(row.text, 60)!r}"
            )
            return "error"

        def table(told: Mapping[str, pa.DataType]) -> pa.Table:
            return pc.read_csv(
                pa.BufferReader(pa.py_buffer(text)),
                read_options=pc.ReadOptions(
                    column_names=list(self.header.names), use_threads=False, block_size=1 << 24
                ),
                parse_options=pc.ParseOptions(
                    delimiter=self.header.separator, invalid_row_handler=misfit
                ),
                convert_options=pc.ConvertOptions(
                    column_types=told,
                    include_columns=list(types),
                    null_values=[""],
                    strings_can_be_null=True,
                    decimal_point=self.decimal,
                    timestamp_parsers=[],
                ),
                memory_pool=pa.system_memory_pool(),
            )

        try:
            try:  # with given types, the text is freed block by block
                return table(types)
            except pa.ArrowInvalid:
                if misfits:
                    raise
                if HEXADECIMAL.search(text):
                    return table(dict.fromkeys(types, pa.string()))
                return table({name: of for name, of in types.items() if of == pa.string()})
        except (pa.ArrowException, OSError, ValueError) as error:
            why = misfits[0] if misfits else cut(str(error).splitlines()[0], 200)
            raise UnreadableError(f"{why}; every row has as many fields as the header") from None

    def _without_last(self, table: pa.Table) -> pa.Table:
        """Return the table without the column after the last separator, which has to be empty."""
        last = table.column("")
        if last.null_count < table.num_rows:
            cells = last.to_pylist()
            row = next((n for n, cell in enumerate(cells) if str(cell or "").strip()), None)
            if row is not None:
                raise UnreadableError(
                    f"row {self._line(row)}: found {cut(str(cells[row]), 40)!r} in column "
                    f"{len(self.header.names)}, which has no name; give it one"
                )
        return table.drop_columns([""])

    def _line(self, row: int) -> int:
        return self.header.first + 1 + text_lines.row_line(self.passed, row)


def _type_of(field: str) -> pa.DataType:
    """Return the type of a column by its first cell; text keeps every digit."""
    if LONG.fullmatch(field):
        return pa.int64() if field.lstrip("-").isdigit() else pa.string()
    return pa.float64() if text_lines.is_number(field) else pa.string()


def _refuse_count(found: int, names: int, at: int, separator: str, *, ends: bool) -> None:
    mark = text_lines.SEPARATORS.get(separator, repr(separator))
    counts = f"line {at + 1} has {found} fields, the header {names}"
    if found == names + 1 and ends:
        raise UnreadableError(
            f"{counts}: it ends in a separator, {mark}, and the header does not; end both so, or "
            "neither"
        )
    title = f", and {TITLE}" if names == 1 else ""
    raise UnreadableError(
        f"{counts}, separated by {mark}; set separator in [file] of the map if it is another{title}"
    )


def _count_lines(text: memoryview) -> int:
    count, step = 0, 1 << 24
    for first in range(0, len(text), step):
        count += bytes(text[first : first + step]).count(b"\n")
    return count + (len(text) > 0 and text[-1] != 10)


def _as_utf_8(raw: bytes) -> bytes:
    """Return a text in UTF-16, with a mark or of ASCII, as UTF-8; another as it is."""
    marks = {b"\xff\xfe": "utf-16-le", b"\xfe\xff": "utf-16-be"}
    halves = {raw[1:4:2]: "utf-16-le", raw[:4:2]: "utf-16-be"}
    name = marks.get(raw[:2]) or (halves.get(b"\0\0", "") if any(raw[:4]) else "")
    try:
        return raw.decode(name).lstrip("\ufeff").encode() if name else raw
    except UnicodeDecodeError:
        raise UnreadableError("UTF-16 text that is cut; save the file as UTF-8") from None


def text_columns(
    raw: bytes, layout: FileTable, wanted: Callable[[str], bool]
) -> tuple[pa.Table, Sequence[str], int, Array]:
    """Read the ``wanted`` columns of a text with a header: all its names, the line of the first
    row, and the lines from there on that are no rows; those that are blank or remarks are skipped
    anywhere. Raises UnreadableError for other texts."""
    raw = _as_utf_8(raw)
    start = text_lines.beginning(raw)
    header = header_of(start, layout.separator, wanted)
    names = header.names
    is_row = marked_rows(names, header.separator, wanted)
    text, passed = text_lines.body(raw, start.offsets[header.first], is_row)
    fields = text_lines.fields_of(start.lines[header.first], header.separator)
    table = RowReader(header, text, passed, layout.decimal).table(fields, wanted)
    kept = names[:-1] if header.ends else names
    return table, kept, header.first + 1, passed
