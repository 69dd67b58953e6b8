"""The compared quantities: one entry each, in the order of every table.

A new quantity is an entry here. Its columns, rows, limit, rule and diagrams follow from it.
"""

from collections.abc import Collection

from reports.quantities.forces import MOMENT, NORMAL, REACTION, TORQUE
from reports.quantities.free_and_elastic import (
    DEFLECTION,
    ENERGY,
    EXTENSION,
    GEOMETRY,
    MOMENTUM,
    PHASE,
    SEGMENTS,
)
from reports.quantities.places import (
    ACCELERATION,
    ANGLE,
    DISPLACEMENT,
    DRIVE,
    GAP,
    POSITION,
    VELOCITY,
)
from reports.quantities.quantity import Quantity, Role

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
