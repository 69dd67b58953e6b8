"""Tolerances of each kind of motion and of links, by the names that `--tol` has for them.

Apart from the quantities, as it reads all entries, also those of others.
"""

from collections.abc import Mapping

from reports.quantities import MOVES, QUANTITIES
from reports.quantities.quantity import Tolerance, tolerance_name

_OWN = {
    tolerance_name(name, each.source): (entry.role, each)
    for name, entry in QUANTITIES.items()
    for each in entry.criteria
}
DRIVEN = (*MOVES, "force")
DEFAULTS: Mapping[str, Tolerance] = {
    name: each.tolerance for name, (role, each) in _OWN.items() if role in DRIVEN
}
"""Of a mechanism that is driven."""
BENDING: Mapping[str, Tolerance] = {
    name: each.tolerance for name, (role, each) in _OWN.items() if role == "elastic"
}
"""Of elastic links themselves."""
ELASTIC = {**DEFAULTS, **BENDING}
"""Of a mechanism whose links bend."""
FREE: Mapping[str, Tolerance] = {
    name: limit
    for name, (role, each) in _OWN.items()
    if (limit := each.tolerance if role == "free" else each.free_motion)
}
"""Of free motion: its errors at the same time are over the sensitivity of the motion."""
FREE_ELASTIC = {**FREE, **BENDING}
"""Of free motion of links that bend."""
EVERY = tuple(dict.fromkeys((*DEFAULTS, *FREE, *ELASTIC)))
"""All that there may be a limit of."""
