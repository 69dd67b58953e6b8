"""The kinds of columns of a log: their bodies, their units, and their place in a motion."""

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

from models.array import Array
from models.errors import CrankcheckError, cut
from models.motion import Motion, Order
from reports.quantities.quantity import FIELDS, MovingKind

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
_MOVING = {"m": 1.0, "mm": 1e-3, "cm": 1e-2, "in": INCH, "ft": 12 * INCH}
UNITS: Mapping[Dimension, Mapping[str, float]] = {
    "time": {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9, "min": 60.0},
    "angle": {"rad": 1.0, "deg": DEG, "mrad": 1e-3, "rev": REV},
    "angular velocity": {"rad/s": 1.0, "deg/s": DEG, "rpm": REV / 60.0, "rev/s": REV},
    "angular acceleration": {"rad/s^2": 1.0, "deg/s^2": DEG, "rev/s^2": REV},
    "length": {"m": 1.0, "mm": 1e-3, "cm": 1e-2, "um": 1e-6, "in": INCH, "ft": 12 * INCH},
    "velocity": {f"{unit}/s": size for unit, size in _MOVING.items()},
    "acceleration": {f"{unit}/s^2": size for unit, size in _MOVING.items()},
}
"""By dimension: each unit in SI, the SI unit first."""


def si(dimension: Dimension) -> str:
    """Return the SI unit of a dimension."""
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


_SIGNS = str.maketrans({"²": "2", "°": "deg", "·": " ", "*": " ", "^": ""})


def _key(text: str) -> str:
    """Return a spelling without differences of style: rad/s^2, rad_s2 and rad s-2 alike."""
    text = re.sub(r"\s+", " ", text.strip().lower().translate(_SIGNS)).strip()
    text = re.sub(r"[ _]?s-?2$|[ _/]s[ _]?2$|/\(s2\)$", "/s2", text)
    text = re.sub(r"(?<=[a-z°])[ _](?=s$)|(?<=[a-z])[ _]?s-1$", "/", text)
    return re.sub(r"/$", "/s", text) if text.endswith("/") else text


_SPELLED = {_key(unit): unit for unit in DIMENSION} | {
    _key(word): unit for word, unit in _WORDS.items()
}


def spelled_unit(text: str) -> str:
    """Return the unit that a text spells, "" for none."""
    return _SPELLED.get(_key(text), "")


def without_unit(column: str) -> tuple[str, str]:
    """Return a name without the unit in brackets at its end, and that unit."""
    hit = re.search(r"\s*[\[(]([^\[\]()]*)[\])]\s*$", column)
    if hit and (unit := spelled_unit(hit[1])):
        return column[: hit.start()], unit
    return column, ""


def trailing_unit(words: list[str]) -> tuple[str, list[str]]:
    """Return the unit that the last words spell, and the others. A lone `s` is a displacement."""
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
    """Return the unit of a name that may have two. Raises CrankcheckError where they differ."""
    bracket = without_unit(column)[1]
    if unit and bracket and unit != bracket:
        raise CrankcheckError(
            f"column {cut(column)!r}: units that contradict each other, {unit} and {bracket}; "
            "rename it, or say unit in the map"
        )
    return unit or bracket


def refuse_other_dimension(column: str, unit: str, dimension: str) -> None:
    """Refuse a unit of another dimension. Raises CrankcheckError."""
    if unit and DIMENSION[unit] != dimension:
        raise CrankcheckError(
            f"column {cut(column)!r}: {unit} is a unit of {DIMENSION[unit]}, and its name says "
            f"{dimension}; rename it, or say kind and unit in the map"
        )


LoggedKind = MovingKind | Literal["elastic"]
"""Kinds of logged bodies: an elastic link is a link, and bends and stretches besides."""


def plural(body_kind: str) -> str:
    """Return the name of the bodies of a kind in a motion."""
    return {"elastic": "elastic"}.get(body_kind, f"{body_kind}s")


