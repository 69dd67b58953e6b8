"""The kinds of columns of a log: their bodies, their units, and their place in a motion."""

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Literal

import numpy as np

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
_ANGLES = {"rad": 1.0, "deg": DEG, "mrad": 1e-3, "rev": REV}
_MOVING = {"m": 1.0, "mm": 1e-3, "cm": 1e-2, "in": INCH, "ft": 12 * INCH}
_RARE = {"dm": 0.1, "km": 1e3}
TYPICAL: Mapping[Dimension, Mapping[str, float]] = {
    "time": {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9, "min": 60.0},
    "angle": _ANGLES,
    "angular velocity": {"rad/s": 1.0, "deg/s": DEG, "rpm": REV / 60.0, "rev/s": REV},
    "angular acceleration": {"rad/s^2": 1.0, "deg/s^2": DEG, "rev/s^2": REV},
    "length": {"m": 1.0, "mm": 1e-3, "cm": 1e-2, "um": 1e-6, "in": INCH, "ft": 12 * INCH},
    "velocity": {f"{unit}/s": size for unit, size in _MOVING.items()},
    "acceleration": {f"{unit}/s^2": size for unit, size in _MOVING.items()},
}
"""By dimension: its usual units in SI, the SI unit first."""


def _rates(sizes: Mapping[str, float], power: int) -> dict[str, float]:
    """Return rates of units, over other times as well: deg/min, mm/ms^2, km/h."""
    times = {"s": 1.0, "ms": 1e-3, "min": 60.0, "h": 3600.0}
    return {
        f"{unit}/{time}{'^2' * (power - 1)}": size / each**power
        for time, each in times.items()
        for unit, size in sizes.items()
        if (unit, time, power) != ("rev", "min", 1)  # which is rpm
    }


UNITS: Mapping[Dimension, Mapping[str, float]] = {
    "time": {**TYPICAL["time"], "h": 3600.0},
    "angle": {**_ANGLES, "gon": REV / 400.0},
    "angular velocity": {**TYPICAL["angular velocity"], **_rates(_ANGLES, 1)},
    "angular acceleration": {
        **TYPICAL["angular acceleration"], **_rates(_ANGLES, 2), "rpm/s": REV / 60.0},
    "length": {**TYPICAL["length"], **_RARE},
    "velocity": _rates({**_MOVING, **_RARE}, 1),
    "acceleration": {**_rates({**_MOVING, **_RARE}, 2), "g": 9.80665},
}  # fmt: skip
"""By dimension: each unit in SI, the SI unit first."""


def si(dimension: Dimension) -> str:
    """Return the SI unit of a dimension."""
    return next(iter(UNITS[dimension]))


_WORDS = {
    **dict.fromkeys(("radian", "radians", "rads"), "rad"),
    **dict.fromkeys(("degree", "degrees"), "deg"),
    **dict.fromkeys(("sec", "secs", "second", "seconds"), "s"),
    **dict.fromkeys(("msec", "msecs", "millisecond", "milliseconds", "millis"), "ms"),
    **dict.fromkeys(("usec", "microsecond", "microseconds", "micros"), "us"),
    **dict.fromkeys(("nsec", "nanosecond", "nanoseconds"), "ns"),
    **dict.fromkeys(("mins", "minute", "minutes"), "min"), "micron": "um", "microns": "um",
    **dict.fromkeys(("hour", "hours"), "h"),
    **dict.fromkeys(("meter", "meters", "metre", "metres"), "m"),
    **dict.fromkeys(("millimeter", "millimeters", "millimetre", "millimetres"), "mm"),
    **dict.fromkeys(("centimeter", "centimeters", "centimetre", "centimetres"), "cm"),
    **dict.fromkeys(("inch", "inches"), "in"), **dict.fromkeys(("foot", "feet"), "ft"),
    **dict.fromkeys(("turn", "turns", "revs", "revolution", "revolutions"), "rev"),
}  # fmt: skip
_WHOLE = {"rads": "rad/s", "radps": "rad/s", "dps": "deg/s", "degps": "deg/s", "mps": "m/s",
          "mmps": "mm/s", "rps": "rev/s", "r/s": "rev/s",
          **dict.fromkeys(
              ("1/min", "r/min", "u/min", "rev/min", "tr/min", "min-1"), "rpm")}  # fmt: skip
