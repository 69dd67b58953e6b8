"""The forces of a user's own log: columns by name, of the pins, sliders and driver of a scene.

``C_rod_fx_n`` is the force of pin C on the rod, along x of the ground; ``C_fx_n`` will do where two
bodies meet, and is that on the second of them. ``C_slider_normal_n`` and ``C_slider_moment_n_m``
are what the guide exerts, ``torque_n_m`` is the drive's on the driver. Dots and spaces stand for
underscores, and the unit may be in brackets. ``force_time_s`` are the instants that forces act at,
where they are others than those of the rows.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Literal

import numpy as np

from models.array import Array
from models.errors import CrankcheckError, cut, few
from models.forces import Forces, SliderForces
from models.joints import joined_at
from models.scene import Scene

if TYPE_CHECKING:
    from reports.logs.columns import Columns  # and the readers of files with it

POUND, INCH = 4.4482216152605, 0.0254
UNITS: Mapping[str, Mapping[str, float]] = {
    "force": {"n": 1.0, "kn": 1e3, "mn": 1e-3, "lbf": POUND},
    "moment": {
        "n_m": 1.0,
        "nm": 1.0,
        "n_mm": 1e-3,
        "nmm": 1e-3,
        "kn_m": 1e3,
        "knm": 1e3,
        "lbf_in": POUND * INCH,
        "lbf_ft": POUND * 12 * INCH,
    },
}
"""What one is in SI, by how it is spelled in small letters; mN is a millinewton."""
TIMES = "force_time_s"
Place = tuple[Literal["torque", "pin", "normal", "moment"], str, str, int]
"""What a column is of: kind, point or slider, body, and axis."""


@dataclass(frozen=True)
class LogForces:
    """The forces of a log, NaN for what it has not; the ``columns`` by quantity and body that they
    were read from, and whether its first row has none, as where forces are those of steps."""

    forces: Forces
    columns: Mapping[tuple[str, str], tuple[str, ...]]
    of_steps: bool


def names_force(column: str, scene: Scene) -> bool:
    """Whether a column is one of forces."""
    return column == TIMES or _meaning(column, _places(scene)) is not None


def log_forces(
    columns: Columns, scene: Scene, time_s: Array, acting_s: Array | None, ignored: set[str]
) -> LogForces:
    """The forces that stand in the columns of a log.

    Parameters
    ----------
    time_s : Array
        The instants of the rows [s], (T,).
    acting_s : Array or None
        Those that the forces act at, where they are others.
    ignored : set of str
        Columns that the user's map leaves out.

    Raises
    ------
    CrankcheckError
        No column of forces, two of one, or cells that are no numbers.
    """
    places = _places(scene)
    found: dict[Place, tuple[str, Array]] = {}
    for column in columns.raw:
        meant = None if column in ignored else _meaning(column, places)
        if meant is None:
            continue
        place, factor = meant
        if place in found:
            raise CrankcheckError(
                f"two columns for one force: {cut(found[place][0])!r} and {cut(column)!r}; rename "
                "one, or ignore = true"
            )
        found[place] = column, factor * _numbers(columns, column)
    if not found:
        wanted = few([f"{name}_n" if "torque" not in name else "torque_n_m" for name in places], 6)
        raise CrankcheckError(
            f"{columns.source}: no column is a force of {scene.name}; found "
            f"{few(map(cut, columns.raw), 8)}; name columns such as {wanted}, or leave --forces out"
        )
    nothing = np.full(time_s.shape, np.nan)
    read = {place: values for place, (_, values) in found.items()}
    forces = Forces(
        time_s if acting_s is None else acting_s,
        {p: _pin(p, bodies, read, nothing) for p, bodies in joined_at(scene).items()},
        {
            name: SliderForces(
                read.get(("normal", name, "", 0), nothing),
                read.get(("moment", name, "", 0), nothing),
            )
            for name in scene.sliders
        },
        read.get(("torque", scene.driver.link, "", 0), nothing),
    )
    by_body: dict[tuple[str, str], tuple[str, ...]] = {}
    for (kind, of, body, _), (column, _) in found.items():
        pair = len(joined_at(scene).get(of, ())) == 2
        name = f"{of} on {body}" if kind == "pin" and not pair else of
        key = ("reaction" if kind == "pin" else kind, name)
        by_body[key] = (*by_body.get(key, ()), column)
    first = [values[0] for values in read.values()]
    return LogForces(forces, by_body, bool(np.all(np.isnan(first))))


def _places(scene: Scene) -> dict[str, Place]:
    """What columns may be called, without their units."""
    driver = scene.driver.link
    torque: Place = ("torque", driver, "", 0)
    found = dict.fromkeys(("torque", f"{driver}_torque", "drive_torque"), torque)
    for point, bodies in joined_at(scene).items():
        for axis, letter in enumerate("xy"):
            for body in bodies:
                place: Place = ("pin", point, body, axis)
                name = body.replace(" ", "_")
                found[f"{point}_{name}_f{letter}"] = place
                found[f"{point}_on_{name}_f{letter}"] = place
            if len(bodies) == 2:
                found[f"{point}_f{letter}"] = ("pin", point, bodies[1], axis)
    for name in scene.sliders:
        for kind in ("normal", "moment"):
            of: Place = ("normal" if kind == "normal" else "moment", name, "", 0)
            found[f"{name}_slider_{kind}"] = of
            found[f"{name}_{kind}"] = of
    return found


def _meaning(column: str, places: Mapping[str, Place]) -> tuple[Place, float] | None:
    """What a column is of, and what one of its numbers is in SI; None for none."""
    bare = re.sub(r"\s*[\[(]([^\[\]()]*)[\])]\s*$", r"_\1", column)
    words = re.sub(r"[\s._·*]+", "_", bare.strip()).strip("_")
    for kind, units in UNITS.items():
        for unit, factor in (*units.items(), ("", 1.0)):
            end = f"_{unit}" if unit else ""
            if not words.lower().endswith(end):
                continue
            place = places.get(words[: len(words) - len(end)])
            if place and (place[0] in ("torque", "moment")) == (kind == "moment"):
                return place, factor
    return None


def _pin(
    point: str, bodies: tuple[str, ...], read: Mapping[Place, Array], nothing: Array
) -> dict[str, Array]:
    """The forces of a pin; where two bodies meet, that on the second follows from the first's."""
    found = {
        body: np.stack([read.get(("pin", point, body, axis), nothing) for axis in (0, 1)], axis=-1)
        for body in bodies
    }
    if len(bodies) == 2 and np.all(np.isnan(found[bodies[1]])):
        first, second = bodies
        found[second], found[first] = -found[first], found[second]
    return found


def _numbers(columns: Columns, name: str) -> Array:
    """A column as numbers; the first cell may be empty."""
    cell = columns.raw[name][0]
    empty = cell is None or (isinstance(cell, float | np.floating) and math.isnan(cell))
    if not (empty or (isinstance(cell, str) and not cell.strip())):
        return columns.numbers(name)
    rest = replace(columns, raw={name: columns.raw[name][1:]}, first=columns.first + 1)
    return np.concatenate([[np.nan], rest.numbers(name)])
