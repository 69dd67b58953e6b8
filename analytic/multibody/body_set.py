"""What a body is to the equations of motion: coordinates of its own, and markers that it carries.

A marker is a place of a body with a direction, whose x, y [m] and angle [rad] in the plane depend
on the coordinates of its body alone. Joints, loads and springs ask for markers, and for nothing
else; so they need not know what a body is, and a body not what it is joined to.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

from models.array import Array, Mask
from models.scene import Point


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

    @property
    def angular(self) -> Mask:
        """Which of the coordinates are in radians, and not in metres, (n,)."""

    def mark(self, q: Array, rates: Array) -> Markers:
        """Its markers at coordinates and rates (T, n)."""

    def weigh(self, q: Array, rates: Array) -> tuple[Array, Array]:
        """Its mass matrix (T, n, n); and, on the right side, its weight, what of inertia goes with
        the squares of rates, and what it does if it is elastic, (T, n)."""

    def height_energy(self, q: Array) -> Array:
        """The potential energy of its weight [J], (T,), and of its elasticity."""

    def lost(self, rates: Array) -> Array:
        """The power that damping of its own takes [W], (T,)."""


class FlexibleBody(BodySet, Protocol):
    """A link that bends or stretches between two pins. Its first three coordinates are those of a
    frame, the others, its k coefficients, say how it is deformed."""

    @property
    def length_m(self) -> float:
        """Between its pins at rest."""

    @property
    def stiffness(self) -> Array:
        """(k, k): strain has the energy c K c / 2."""

    @property
    def damping(self) -> Array:
        """(k, k), for the rates of the coefficients."""

    def deflections(self, q: Array, x: Array) -> Array:
        """How far it is from the line between its pins [m] at coordinates (T, n) and places x (X,)
        from the first pin [m], (T, X); positive to the left of the way to the second."""

    def extension(self, q: Array) -> Array:
        """By how much its pins are further apart than at rest [m], (T,)."""


Marker = tuple[Point | None, float]
"""A place in the frame of a body [m], or None for its frame, and an angle against it [rad]."""


class Flexible(Protocol):
    """What makes the body of a link that is not rigid, of the markers that are asked of it."""

    def body(self, markers: Sequence[Marker], gravity: Point) -> FlexibleBody: ...
