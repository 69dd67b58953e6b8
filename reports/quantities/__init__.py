"""The compared quantities: one entry each, in the order of every table.

A new quantity is an entry here. Its columns, rows, limit, rule and diagrams follow from it.
"""

from collections.abc import Collection, Mapping

from reports.quantities.by_kind import (
    DEFLECTION,
    ENERGY,
    EXTENSION,
    GEOMETRY,
    MOMENTUM,
    PHASE,
    SEGMENTS,
)
from reports.quantities.forces import MOMENT, NORMAL, REACTION, TORQUE
from reports.quantities.places import (
    ACCELERATION,
    ANGLE,
    DISPLACEMENT,
    DRIVE,
    GAP,
    POSITION,
    VELOCITY,
)
from reports.quantities.quantity import Quantity, Role, Tolerance, tolerance_name

QUANTITIES: dict[str, Quantity] = {
    entry.name: entry
    for entry in (
        *(DRIVE, ANGLE, DISPLACEMENT, POSITION, GAP, VELOCITY, ACCELERATION),
        *(REACTION, NORMAL, MOMENT, TORQUE),
        *(PHASE, GEOMETRY, ENERGY, MOMENTUM),
        *(DEFLECTION, SEGMENTS, EXTENSION),
    )
}


def named(*roles: Role) -> tuple[str, ...]:
    """Return the quantities of some roles."""
    return tuple(name for name, entry in QUANTITIES.items() if entry.role in roles)


MOVES: Collection[Role] = ("drive", "place", "closure", "derived")
"""The roles of the quantities compared in every run."""


_OWN = {
    tolerance_name(name, each.source): (entry.role, each)
    for name, entry in QUANTITIES.items()
    for each in entry.criteria
}
DRIVEN = (*MOVES, "force")
DEFAULTS: Mapping[str, Tolerance] = {
    name: each.tolerance for name, (role, each) in _OWN.items() if role in DRIVEN
}
"""Tolerances of a driven mechanism."""
BENDING: Mapping[str, Tolerance] = {
    name: each.tolerance for name, (role, each) in _OWN.items() if role == "elastic"
}
"""Tolerances of elastic links themselves."""
ELASTIC = {**DEFAULTS, **BENDING}
"""Tolerances of a mechanism whose links bend."""
FREE: Mapping[str, Tolerance] = {
    name: limit
    for name, (role, each) in _OWN.items()
    if (limit := each.tolerance if role == "free" else each.free_motion)
}
"""Tolerances of free motion: its errors at the same time are over the sensitivity of the motion."""
FREE_ELASTIC = {**FREE, **BENDING}
"""Tolerances of free motion of links that bend."""
EVERY = tuple(dict.fromkeys((*DEFAULTS, *FREE, *ELASTIC)))
"""Names of all tolerances."""
