"""The columns of times: which they are, in which unit, and the instants in them."""

from __future__ import annotations

import re

import numpy as np

from models.array import Array
from models.errors import CrankcheckError, cut, few
from models.scene import Scene
from reports.logs.columns import Columns
from reports.logs.instants import refuse_back, refuse_far
from reports.logs.map_file import Map
from reports.logs.name_units import one_unit, without_unit
from reports.logs.spelling import DIMENSION, spelled_unit
from reports.logs.units import UNITS, si

TIMES = {"time", "t", "timestamp", "time stamp", "times", "sim time", "simtime", "simulation time",
         "elapsed", "elapsed time"}  # fmt: skip


def time_of(column: str, told: str = "") -> tuple[str, str] | None:
    """Of a column of times: whose (``time``, ``velocity time``, ``acceleration time``), and the
    unit, which may be ``told``; None for another column. Raises CrankcheckError for two units."""
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
    """The columns of times, by whose they are: those of all rows are called ``time``.

    Raises CrankcheckError for none, and for two.
    """
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
    """The unit of the times of all rows."""
    told = time_of(column, map_.time.unit or "")
    return map_.time.unit or (told[1] if told else si("time"))


def further_instants(columns: Columns, column: str, zero_s: float, scene: Scene) -> Array:
    """The instants in a further column of times [s]. Raises CrankcheckError for those that go back,
    and for some that are far from the start."""
    told = time_of(column)
    time_s = columns.numbers(column) * UNITS["time"][told[1] if told else si("time")]
    refuse_back(columns, column, time_s)
    refuse_far(columns, column, time_s - zero_s, scene)
    return np.asarray(time_s - zero_s)
