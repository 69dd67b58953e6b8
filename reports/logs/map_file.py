"""A map: the TOML file with the user's meanings of the columns of a log.

::

    [file]
    decimal = ","              # where the log has decimal commas

    [time]
    column = "Zeit"
    unit = "ms"

    [[channel]]
    column = "sensor 3"
    of = "rocker"              # a link, point or slider of the scene
    kind = "angle"
    unit = "deg"
    sign = -1                  # turned the other way
    relative_to = "coupler"    # a joint's sensor

Entries missing for a column are taken from the column's name.
"""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field

from models.errors import CrankcheckError, listed, suggestion
from models.files.assemble import toml_value
from models.files.faults import read_table, table_of
from reports.logs.kinds import DIMENSION, KINDS, UNITS

Number = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=-1e15, le=1e15)]
Truth = Annotated[bool, Field(strict=True)]
Name = Annotated[str, Field(min_length=1, max_length=400)]
KIND_NAMES = (*dict.fromkeys(name for _, name in KINDS), "gap")
LEFT_OUT = "the map leaves it out"
"""Reason for a column that a map ignores."""
HEAD = (
    "# What the columns of the log mean: `crankcheck judge SCENE LOG --map` and this file.",
    "# kinds: angle, angular velocity, angular acceleration of a link; x, y, vx, vy, ax, ay of",
    "# a point, v and a the sizes of its rates; displacement, speed, acceleration of a slider; gap",
    "# of a pin or slider.",
    "# A reading is sign * (number + offset); ignore = true leaves a column out.",
)
"""Head of a written map."""


class MapTable(BaseModel):
    """A table of the map: unknown keys are faults."""

    model_config = ConfigDict(extra="forbid", frozen=True)


class FileTable(MapTable):
    """Format of the file, "" where it is to be found; ``holes = "meant"`` permits some in an even
    log."""

    separator: Literal["", ",", ";", "\t", " "] = ""
    decimal: Literal[".", ","] = "."
    sheet: str = Field(default="", max_length=100)
    holes: Literal["", "meant"] = ""


class TimeTable(MapTable):
    """The column of times, and its unit; with ``zero = "first"`` they are counted from the first
    row, where the scene's law begins."""

    column: Name | None = None
    unit: str | None = None
    zero: Literal["", "first"] = ""


class ChannelTable(MapTable):
    """Meaning of a column; omitted entries are taken from its name."""

    column: Name
    ignore: Truth = False
    of: Name | None = None
    kind: str | None = None
    unit: str | None = None
    sign: Literal[1, -1] = 1
    offset: Number = 0.0
    wrapped: Truth | None = None
    relative_to: str | None = None
    on: str | None = None
    delay_s: Number = 0.0
    time: Name | None = None


class Map(MapTable):
    """A whole map."""

    file: FileTable = FileTable()
    time: TimeTable = TimeTable()
    channel: Annotated[list[ChannelTable], Field(max_length=2_000)] = []


def read_map(path: Path) -> Map:
    """Read a map. Raises CrankcheckError with every fault of the file."""
    place = f"--map {path}"
    return _of_known_words(read_table(path, Map, place), place)


def map_of(raw: Mapping[str, object], place: str) -> Map:
    """Return a map of such tables, at ``place``. Raises CrankcheckError with every fault."""
    return _of_known_words(table_of(raw, Map, place), place)


def _of_known_words(map_: Map, place: str) -> Map:
    """Refuse unknown units and kinds, and repeated columns; the error has every fault."""
    faults = []
    twice = set[str]()
    if map_.time.unit is not None and map_.time.unit not in UNITS["time"]:
        hint = suggestion(map_.time.unit, UNITS["time"], "use one of")
        faults.append(f"[time] unit: {map_.time.unit!r} is not a unit of time; {hint}")
    for one in map_.channel:
        where = f"[[channel]] {one.column!r}"
        if one.column in twice:
            faults.append(f"{where}: given twice; leave one of them out")
        twice.add(one.column)
        if one.unit is not None and one.unit not in DIMENSION:
            hint = suggestion(one.unit, DIMENSION, "use one of")
            faults.append(f"{where}, unit: {one.unit!r} is unknown; {hint}")
        if one.kind is not None and one.kind not in KIND_NAMES:
            hint = suggestion(one.kind, KIND_NAMES, "use one of")
            faults.append(f"{where}, kind: {one.kind!r} is unknown; {hint}")
    if faults:
        raise CrankcheckError(listed(place, faults))
    return map_


def form_lines(column: str, reason: str) -> Sequence[str]:
    """Return a form for a column without meaning, for that reason, as remarks."""
    head = [f"# {' '.join(reason.split())}", "# [[channel]]", f"# column = {toml_value(column)}"]
    return [*head, '# of = ""', '# kind = ""', '# unit = ""']


def file_lines(file: FileTable) -> Sequence[str]:
    """Return the entries of a map on the file as lines of TOML, none where it has none."""
    return [*table_lines("[file]", file), ""] if file.model_dump(exclude_defaults=True) else []


def table_lines(head: str, table: MapTable) -> Sequence[str]:
    """Return a table of a map as lines of TOML, without defaults."""
    return [head, *entries(table.model_dump(exclude_defaults=True))]


def entries(told: Mapping[str, object]) -> list[str]:
    """Return keys with texts, truths and numbers, as lines of TOML."""
    return [f"{key} = {toml_value(value)}" for key, value in told.items()]
