"""What a body is to the equations of motion: coordinates of its own, and markers that it carries.

A marker is a place of a body with a direction, whose x, y [m] and angle [rad] in the plane depend
on the coordinates of its body alone. Joints, loads and springs ask for markers, and for nothing
else; so they need not know what a body is, and a body not what it is joined to.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from models.array import Array


@dataclass(frozen=True)
class Markers:
    """K markers at T samples: x, y [m] and angle [rad] (T, K, 3), their derivatives by the n
    coordinates (T, K, 3, n), and their accelerations where the q'' are 0, (T, K, 3)."""

    place: Array
    gradient: Array
    drift: Array


class BodySet(Protocol):
    """One body, or several that are worked out together, with a slice of the coordinates: its own
    n, as its markers are its own K."""

    @property
    def size(self) -> int:
        """n."""

    def mark(self, q: Array, rates: Array) -> Markers:
        """Its markers at coordinates and rates (T, n)."""

    def weigh(self, q: Array, rates: Array) -> tuple[Array, Array]:
        """Its mass matrix (T, n, n); and, on the right side, its weight, what of inertia goes with
        the squares of rates, and what it does if it is elastic, (T, n)."""

    def height_energy(self, q: Array) -> Array:
        """The potential energy of its weight [J], (T,), and of its elasticity."""
