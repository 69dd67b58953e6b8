"""The compared quantities: one entry each, in the order of every table.

A new quantity is an entry here. Its columns, rows, limit, rule and diagrams follow from it.
"""

from collections.abc import Collection

from reports.quantities import by_kind, places
from reports.quantities.forces import MOMENT, NORMAL, REACTION, TORQUE
from reports.quantities.quantity import Quantity, Role

QUANTITIES: dict[str, Quantity] = {
    entry.name: entry
    for entry in (
        *(
            places.DRIVE,
            places.ANGLE,
            places.DISPLACEMENT,
            places.POSITION,
            places.GAP,
            places.VELOCITY,
            places.ACCELERATION,
        ),
        *(REACTION, NORMAL, MOMENT, TORQUE),
        *(by_kind.PHASE, by_kind.GEOMETRY, by_kind.ENERGY, by_kind.MOMENTUM),
        *(by_kind.DEFLECTION, by_kind.SEGMENTS, by_kind.EXTENSION),
    )
}


def named(*roles: Role) -> tuple[str, ...]:
    """Return the quantities of some roles."""
    return tuple(name for name, entry in QUANTITIES.items() if entry.role in roles)


MOVES: Collection[Role] = ("drive", "place", "closure", "derived")
"""The roles of the quantities compared in every run."""
