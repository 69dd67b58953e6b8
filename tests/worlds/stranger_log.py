"""What that somebody logs of them: columns of any name and unit, at any times, in any dress; and
the map that explains a log, as a user writes it.

Nothing is interpolated: a channel that is late is the linkage at an earlier time.
"""

import json
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from tests.worlds.stranger import Array, Course, Linkage, course

Log = dict[str, Array]
"""Numbers as they are written, by header; the time is the first column."""
DEG, MM, RPM = 180.0 / math.pi, 1e3, 30.0 / math.pi
"""How many make one SI unit."""
ANGULAR = ("angle", "omega", "alpha")
PLANE = {"x": (0, 0), "y": (0, 1), "vx": (1, 0), "vy": (1, 1), "ax": (2, 0), "ay": (2, 1)}
"""The rate of a point, and its axis."""
SEED = 20260512


@dataclass(frozen=True)
class Column:
    """A column: ``what`` of a body or point, ``per`` SI unit so many, and an ``offset``. An angle
    may be wrapped into the turn that begins at ``turn_from`` [deg], and be that against a
    ``parent``; what stands in a row may belong to an instant ``later_s`` after its time."""

    header: str
    of: str
    what: str
    per: float = 1.0
    turn_from: float | None = None
    parent: str = ""
    on: str = ""
    later_s: float = 0.0
    offset: float = 0.0

    def numbers(self, linkage: Linkage, time_s: Array) -> Array:
        """The column (T,) in rows of those times [s]."""
        motion = course(linkage, time_s + self.later_s)
        series = self._series(motion, self.of)
        if self.parent:
            series = series - self._series(motion, self.parent)
        if self.turn_from is not None:
            low = math.radians(self.turn_from)
            series = np.mod(series - low, math.tau) + low
        return series * self.per + self.offset

    def _series(self, motion: Course, name: str) -> Array:
        if self.what in ANGULAR:
            return motion.angle(name)[ANGULAR.index(self.what)]
        rate, axis = PLANE[self.what]
        return motion.point(name, self.on)[rate][:, axis]


def even(linkage: Linkage, turns: float = 2.0, samples_per_turn: int = 360) -> Array:
    """The times [s] of a recorder."""
    return np.arange(round(turns * samples_per_turn) + 1) * (linkage.period_s / samples_per_turn)


def uneven(linkage: Linkage, turns: float = 2.0, samples_per_turn: int = 360) -> Array:
    """The times [s] of a program that logs when it comes to it, the first of them late."""
    regular = even(linkage, turns, samples_per_turn) + 0.0137
    jitter = np.random.default_rng(SEED).uniform(-0.4, 0.4, regular.size)
    return regular + jitter * (regular[1] - regular[0])


def logged(
    linkage: Linkage,
    time_s: Array,
    columns: Sequence[Column],
    clock: str = "time_s",
    per_second: float = 1.0,
) -> Log:
    numbers = {column.header: column.numbers(linkage, time_s) for column in columns}
    return {clock: time_s * per_second, **numbers}


@dataclass(frozen=True)
class Dress:
    """How a log looks as a text. ``digits`` are significant ones; of none all are written."""

    separator: str = ","
    point: str = "."
    comments: tuple[str, ...] = ()
    units: tuple[str, ...] = ()
    newline: str = "\n"
    mark: bool = False
    digits: int | None = None
    quoted: bool = False

    def text(self, log: Log) -> bytes:
        headers = [f'"{name}"' if self.quoted else name for name in log]
        lines = [*self.comments, self.separator.join(headers)]
        lines += [self.separator.join(self.units)] if self.units else []
        write = repr if self.digits is None else f"{{:.{self.digits}g}}".format
        columns = [[write(x) for x in series.tolist()] for series in log.values()]
        rows = (self.separator.join(row) for row in zip(*columns, strict=True))
        lines += [row.replace(".", self.point) for row in rows]
        whole = "".join(line + self.newline for line in lines)
        return whole.encode("utf-8-sig" if self.mark else "utf-8")


def single(log: Log) -> Log:
    return {name: series.astype(np.float32) for name, series in log.items()}


ANGLES = {
    "angle": ("angle", {1.0: "rad", DEG: "deg"}),
    "omega": ("angular velocity", {1.0: "rad/s", DEG: "deg/s", RPM: "rpm"}),
    "alpha": ("angular acceleration", {1.0: "rad/s^2", DEG: "deg/s^2"}),
}
ALONG = {"x": "displacement", "vx": "speed", "ax": "acceleration"}
"""Of a block on a line along x."""
LENGTHS = {1.0: "m", MM: "mm"}
RATES = ("", "/s", "/s^2")


def map_text(
    linkage: Linkage,
    columns: Sequence[Column],
    clock: tuple[str, str] = ("time_s", "s"),
    file: str = "",
) -> str:
    """A map that says all of every column, and of the file what is given."""
    parts = [f"[file]\n{file}"] if file else []
    parts.append(f'[time]\ncolumn = {json.dumps(clock[0])}\nunit = "{clock[1]}"')
    parts += [_channel(linkage, column) for column in columns]
    return "\n\n".join(parts) + "\n"


def _channel(linkage: Linkage, column: Column) -> str:
    if column.what in ANGLES:
        kind, units = ANGLES[column.what]
        unit = units[abs(column.per)]
    else:
        along = column.of in linkage.blocks and column.what in ALONG
        kind = ALONG[column.what] if along else column.what
        unit = LENGTHS[abs(column.per)] + RATES[PLANE[column.what][0]]
    said: dict[str, object] = {"column": column.header, "of": column.of, "kind": kind, "unit": unit}
    if column.per < 0.0:
        said["sign"] = -1
    if column.offset:
        said["offset"] = -column.offset  # what makes of a number the reading
    if column.turn_from is not None:
        said["wrapped"] = True
    if column.parent:
        said["relative_to"] = column.parent
    if column.on:
        said["on"] = column.on
    if column.later_s:
        said["delay_s"] = column.later_s
    return "\n".join(["[[channel]]", *(f"{k} = {_toml(v)}" for k, v in said.items())])


def _toml(value: object) -> str:
    return repr(value) if isinstance(value, float) else json.dumps(value)
