"""The fields of a line of text: what separates them, and which of them are numbers."""

from __future__ import annotations

import re
from collections.abc import Sequence

SEPARATORS = {"\t": "a tab", ";": "a semicolon", ",": "a comma", " ": "spaces"}
NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?|[-+]?(nan|inf(inity)?)", re.I)
COMMA = re.compile(r"[-+]?\d+,\d+([eE][-+]?\d+)?")
"""A number with a decimal comma."""
SPACED = re.compile(
    r"""[\[(][^\[\]()]*[\])] | "(?:[^"]|"")*" | [^\s"\[(]\S*(?:[ ]+[\[(][^\[\]()]*[\])])?""", re.X
)
"""A field between spaces: a unit in brackets belongs to the name before it."""


def separator_of(header: str, row: str) -> str:
    """What stands between the fields: the first of tab, semicolon, comma and space that the header
    has, outside of brackets and quotes; spaces where ``row`` has as many fields between them."""
    bare = re.sub(r'"[^"]*"|\[[^\]]*\]|\([^)]*\)', "x", header).strip()
    for separator in SEPARATORS:
        # Names with spaces in a file of one column, or of a separator that comes next.
        if separator in bare and (
            separator != " " or len(fields_of(row, " ")) == len(fields_of(header, " "))
        ):
            return separator
    return ","


def fields_of(line: str, separator: str) -> list[str]:
    """The fields of a line, quotes taken off."""
    if separator == " ":
        return [_unquoted(field) for field in SPACED.findall(line)]
    mark = re.escape(separator)
    found = re.findall(rf'(?:^|{mark})[^\S{mark}]*("(?:[^"]|"")*"|[^{mark}]*)', line)
    return [_unquoted(field.strip()).strip() for field in found]


def _unquoted(field: str) -> str:
    """A field without its quotes; those in it are written twice."""
    if len(field) > 1 and field[0] == field[-1] and field[0] in "\"'":
        return field[1:-1].replace(field[0] * 2, field[0])
    return field


def is_number(field: str) -> bool:
    """Whether a field is a number, with a decimal point or comma."""
    return bool(NUMBER.fullmatch(field) or COMMA.fullmatch(field))


def are_numbers(fields: Sequence[str]) -> bool:
    """Whether no field that is not blank is a name."""
    return all(is_number(field) for field in fields if field)
