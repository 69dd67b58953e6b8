"""How units and kinds of readings are spelled in the names of columns."""

from __future__ import annotations

import re

from reports.logs.units import UNITS, Dimension

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
