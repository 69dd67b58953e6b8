"""Mobility of a scheme: by count, by rank in the drawn position and next to it, with names for what
makes the difference.

W by count is that of Kutzbach and Gruebler (Artobolevskii's and Chebyshev's form, with classes of
joints). The real mobility is how many motions the loops leave next to the drawn position, as far as
these are no motions of first order alone. Real less count are the passive constraints; idle
freedoms are in both.
"""

from __future__ import annotations

from dataclasses import dataclass

from analytic.lectures.schemes.idle import Idle, idle_freedoms
from analytic.lectures.schemes.neighbourhood import Neighbourhood, neighbourhood
from analytic.lectures.schemes.passive import Passive, passive_constraints
from analytic.lectures.schemes.scheme_loops import Loops
from models.lectures.scheme import Scheme

NEARLY = 1e-3
"""Of what holds most: a file's numbers are often given to three or four digits."""


@dataclass(frozen=True)
class SchemeMobility:
    """How many motions a scheme has, and why that is not its count."""

    scheme: Scheme
    near: Neighbourhood
    passive: Passive
    idle: tuple[Idle, ...]

    @property
    def real(self) -> int:
        """The number of motions that the scheme has indeed."""
        return self.near.finite

    @property
    def rank(self) -> int:
        """How many of the constraints are independent next to the drawn position."""
        return self.scheme.constraints - int(self.near.moves.shape[1]) + self.scheme.count

    @property
    def spare(self) -> int:
        """The number of passive constraints: those that take no motion away."""
        return self.real - self.scheme.count

    @property
    def yielding(self) -> int:
        """Motions of first order that give back at once: the scheme shakes, and does not move."""
        return int(self.near.moves.shape[1]) - self.near.finite

    @property
    def margin_is_small(self) -> bool:
        """Whether a motion is held by so little that rounded numbers of a file may be the cause."""
        return self.near.margin < NEARLY

    @property
    def idle_count(self) -> int:
        """The number of idle freedoms."""
        return sum(each.freedoms for each in self.idle)

    @property
    def useful(self) -> int:
        """The motions that others than the idle links have."""
        return self.real - self.idle_count


def scheme_mobility(scheme: Scheme) -> SchemeMobility:
    """Count the motions of a scheme. Raises StructureError for a link that hangs on nothing."""
    loops = Loops.of(scheme)
    near = neighbourhood(loops)
    idle = tuple(idle_freedoms(loops, near.at))
    regular = near.finite == near.moves.shape[1]
    spare = regular and near.finite > scheme.count
    passive = passive_constraints(loops, near.at, idle) if spare else Passive()
    return SchemeMobility(scheme, near, passive, idle)
