"""The unit in the name of a column: in brackets, or in its last words."""

from __future__ import annotations

import re

from models.errors import CrankcheckError, cut
from reports.logs.spelling import DIMENSION, spelled_unit


def without_unit(column: str) -> tuple[str, str]:
    """A name without the unit in brackets at its end, and that unit."""
    hit = re.search(r"\s*[\[(]([^\[\]()]*)[\])]\s*$", column)
    if hit and (unit := spelled_unit(hit[1])):
        return column[: hit.start()], unit
    return column, ""


def trailing_unit(words: list[str]) -> tuple[str, list[str]]:
    """The unit that the last words spell, and the words before it. A lone `s` is a displacement."""
    if words and not spelled_unit(words[-1]):
        word, _, unit = words[-1].partition("/")
        if word and spelled_unit(unit):
            words = [*words[:-1], word, unit]
    for count in (3, 2, 1):
        if len(words) < count:
            continue
        unit = spelled_unit("_".join(words[-count:]))
        if unit and DIMENSION[unit] != "time":
            return unit, words[:-count]
    return "", words


def one_unit(column: str, unit: str) -> str:
    """The unit of a name that may tell it twice. Raises CrankcheckError where they differ."""
    bracket = without_unit(column)[1]
    if unit and bracket and unit != bracket:
        raise CrankcheckError(
            f"column {cut(column)!r}: units that contradict each other, {unit} and {bracket}; "
            "rename it, or say unit in the map"
        )
    return unit or bracket


def refuse_other_dimension(column: str, unit: str, dimension: str) -> None:
    """Refuse a unit of something else. Raises CrankcheckError."""
    if unit and DIMENSION[unit] != dimension:
        raise CrankcheckError(
            f"column {cut(column)!r}: {unit} is a unit of {DIMENSION[unit]}, and its name says "
            f"{dimension}; rename it, or say kind and unit in the map"
        )