"""Spellings that are no product of units."""
DIMENSION: dict[str, Dimension] = {
    unit: dimension for dimension, units in UNITS.items() for unit in units
}
"""The dimension of each unit: no two have a unit in common."""


_SIGNS = str.maketrans({"²": "^2", "°": "deg", "º": "deg", "µ": "u", "μ": "u", "⁻": "-",
                        "¹": "^1", "·": "*", "⋅": "*", "_": " "})  # fmt: skip
BRACKETS = re.compile(r"[\[(]\s*((?:[^\[\]()]|\([^\[\]()]*\))+)[\])]")
_FACTOR = re.compile(r"([/* .]?)([a-z]+|1)(-?[12])?")
_JOINED = re.compile(r"(rad|deg|mm|cm|m)s(-?[12])")
"""A unit over a power of seconds without a mark between them: rads-1, ms2."""


def _over(text: str) -> str:
    """Return a text with a mark before each factor of denominators in brackets: rad/s/s."""
    return re.sub(
        r"/\s*\(([^()]*)\)", lambda hit: "/" + "/".join(re.split(r"[\s*·]+", hit[1].strip())), text
    )


def _key(text: str) -> str:
    """Return a spelling without differences of style: rad/s^2, rad/sec**2, rad·s⁻², rad_s_2 and
    radians per second squared have one mark before each factor, and the power behind it."""
    text = _over(text.strip().lower()).translate(_SIGNS).replace("**", "^").replace("-^", "^-")
    text = re.sub(r"\bper\b", "/", re.sub(r"\bsquared\b", "^2", text)).replace("./", "/")
    text = re.sub(r"\s*\^\s*(?:\((-?\d)\)|(-?\d))", lambda hit: hit[1] or hit[2], text)
    text = re.sub(r"\s+(?=-?[12]$)", "", re.sub(r"\s*([/*])\s*", r"\1", text))
    return re.sub(r"\s+", " ", text).strip(" .")


OF_TIME = re.compile(r"(?<=\w)\s*[\[(]\s*t\s*[\])]")
"""Sign of a function of time: x_C(t)."""
LONGEST = 40
"""Characters of a unit."""


@lru_cache(20_000)
def spelled_unit(text: str) -> str:
    """Return the unit that a text spells, "" for none."""
    key = _key(text) if len(text) <= LONGEST else ""
    if joined := _JOINED.fullmatch(key):
        key = f"{joined[1]}/s{joined[2].lstrip('-')}"
    if key in _WHOLE:
        return _WHOLE[key]
    factors = _FACTOR.findall(key)
    if not factors or "".join(map("".join, factors)) != key or factors[0][0] or factors[0][2]:
        return ""
    (_, word, _), *others = factors
    unit, time, power = _WORDS.get(word, word), "", 0
    for mark, word, exponent in others:
        each, below = _WORDS.get(word, word), exponent.startswith("-")
        if time not in ("", each) or not (mark == " " or (mark == "/") != below):
            return ""
        time, power = each, power + abs(int(exponent or 1))
    name = f"{unit}/{time}" + f"^{power}" * (power > 1) if power else unit
    name = _WHOLE.get(name, name)
    return name if name in DIMENSION else ""


def without_unit(column: str) -> tuple[str, str]:
    """Return a name without the unit in brackets, and that unit: the last, of several."""
    column = _over(OF_TIME.sub(" ", column))
    for hit in reversed(list(BRACKETS.finditer(column))):
        if unit := spelled_unit(hit[1]):
            return f"{column[: hit.start()]} {column[hit.end() :]}".strip(), unit
    return column, ""


LAST_ALONE = {"m", "in", "ft", "cm", "min", "g"}
"""Units that have another meaning unless they stand last."""
MOST_WORDS = 12
"""Words at the end of a name that are searched for its unit."""


