"""Numbers for a reader: short in tables and sentences, thinned where they are embedded."""

import math
from collections.abc import Mapping, Sequence

import numpy as np

NONE = "\N{EN DASH}"
"""Text for a missing number."""
DIGITS = 6
"""Significant digits of an embedded number: more than a screen shows."""


def short(value: float, digits: int = 2) -> str:
    """Return 7.5e-4 for 0.00075; a number that is not finite by its name."""
    mantissa, _, exponent = f"{value:.{digits - 1}e}".partition("e")
    return f"{mantissa}e{int(exponent)}" if exponent else mantissa


def error_text(value: float | None, digits: int = 2) -> str:
    """Return a pure error with few digits, such as 2.7e-4; a dash where there is none."""
    if value is None or not math.isfinite(value):
        return NONE
    if value == 0.0:
        return "0"
    return short(value, digits)


def floor_words(floor: float, below: float = math.nan, unit: str = "") -> str:
    """Return a floor of an error that is seen, or, where that is not finite, the size ``below``
    which there may be one; "" where neither is known."""
    if math.isfinite(floor):
        return f"floor {short(floor)} {unit}".rstrip()
    size = f"{short(below)} {unit}".rstrip()
    return f"a floor below {size} is not excluded by these steps" * math.isfinite(below)


def readable(value: float, digits: int = 3) -> str:
    """Return a number with few digits: 0.0123, 345, 6.7e-5; one that is not finite by its name."""
    if value == 0.0 or 1e-3 <= abs(value) < 1e5:
        return f"{value:.{digits}g}" if abs(value) < 10.0**digits else f"{value:.0f}"
    mantissa, e, exponent = short(value, digits).partition("e")
    return f"{mantissa.rstrip('0').rstrip('.') if e else mantissa}{e}{exponent}"


def duration(value_s: float | None) -> str:
    """Return a time in the unit that gives it one to three digits before the point."""
    if value_s is None or not math.isfinite(value_s):
        return NONE
    for unit, size in (("s", 1.0), ("ms", 1e-3), ("\N{MICRO SIGN}s", 1e-6)):
        if value_s >= 0.9995 * size:
            return f"{_three(value_s / size)} {unit}"
    return f"{_three(value_s / 1e-9)} ns"


def _three(value: float) -> str:
    """Return three significant digits, without an exponent."""
    places = 2 if value < 9.995 else 1 if value < 99.95 else 0
    return f"{value:.{places}f}"


def count(number: int, noun: str, plural: str | None = None) -> str:
    """Return a number with its noun: 1 scene, 2 scenes."""
    return f"{number} {noun if number == 1 else plural or noun + 's'}"


def listed(words: Sequence[str], last: str = "and") -> str:
    """Return words as a list in a sentence: a, b and c."""
    if len(words) < 2:
        return "".join(words)
    return f"{', '.join(words[:-1])} {last} {words[-1]}"


def finite(value: object, digits: int | None = None) -> object:
    """Return a value, and all that it holds, for JSON: numbers that are not finite are None.

    Numbers are cut to so many significant ``digits``, if given, and whole ones have no point.
    """
    if isinstance(value, Mapping):
        return {str(key): finite(each, digits) for key, each in value.items()}
    if isinstance(value, np.ndarray | list | tuple):
        return [finite(each, digits) for each in value]
    number = value.item() if isinstance(value, np.generic) else value
    if not isinstance(number, float):
        return number
    if digits is None or not math.isfinite(number):
        return number if math.isfinite(number) else None
    near = number if number.is_integer() else float(f"{number:.{digits}g}")
    return int(near) if near.is_integer() and abs(near) < 1e15 else near


VALUES = ((10, "X"), (9, "IX"), (5, "V"), (4, "IV"), (1, "I"))


def roman(number: int) -> str:
    """Return IV for 4; of numbers from 1 to 39."""
    letters = ""
    for value, own in VALUES:
        letters += own * (number // value)
        number %= value
    return letters
