"""The instants of the rows of a log: by its column of times, or by the angle of its driver."""

import re
from collections.abc import Iterable
from decimal import Decimal

import numpy as np

from models.array import Array
from models.errors import CrankcheckError, cut, few
from models.scene import Scene
from models.scene.laws import MOST_TURNS
from reports.logs.channel import Channel, Reading, is_driver
from reports.logs.columns import ONE_FILE, SPARSE, Columns
from reports.logs.kinds import DIMENSION, UNITS, one_unit, si, spelled_unit, without_unit
from reports.logs.map_file import Map
from reports.logs.names import FOREIGN

TIME_NAMES = {"time", "t", "timestamp", "time stamp", "times", "sim time", "simtime",
              "simulation time", "elapsed", "elapsed time", "time steps",
              "timesteps"}  # fmt: skip
LIKELY = {"tout", "uptime", "zeit", "temps", "tiempo", "tempo", "clock", "stamp", "header stamp",
          "field header stamp", "analysis time", "relative time", "time since start", "run time",
          "runtime"}  # fmt: skip
"""Names of times where no other column has one of `TIME_NAMES`."""


def time_of(column: str, told: str = "") -> tuple[str, str] | None:
    """Return kind (``time``, ``likely time``, ``velocity time``, ``acceleration time``) and unit,
    perhaps ``told``, of a column of times; None for others. Raises CrankcheckError for two units.
    """
    text = re.sub(r"(?<=[a-z])(?=[A-Z])", " ", without_unit(column)[0])
    words = [word.lower() for word in re.split(r"[^A-Za-z0-9µμ]+", text) if word]
    unit = ""
    if len(words) > 1 and DIMENSION.get(spelled_unit(words[-1])) == "time":
        unit = spelled_unit(words.pop())
        if words[-1] == "in":
            words.pop()
    name = " ".join(words)
    lone = spelled_unit(name) if len(name) > 1 and name != "min" else ""  # of millis, seconds
    axis = name == "x axis" and DIMENSION.get(without_unit(column)[1]) == "time"
    likely = name in LIKELY or re.fullmatch(r"time (plot )?\d+|time\d+", name)
    if name in TIME_NAMES:
        name = "time"
    elif likely or axis or DIMENSION.get(lone) == "time":
        name, unit = "likely time", unit or lone
    elif name not in ("velocity time", "acceleration time"):
        return None
    unit = told or one_unit(column, unit) or si("time")
    return (name, unit) if DIMENSION[unit] == "time" else None


def time_columns(columns: Columns, map_: Map) -> dict[str, str]:
    """Return the columns of times, by kind: that of all rows is ``time``, "" for none. Raises
    CrankcheckError for two."""
    found: dict[str, list[str]] = {}
    others = {one.column for one in map_.channel if one.ignore or map_.time.column is not None}
    for column in columns.raw:
        if column not in others and (time := time_of(column, map_.time.unit or "")):
            found.setdefault(time[0], []).append(column)
    likely = found.pop("likely time", [])
    if likely and "time" not in found:
        found["time"] = likely
    if map_.time.column is not None:
        columns.require([map_.time.column], "[time] column")
        found["time"] = [map_.time.column]
    for whose, several in found.items():
        if len(several) > 1:
            raise CrankcheckError(
                f"{columns.source}: two columns of times, {several[0]!r} and {several[1]!r}; "
                "name one in [time] of a map, and ignore the other or set time in the "
                f"[[channel]] of its columns; of two rates, {ONE_FILE}"
                if whose == "time"
                else f"{columns.source}: two columns for {whose}: {', '.join(several[:2])}"
            )
    clocks = (one.time or "" for one in map_.channel if one.time in columns.raw)
    further = {f"clock {name}": name for name in clocks if may_be_times(name)}
    return {"time": "", **{whose: several[0] for whose, several in found.items()}, **further}


def _unit_of(column: str, told: str = "") -> str:
    """Return the unit of a column of times, perhaps ``told``."""
    found = time_of(column, told)
    return told or (found[1] if found else unit_named(column) or si("time"))


def further(columns: Columns, column: str, zero_s: Decimal, scene: Scene) -> Array:
    """Return the instants in a further column of times, after ``zero_s`` [s]. Raises
    CrankcheckError for times that go back, or far from the start."""
    time_s = _seconds(columns, column, _unit_of(column), zero_s)
    _refuse_back(columns, column, time_s)
    _refuse_far(columns, column, time_s, scene)
    return time_s


def _seconds(columns: Columns, column: str, unit: str, zero_s: Decimal) -> Array:
    size = UNITS["time"][unit]
    return np.asarray(columns.less(column, zero_s / Decimal(str(size))) * size)


EVEN = 0.02
"""Relative difference below which intervals are equal."""
MOSTLY = 0.9
"""The share of equal intervals in an even log."""
HOLE = 1.9
"""Ratio of an interval to the usual one from which on samples are missing."""


def of_rows(columns: Columns, column: str, map_: Map, scene: Scene) -> tuple[Array, str, Decimal]:
    """Return the times of all rows [s], (T,), the unit of their column, and the time [s] that was
    subtracted from them. Raises CrankcheckError for fewer than 2 rows; times that go back or stand
    still, or are far from the start; samples missing in an even log, unless the map permits it."""
    unit, zero_s = _unit_of(column, map_.time.unit or ""), Decimal(0)
    if map_.time.zero and columns.numbers(column).size:
        zero_s = columns.exact(column, 0) * Decimal(str(UNITS["time"][unit]))
    time_s = _seconds(columns, column, unit, zero_s)
    if time_s.size < 2:
        raise CrankcheckError(f"{columns.source}: {time_s.size} row; a motion has at least 2")
    _refuse_back(columns, column, time_s)
    if map_.file.holes != "meant":
        _refuse_holes(columns, column, time_s, np.diff(time_s))
    _refuse_far(columns, column, time_s, scene)
    return time_s, unit, zero_s


