"""The units of logs: what each is in SI, how it is spelled, and where a column's name has it."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from typing import Literal

from models.errors import CrankcheckError, cut

Dimension = Literal[
    "time",
    "angle",
    "angular velocity",
    "angular acceleration",
    "length",
    "velocity",
    "acceleration",
]
DEG, REV, INCH = math.pi / 180.0, math.tau, 0.0254
UNITS: Mapping[Dimension, Mapping[str, float]] = {
    "time": {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9, "min": 60.0},
    "angle": {"rad": 1.0, "deg": DEG, "mrad": 1e-3, "rev": REV},
    "angular velocity": {"rad/s": 1.0, "deg/s": DEG, "rpm": REV / 60.0, "rev/s": REV},
    "angular acceleration": {"rad/s^2": 1.0, "deg/s^2": DEG, "rev/s^2": REV},
    "length": {"m": 1.0, "mm": 1e-3, "cm": 1e-2, "um": 1e-6, "in": INCH, "ft": 12 * INCH},
    "velocity": {"m/s": 1.0, "mm/s": 1e-3, "cm/s": 1e-2, "in/s": INCH, "ft/s": 12 * INCH},
    "acceleration": {
        "m/s^2": 1.0,
        "mm/s^2": 1e-3,
        "cm/s^2": 1e-2,
        "in/s^2": INCH,
        "ft/s^2": 12 * INCH,
    },
}
"""By dimension: each unit in SI, the SI unit first."""


def si(dimension: Dimension) -> str:
    """The SI unit of a dimension."""
    return next(iter(UNITS[dimension]))


_WORDS = {
    "radian": "rad", "radians": "rad", "degree": "deg", "degrees": "deg",
    "sec": "s", "secs": "s", "second": "s", "seconds": "s", "msec": "ms", "millisecond": "ms",
    "milliseconds": "ms", "usec": "us", "µs": "us", "μs": "us", "microseconds": "us",
    "minute": "min", "minutes": "min",
    "meter": "m", "meters": "m", "metre": "m", "metres": "m", "millimeter": "mm",
    "millimeters": "mm", "millimetre": "mm", "millimetres": "mm", "centimeter": "cm",
    "centimeters": "cm", "inch": "in", "inches": "in", "foot": "ft", "feet": "ft", "µm": "um",
    "turn": "rev", "turns": "rev", "revs": "rev",
    "rads": "rad/s", "radps": "rad/s", "dps": "deg/s", "degps": "deg/s", "mps": "m/s",
    "mmps": "mm/s", "rps": "rev/s", "1/min": "rpm", "rev/min": "rpm", "r/min": "rpm",
    "rad/s/s": "rad/s^2", "deg/s/s": "deg/s^2", "m/s/s": "m/s^2", "mm/s/s": "mm/s^2",
}  # fmt: skip
DIMENSION: dict[str, Dimension] = {
    unit: dimension for dimension, units in UNITS.items() for unit in units
}
"""The dimension of each unit: no two have a unit in common."""


def _key(text: str) -> str:
    """A spelling without what differs from writer to writer: rad/s^2, rad_s2 and rad s-2 alike."""
    text = (
        text.strip()
        .lower()
        .replace("²", "2")
        .replace("°", "deg")
        .replace("·", " ")
        .replace("*", " ")
    )
    text = re.sub(r"\s+", " ", text.replace("^", "")).strip()
    text = re.sub(r"[ _]?s-?2$|[ _/]s[ _]?2$|/\(s2\)$", "/s2", text)
    text = re.sub(r"(?<=[a-z°])[ _](?=s$)|(?<=[a-z])[ _]?s-1$", "/", text)
    return re.sub(r"/$", "/s", text) if text.endswith("/") else text


_SPELLED = {_key(unit): unit for unit in DIMENSION} | {
    _key(word): unit for word, unit in _WORDS.items()
}


def spelled_unit(text: str) -> str:
    """The unit that a text spells, "" for none."""
    return _SPELLED.get(_key(text), "")


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
