"""Tolerances of each kind of motion and of links, by their names in `--tol`.

Apart from the quantities, as it reads all entries, also those of others.
"""

from collections.abc import Mapping

from reports.quantities import MOVES, QUANTITIES
from reports.quantities.quantity import Role, Tolerance, tolerance_name

_OWN = {
    tolerance_name(name, each.source): (entry.role, each)
    for name, entry in QUANTITIES.items()
    for each in entry.criteria
}


def _of(*roles: Role) -> Mapping[str, Tolerance]:
    return {name: each.tolerance for name, (role, each) in _OWN.items() if role in roles}


DEFAULTS = _of(*MOVES, "force")
"""Tolerances of a driven mechanism."""
BENDING = _of("elastic")
"""Tolerances of elastic links themselves."""
ELASTIC = {**DEFAULTS, **BENDING}
"""Tolerances of a mechanism whose links bend."""
_FREE = _of("free")
FREE: Mapping[str, Tolerance] = {
    name: limit for name, (_, each) in _OWN.items() if (limit := _FREE.get(name, each.free_motion))
}
"""Tolerances of free motion: its errors at the same time are over the sensitivity of the motion."""
FREE_ELASTIC = {**FREE, **BENDING}
"""Tolerances of free motion of links that bend."""
EVERY = tuple(dict.fromkeys((*DEFAULTS, *FREE, *ELASTIC)))
"""Names of all tolerances."""