def _refuse_back(columns: Columns, column: str, time_s: Array) -> None:
    steps = np.diff(time_s)
    back = np.flatnonzero(steps <= 0.0)
    if back.size:
        row = int(back[0])
        does = "goes back" if steps[row] < 0.0 else "stands still"
        raise CrankcheckError(
            f"{columns.at(column, row + 1)}: time {does}, from {time_s[row]:.9g} s to "
            f"{time_s[row + 1]:.9g} s ({back.size} such rows); sort the rows, and keep one of each "
            f"instant{f'; of two rates, {ONE_FILE}' if back.size >= SPARSE * steps.size else ''}"
        )


def _refuse_far(columns: Columns, column: str, time_s: Array, scene: Scene) -> None:
    """Refuse times so late that the place within a turn is lost. Raises CrankcheckError."""
    far = float(np.max(np.abs(time_s)))
    turns = far / scene.driver.law.period_s
    if turns > MOST_TURNS:
        raise CrankcheckError(
            f"{columns.source}, column {cut(column)!r}: t = {far:.9g} s is {turns:.3g} turns of "
            f"{scene.driver.joint} after the start; count the time from the start of the "
            f"motion, or from the first row: zero = {'first'!r} in [time] of the map; set unit "
            "there if it is another, as 'ns'"
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
        f"{usual:.4g} s, {lacking} of them missing after t = {time_s[row]:.6g} s ({far.size} "
        f"such gaps); fill them, cut the log there, or set {cut('holes = ' + repr('meant'))} in "
        "[file] of the map"
    )


def driver_channel(
    columns: Columns,
    scene: Scene,
    channels: Iterable[Channel],
    others: Iterable[str],
    *,
    forces: bool,
) -> Channel:
    """Return the driver's angle, at which a log without times is judged. Raises CrankcheckError
    where that is not logged, where one of the ``others`` may be the times, by its name or as it
    rises throughout, and for scenes and ``forces`` that take times."""
    crank = next((each for each in channels if is_driver(each, scene)), None)
    cranked = scene.driver.is_crank and not (scene.is_free or scene.elastic or forces)
    clock = next((n for n in others if may_be_times(n) or _rises(columns, n)), "")
    if crank and cranked and not clock:
        return crank
    cure = ", which forces take" * forces
    cure += (
        f" ({cut(clock)!r} may be it; if not, set ignore = true in its [[channel]])"
        if clock
        else ""
    )
    if cranked and not clock:
        cure = f"; frame numbers over their rate are times; with the angle of {scene.driver.name}, "
        cure += "none are needed"
    raise CrankcheckError(
        f"{columns.source}: no column of times; found {few(map(cut, columns.raw), 8)}; name one "
        f"time_s or time_ms, or name it in [time] of a map{cure}"
    )


CLOCKS = {"time", "times", "t", "timestamp", "stamp", "clock", "date", "datetime", "sec", "secs",
          "seconds", "zeit", "temps", "tiempo", "tempo", "tid", "czas"}  # fmt: skip


COUNTERS = {"frame", "frames", "index", "idx", "row", "n", "no", "nr", "num", "number", "sample",
            "samples", "seq", "step", "steps", "iteration", "iter", "id", "i", "k", "unnamed",
            *FOREIGN}  # fmt: skip


def _rises(columns: Columns, name: str) -> bool:
    """True if a column that counts no rows rises from row to row."""
    words = re.split(r"[^a-z]+", re.sub(r"(?<=[a-z])(?=[A-Z])", " ", name).lower())
    try:
        values = columns.numbers(name)
    except (CrankcheckError, ValueError):
        return False
    counts = not COUNTERS.isdisjoint(words) or not any(words)
    return not counts and values.size > 2 and bool(np.all(np.diff(values) > 0.0))


def unit_named(column: str) -> str:
    """Return the unit of time at the end of the name of a column, "" for none."""
    name, unit = without_unit(column)
    last = re.split(r"[^A-Za-zµμ]+", name)[-1]
    unit = unit or (spelled_unit(last) if last != name else "")
    return unit if DIMENSION.get(unit) == "time" else ""


def may_be_times(column: str) -> bool:
    """True if a word or the unit of a column is of time."""
    words = re.split(r"[^A-Za-z]+", re.sub(r"(?<=[a-z])(?=[A-Z])", " ", column))
    named = not CLOCKS.isdisjoint(word.lower() for word in words if word != "T")  # a torque
    return named or bool(unit_named(column))


def turning_s(crank: Reading, scene: Scene) -> Array:
    """Return the instants [s], (T,), at which the driver is at logged angles if it turns from row
    to row at its peak speed. Raises CrankcheckError for angles that are all the same."""
    angle = np.unwrap(crank.values) if crank.channel.wrapped else crank.values
    path = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(angle)))])
    if not path[-1] > 0.0:
        raise CrankcheckError(
            f"column {cut(crank.channel.column)!r}: {scene.driver.link} stands still, and a log "
            "without times is judged at its angles; log several, or a column of times"
        )
    return np.asarray(path / scene.driver.law.peak_speed_rad_s)
