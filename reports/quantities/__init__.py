"""The compared quantities: one entry each, in the order of every table.

A new quantity is an entry here. Its columns, rows, limit, rule and diagrams follow from it.
"""

from collections.abc import Collection
from functools import cache

from reports.quantities import forces, free_and_elastic, places
from reports.quantities.quantity import Quantity, Role

QUANTITIES: dict[str, Quantity] = {
    entry.name: entry
    for entry in (
        *(places.DRIVE, places.ANGLE, places.DISPLACEMENT, places.POSITION, places.GAP),
        *(places.VELOCITY, places.ACCELERATION),
        *(forces.REACTION, forces.NORMAL, forces.MOMENT, forces.TORQUE),
        *(free_and_elastic.PHASE, free_and_elastic.GEOMETRY),
        *(free_and_elastic.ENERGY, free_and_elastic.MOMENTUM, free_and_elastic.DEFLECTION),
        *(free_and_elastic.SEGMENTS, free_and_elastic.EXTENSION),
    )
}


@cache
def named(*roles: Role) -> tuple[str, ...]:
    """Return the quantities of some roles."""
    return tuple(name for name, entry in QUANTITIES.items() if entry.role in roles)


MOVES: Collection[Role] = ("drive", "place", "closure", "derived")
"""The roles of the quantities compared in every run."""
