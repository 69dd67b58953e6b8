"""Numbers as a reader takes them in: short in tables and sentences, thinned in what is embedded."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np

NONE = "\N{EN DASH}"
"""What stands where there is no number."""
DIGITS = 6
"""Significant digits of an embedded number: more than a screen shows."""


def error_text(value: float | None, digits: int = 2) -> str:
    """A pure error with few digits, such as 2.7e-4; a dash where there is none."""
    if value is None or not math.isfinite(value):
        return NONE
    if value == 0.0:
        return "0"
    mantissa, exponent = f"{value:.{digits - 1}e}".split("e")
    return f"{mantissa}e{int(exponent)}"


def duration(value_s: float | None) -> str:
    """A time in the unit that gives it one to three digits before the point."""
    if value_s is None or not math.isfinite(value_s):
        return NONE
    for unit, size in (("s", 1.0), ("ms", 1e-3), ("\N{MICRO SIGN}s", 1e-6)):
        if value_s >= 0.9995 * size:
            return f"{_three(value_s / size)} {unit}"
    return f"{_three(value_s / 1e-9)} ns"


def _three(value: float) -> str:
    """Three significant digits, without an exponent."""
    places = 2 if value < 9.995 else 1 if value < 99.95 else 0
    return f"{value:.{places}f}"


def count(number: int, noun: str, plural: str | None = None) -> str:
    """A number of things: 1 scene, 2 scenes."""
    return f"{number} {noun if number == 1 else plural or noun + 's'}"


def listed(words: Sequence[str], last: str = "and") -> str:
    """Words as a list in a sentence: a, b and c."""
    if len(words) < 2:
        return "".join(words)
    return f"{', '.join(words[:-1])} {last} {words[-1]}"


def plain(value: object) -> object:
    """A value as JSON holds it: numbers to six digits, what is not finite as None."""
    if isinstance(value, bool | str) or value is None:
        return value
    if isinstance(value, Mapping):
        return {str(key): plain(each) for key, each in value.items()}
    if isinstance(value, np.ndarray | list | tuple):
        return [plain(each) for each in value]
    number = float(value)  # type: ignore[arg-type]  # all that is left are numbers
    if not math.isfinite(number):
        return None
    return _whole(number if number.is_integer() else float(f"{number:.{DIGITS}g}"))


def _whole(number: float) -> float | int:
    """A whole number without its point."""
    return int(number) if number.is_integer() and abs(number) < 1e15 else number
