"""The map that explains a stranger's log, as a user writes it."""

from __future__ import annotations

import json
from collections.abc import Sequence

from tests.worlds.stranger import Linkage
from tests.worlds.stranger_log import DEG, MM, PLANE, RPM, Column

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
    more: str = "",
) -> str:
    """A map that says all of every column, and of the file what is given."""
    parts = [f"[file]\n{file}"] if file else []
    parts.append(f'[time]\ncolumn = {json.dumps(clock[0])}\nunit = "{clock[1]}"')
    parts += [_channel(linkage, column) for column in columns]
    return "\n\n".join([*parts, more]).strip() + "\n"


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