@dataclass(frozen=True)
class Kind:
    """One kind of reading: ``field`` of the motion of bodies of ``body_kind``, for vectors the
    component ``axis``, None where it is a number. ``quantity`` is its entry in
    `reports.quantities`; ``order`` 0 is a position, 1 and 2 are its rates."""

    name: str
    body_kind: LoggedKind
    dimension: Dimension
    quantity: str
    field: str
    order: Order
    axis: Literal[0, 1] | None = None

    @property
    def turns(self) -> bool:
        """True if it is an angle, which may lose whole turns."""
        return self.dimension == "angle"

    @property
    def judged_of(self) -> MovingKind:
        """The kind of body of its quantity."""
        return "link" if self.body_kind == "elastic" else self.body_kind

    @property
    def column(self) -> str:
        """Our own name of a column, after that of the body (`reports.describe.free_motion`)."""
        name = self.field if self.body_kind == "link" else self.name
        unit = si(self.dimension).replace("/", "_").replace("^", "")
        return f"slider_{name}_{unit}" if self.body_kind == "slider" else f"{name}_{unit}"

    @property
    def bodies(self) -> str:
        """The name of the bodies of its kind in a motion."""
        return plural(self.body_kind)

    def of(self, motion: Motion, name: str) -> Array:
        """Return the series (T,) of a body in a motion."""
        series: Array = getattr(getattr(motion, self.bodies)[name], self.field)
        return series if self.axis is None else series[:, self.axis]


def _kinds() -> Iterator[Kind]:
    turning: Sequence[Dimension] = ("angle", "angular velocity", "angular acceleration")
    moving: Sequence[Dimension] = ("length", "velocity", "acceleration")
    orders: Sequence[Order] = (0, 1, 2)
    axes: Sequence[tuple[Literal[0, 1], str]] = ((0, "x"), (1, "y"))
    rates = ("velocity", "acceleration")
    for order in orders:
        name, field = turning[order], FIELDS["link"][order]
        yield Kind(name, "link", name, ("angle", *rates)[order], field, order)
    for order in orders:
        prefix, field = ("", "v", "a")[order], FIELDS["point"][order]
        for axis, letter in axes:
            yield Kind(prefix + letter, "point", moving[order], field, field, order, axis)
    for order in orders:
        field = FIELDS["slider"][order]
        yield Kind(field, "slider", moving[order], ("displacement", *rates)[order], field, order)
    yield Kind("deflection", "elastic", "length", "deflection", "middle", 0)
    yield Kind("extension", "elastic", "length", "extension", "extension", 0)


KINDS: Mapping[tuple[LoggedKind, str], Kind] = {
    (kind.body_kind, kind.name): kind for kind in _kinds()
}
"""By body kind and name: angle, angular velocity, angular acceleration of a link; x, y, vx, vy, ax,
ay of a point; displacement, speed, acceleration of a slider; deflection of the middle of an elastic
link from the line between its pins, and its extension."""


LENGTH = "it is the length of a vector, whose components are judged"


@dataclass(frozen=True)
class Meaning:
    """Meaning of the name of a column; "" and None for open parts."""

    of: str
    kind: Kind | None
    gap: bool
    unit: str
    relative_to: str = ""
    on: str = ""


def own_meanings(bodies: Mapping[str, tuple[LoggedKind, ...]]) -> Mapping[str, Meaning | str]:
    """Return the meanings of our own columns of bodies; of a name of two, that of the later."""
    found: dict[str, Meaning | str] = {}
    for body, kinds in bodies.items():
        said: dict[str, Meaning | str] = {
            kind.column: Meaning(body, kind, False, si(kind.dimension))
            for kind in KINDS.values()
            if kind.body_kind in kinds
        }
        if "point" in kinds:
            said |= dict.fromkeys(("v_m_s", "a_m_s2"), LENGTH)
        if "point" in kinds or "slider" in kinds:
            said["gap_m"] = Meaning(body, None, True, "m")
        found |= {f"{body}{mark}{name}": each for name, each in said.items() for mark in "_."}
    return found
