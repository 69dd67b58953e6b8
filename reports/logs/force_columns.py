"""The forces of a user's own log, of columns that are called so (`reports.logs.force_names`)."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from models.array import Array
from models.errors import CrankcheckError, cut, few
from models.joints import joined_at
from models.motion import Forces, SliderForces
from models.scene import Scene
from reports.logs.force_names import Place, drive_place, force_meaning, force_places, shown_names

if TYPE_CHECKING:
    from reports.logs.columns import Columns  # and the readers of files with it

QUANTITIES = {"pin": "reaction", "push": "torque"}
"""What a kind of column is judged as, where that is called otherwise."""


@dataclass(frozen=True)
class LogForces:
    """The forces of a log, NaN for what it has not; the ``columns`` by quantity and body that they
    were read from, and whether its first row has none, as where forces are those of steps."""

    forces: Forces
    columns: Mapping[tuple[str, str], tuple[str, ...]]
    of_steps: bool

    def first(self, rows: int) -> LogForces:
        """Those of the first rows alone."""
        some = self.forces.each_series(lambda series: series[:rows])
        return replace(self, forces=replace(some, time_s=some.time_s[:rows]))


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
    found = _found(columns, scene, ignored)
    if not found:
        raise CrankcheckError(
            f"{columns.source}: no column is a force of {scene.name}; found "
            f"{few(map(cut, columns.raw), 8)}; name columns such as {few(shown_names(scene), 6)}, "
            "or leave --forces out"
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
        read.get(drive_place(scene), nothing),
        drive_unit=scene.driver.effort_unit,
    )
    by_body: dict[tuple[str, str], tuple[str, ...]] = {}
    for (kind, of, body, _), (column, _) in found.items():
        pair = len(joined_at(scene).get(of, ())) == 2
        name = f"{of} on {body}" if kind == "pin" and not pair else of
        key = (QUANTITIES.get(kind, kind), name)
        by_body[key] = (*by_body.get(key, ()), column)
    of_steps = any(np.isnan(values[0]) for values in read.values())
    return LogForces(forces, by_body, of_steps)


def _found(columns: Columns, scene: Scene, ignored: set[str]) -> dict[Place, tuple[str, Array]]:
    """The columns that are of forces, with their numbers in SI. Raises CrankcheckError."""
    places = force_places(scene)
    found: dict[Place, tuple[str, Array]] = {}
    for column in columns.raw:
        meant = None if column in ignored else force_meaning(column, places)
        if meant is None:
            continue
        place, factor = meant
        if math.isnan(factor):
            raise CrankcheckError(
                f"{columns.source}, column {cut(column)!r}: its unit may be milli or mega; write "
                "mN or MN, or ignore = true"
            )
        if place in found:
            raise CrankcheckError(
                f"two columns for one force: {cut(found[place][0])!r} and {cut(column)!r}; rename "
                "one, or ignore = true"
            )
        found[place] = column, factor * _numbers(columns, column)
    lacking = [column for column, values in found.values() if np.isnan(values[0])]
    if lacking and len(lacking) < len(found):  # where forces are those of steps, all lack it
        columns.numbers(lacking[0])  # which refuses the cell
    return found


def _pin(
    point: str, bodies: tuple[str, ...], read: Mapping[Place, Array], nothing: Array
) -> dict[str, Array]:
    """The forces of a pin; where two bodies meet, each component on the one is the opposite of that
    on the other, where only this was logged."""

    def component(body: str, axis: int) -> Array:
        own = read.get(("pin", point, body, axis))
        if own is None and len(bodies) == 2:
            other = read.get(("pin", point, bodies[body == bodies[0]], axis))
            own = None if other is None else -other
        return nothing if own is None else own

    return {body: np.stack([component(body, axis) for axis in (0, 1)], axis=-1) for body in bodies}


def _numbers(columns: Columns, name: str) -> Array:
    """A column as numbers; the first cell may be empty."""
    cell = columns.raw[name][0]
    empty = cell is None or (isinstance(cell, float | np.floating) and math.isnan(cell))
    if not (empty or (isinstance(cell, str) and not cell.strip())):
        return columns.numbers(name)
    rest = replace(columns, raw={name: columns.raw[name][1:]}, first=columns.first + 1)
    return np.concatenate([[np.nan], rest.numbers(name)])