def trailing_unit(words: list[str]) -> tuple[str, list[str]]:
    """Return the unit that some words spell, the last if they do, and the other words. A lone `s`
    is a displacement."""
    if words and not spelled_unit(words[-1]):
        word, _, unit = words[-1].partition("/")
        if word and spelled_unit(unit):
            words = [*words[:-1], word, unit]
    for end in range(len(words), max(len(words) - MOST_WORDS, 0), -1):
        for count in (4, 3, 2, 1):
            unit = spelled_unit("_".join(words[end - count : end])) if count <= end else ""
            if unit and DIMENSION[unit] != "time" and (end == len(words) or unit not in LAST_ALONE):
                return unit, words[: end - count] + words[end:]
    return "", words


def one_unit(column: str, unit: str) -> str:
    """Return the unit of a name that may have two. Raises CrankcheckError where they differ."""
    bracket = without_unit(column)[1]
    if unit and bracket and unit != bracket:
        raise CrankcheckError(
            f"column {cut(column)!r}: units that contradict each other, {unit} and {bracket}; "
            "rename it, or set unit in the map"
        )
    return unit or bracket


def refuse_other_dimension(column: str, unit: str, dimension: str) -> None:
    """Refuse a unit of another dimension. Raises CrankcheckError."""
    if unit and DIMENSION[unit] != dimension:
        raise CrankcheckError(
            f"column {cut(column)!r}: {unit} is a unit of {DIMENSION[unit]}, and its name says "
            f"{dimension}; rename it, or set kind and unit in the map"
        )


LoggedKind = MovingKind | Literal["elastic"]
"""Kinds of logged bodies: an elastic link is a link, and bends and stretches besides."""


def plural(body_kind: str) -> str:
    """Return the name of the bodies of a kind in a motion."""
    return {"elastic": "elastic"}.get(body_kind, f"{body_kind}s")


@dataclass(frozen=True)
class Kind:
    """One kind of reading: ``field`` of the motion of bodies of ``body_kind``, for vectors the
    component ``axis`` or, where it ``is_size``, the length. ``quantity`` is its entry in
    `reports.quantities`; ``order`` 0 is a position, 1 and 2 are its rates."""

    name: str
    body_kind: LoggedKind
    dimension: Dimension
    quantity: str
    field: str
    order: Order
    axis: Literal[0, 1] | None = None
    is_size: bool = False

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
        if self.is_size:
            return np.asarray(np.hypot(series[:, 0], series[:, 1]))
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
    for order in orders[1:]:
        field = FIELDS["point"][order]
        yield Kind("va"[order - 1], "point", moving[order], field, field, order, is_size=True)
    for order in orders:
        field = FIELDS["slider"][order]
        yield Kind(field, "slider", moving[order], ("displacement", *rates)[order], field, order)
    yield Kind("deflection", "elastic", "length", "deflection", "middle", 0)
    yield Kind("extension", "elastic", "length", "extension", "extension", 0)


KINDS: Mapping[tuple[LoggedKind, str], Kind] = {
    (kind.body_kind, kind.name): kind for kind in _kinds()
}
"""By body kind and name: angle, angular velocity, angular acceleration of a link; x, y, vx, vy, ax,
ay of a point, v and a the sizes of its rates; displacement, speed, acceleration of a slider;
deflection of the middle of an elastic link from the line between its pins, and its extension."""


@dataclass(frozen=True)
class Meaning:
    """Meaning of the name of a column; "" and None for open parts."""

    of: str
    kind: Kind | None
    gap: bool
    unit: str
    relative_to: str = ""
    on: str = ""


def own_meanings(bodies: Mapping[str, tuple[LoggedKind, ...]]) -> Mapping[str, Meaning]:
    """Return the meanings of our own columns of bodies; of a name of two, that of the later."""
    found: dict[str, Meaning] = {}
    for body, kinds in bodies.items():
        said = {
            kind.column: Meaning(body, kind, False, si(kind.dimension))
            for kind in KINDS.values()
            if kind.body_kind in kinds
        }
        if "point" in kinds or "slider" in kinds:
            said["gap_m"] = Meaning(body, None, True, "m")
        found |= {f"{body}{mark}{name}": each for name, each in said.items() for mark in "_."}
    return found
