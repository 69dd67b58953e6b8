"""What a body is to the equations of motion: coordinates of its own, and markers that it carries.

A marker is a place of a body with a direction, whose x, y [m] and angle [rad] in the plane depend
on the coordinates of its body alone. Joints, loads and springs ask for markers, and for nothing
else; so they need not know what a body is, and a body not what it is joined to.
"""

from __future__ import annotations

from typing import Protocol

from models.array import Array


class Body(Protocol):
    """One body, or several that are worked out together, with a slice of the coordinates.

    All arrays are over T samples; n are its own coordinates, K its own markers.
    """

    @property
    def size(self) -> int:
        """n, how many coordinates it has."""

    def mark(self, q: Array, place: Array, gradient: Array) -> None:
        """Write places (T, K, 3) of its markers, and their derivatives by q (T, K, 3, n), of which
        whatever is not written is 0."""

    def drift(self, q: Array, rates: Array) -> Array:
        """The accelerations of its markers where q'' is 0, (T, K, 3)."""

    def mass(self, q: Array) -> Array:
        """Its mass matrix (T, n, n)."""

    def push(self, q: Array, rates: Array) -> Array:
        """Weights, and what of inertia goes with the squares of rates, on the right side (T, n)."""

    def height_energy(self, q: Array) -> Array:
        """The potential energy of its weight [J], (T,); with that of its elasticity, if it is
        elastic."""
