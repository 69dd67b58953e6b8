"""The columns of times: their choice, their unit, and the instants in them."""

import re

import numpy as np

from models.array import Array
from models.errors import CrankcheckError, cut, few
from models.scene import Scene
from models.scene.laws import MOST_TURNS
from reports.logs.columns import Columns
from reports.logs.kinds import DIMENSION, UNITS, one_unit, si, spelled_unit, without_unit
from reports.logs.map_file import Map

TIMES = {"time", "t", "timestamp", "time stamp", "times", "sim time", "simtime", "simulation time",
         "elapsed", "elapsed time"}  # fmt: skip


def time_of(column: str, told: str = "") -> tuple[str, str] | None:
    """Return kind (``time``, ``velocity time``, ``acceleration time``) and unit, perhaps ``told``,
    of a column of times; None for others. Raises CrankcheckError for two units."""
    text = re.sub(r"(?<=[a-z])(?=[A-Z])", " ", without_unit(column)[0])
    words = [word.lower() for word in re.split(r"[^A-Za-z0-9µμ]+", text) if word]
    unit = ""
    if len(words) > 1 and DIMENSION.get(spelled_unit(words[-1])) == "time":
        unit = spelled_unit(words.pop())
        if words[-1] == "in":
            words.pop()
    name = " ".join(words)
    if name not in TIMES and name not in ("velocity time", "acceleration time"):
        return None
    unit = told or one_unit(column, unit) or si("time")
    return ("time" if name in TIMES else name, unit) if DIMENSION[unit] == "time" else None


def time_columns(columns: Columns, map_: Map) -> dict[str, str]:
    """Return the columns of times, by kind: that of all rows is ``time``. Raises CrankcheckError
    for none, and for two."""
    found: dict[str, list[str]] = {}
    others = {one.column for one in map_.channel if one.ignore or map_.time.column is not None}
    for column in columns.raw:
        if column not in others and (time := time_of(column, map_.time.unit or "")):
            found.setdefault(time[0], []).append(column)
    if map_.time.column is not None:
        columns.require([map_.time.column], "[time] column")
        found["time"] = [map_.time.column]
    if "time" not in found:
        raise CrankcheckError(
            f"{columns.source}: no column of times; found {few(map(cut, columns.raw), 8)}; name "
            "one time_s or time_ms, or say it in [time] of a map"
        )
    for whose, several in found.items():
        if len(several) > 1:
            raise CrankcheckError(
                f"{columns.source}: two columns of times, {several[0]!r} and {several[1]!r}; say "
                f"which in [time] of a map, and ignore the other"
                if whose == "time"
                else f"{columns.source}: two columns for {whose}: {', '.join(several[:2])}"
            )
    return {whose: several[0] for whose, several in found.items()}


def unit_of_time(column: str, map_: Map) -> str:
    """Return the unit of the times of all rows."""
    told = time_of(column, map_.time.unit or "")
    return map_.time.unit or (told[1] if told else si("time"))


def further_instants(columns: Columns, column: str, zero_s: float, scene: Scene) -> Array:
    """Return the instants in a further column of times [s]. Raises CrankcheckError for times that
    go back, or far from the start."""
    told = time_of(column)
    time_s = columns.numbers(column) * UNITS["time"][told[1] if told else si("time")]
    refuse_back(columns, column, time_s)
    refuse_far(columns, column, time_s - zero_s, scene)
    return np.asarray(time_s - zero_s)


EVEN = 0.02
"""Relative difference below which intervals are equal."""
MOSTLY = 0.9
"""The share of equal intervals in an even log."""
HOLE = 1.9
"""Ratio of an interval to the usual one from which on samples are missing."""


def instants(columns: Columns, column: str, unit: str, *, holes: bool = False) -> Array:
    """Return the times of all rows [s], (T,). Raises CrankcheckError for fewer than 2 rows; times
    that go back or stand still; samples missing in an even log, unless ``holes`` are intended."""
    time_s = columns.numbers(column) * UNITS["time"][unit]
    if time_s.size < 2:
        raise CrankcheckError(f"{columns.source}: {time_s.size} row; a motion has at least 2")
    refuse_back(columns, column, time_s)
    if not holes:
        _refuse_holes(columns, column, time_s, np.diff(time_s))
    return np.asarray(time_s)


def refuse_back(columns: Columns, column: str, time_s: Array) -> None:
    """Refuse times that go back or stand still. Raises CrankcheckError."""
    steps = np.diff(time_s)
    back = np.flatnonzero(steps <= 0.0)
    if back.size:
        row = int(back[0])
        does = "goes back" if steps[row] < 0.0 else "stands still"
        raise CrankcheckError(
            f"{columns.at(column, row + 1)}: time {does}, from {time_s[row]:.9g} s to "
            f"{time_s[row + 1]:.9g} s ({back.size} such rows); sort the rows, and keep one of each "
            "instant"
        )


def refuse_far(columns: Columns, column: str, time_s: Array, scene: Scene) -> None:
    """Refuse times so late that the place within a turn is lost. Raises CrankcheckError."""
    far = float(np.max(np.abs(time_s)))
    turns = far / scene.driver.law.period_s
    if turns > MOST_TURNS:
        raise CrankcheckError(
            f"{columns.source}, column {cut(column)!r}: t = {far:.9g} s is {turns:.3g} turns of "
            f"{scene.driver.joint} after the start; count the time from the start of the motion, "
            f"or from the first row: zero = {'first'!r} in [time] of the map"
        )


def _refuse_holes(columns: Columns, column: str, time_s: Array, steps: Array) -> None:
    usual = float(np.median(steps))
    same = np.abs(steps - usual) <= EVEN * usual
    far = np.flatnonzero(steps > HOLE * usual)
    if far.size == 0 or np.mean(same) < MOSTLY:
        return
    row = int(far[0])
    lacking = round(float(steps[row]) / usual) - 1
    raise CrankcheckError(
        f"{columns.at(column, row + 1)}: a gap of {steps[row]:.4g} s in a log of a sample every "
        f"{usual:.4g} s, {lacking} of them missing after t = {time_s[row]:.6g} s ({far.size} such "
        f"gaps); fill them, cut the log there, or say {cut('holes = ' + repr('meant'))} in [file] "
        "of the map"
    )
