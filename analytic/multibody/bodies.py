"""Bodies in the equations of motion: coordinates of their own, and markers that they carry.

A marker is a place of a body with a direction, whose x, y [m] and angle [rad] in the plane depend
on the coordinates of its body alone. Joints, loads and springs use markers alone; so they are
independent of the kind of body, and a body of its joints.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from models.array import Array, Mask
from models.scene import Point, Scene
from models.scene.joints import block_name


@dataclass(frozen=True)
class Markers:
    """Markers, K at T samples: x, y [m] and angle [rad] (T, K, 3), their derivatives by the n
    coordinates (T, K, 3, n), and their accelerations where the q'' are 0, (T, K, 3)."""

    place: Array
    gradient: Array
    drift: Array


class BodySet(Protocol):
    """One body, or several computed together, with a slice of the coordinates: its own n, as its
    markers are its own K."""

    @property
    def size(self) -> int:
        """Number of coordinates, n."""

    @property
    def angular(self) -> Mask:
        """Mask of the coordinates in radians, not in metres, (n,)."""

    def mark(self, q: Array, rates: Array) -> Markers:
        """Return its markers at coordinates and rates (T, n)."""

    def weigh(self, q: Array, rates: Array) -> tuple[Array, Array]:
        """Return its mass matrix (T, n, n), and the right side (T, n): weight, inertia with the
        squares of rates, and elastic forces."""

    def height_energy(self, q: Array) -> Array:
        """Return the potential energy of its weight and its elasticity [J], (T,)."""

    def lost(self, rates: Array) -> Array:
        """Return the power that damping of its own takes [W], (T,)."""


class FlexibleBody(BodySet, Protocol):
    """Link that bends or stretches between two pins. Its first three coordinates are those of a
    frame, the others, its k coefficients, deform it."""

    @property
    def length_m(self) -> float:
        """Distance of its pins at rest."""

    @property
    def stiffness(self) -> Array:
        """Stiffness matrix K, (k, k): strain has the energy c K c / 2."""

    @property
    def damping(self) -> Array:
        """Damping matrix (k, k), for the rates of the coefficients."""

    def deflections(self, q: Array, x: Array) -> Array:
        """Return deflections from the line of its pins [m] at coordinates (T, n) and places x (X,)
        from the first pin [m], (T, X); positive to the left of the way to the second."""

    def extension(self, q: Array) -> Array:
        """Return the change of its pins' distance from that at rest [m], (T,)."""


Marker = tuple[Point | None, float]
"""Place in the frame of a body [m], or None for its frame, and an angle against it [rad]."""


class Flexible(Protocol):
    """Maker of the body of an elastic link, with the requested markers."""

    def body(self, markers: Sequence[Marker], gravity: Point) -> FlexibleBody: ...


@dataclass(frozen=True)
class Inertia:
    """Mass [kg], centre of mass in the frame of the body [m], and moment of inertia about it
    [kg m^2]."""

    mass: float
    centre: Point
    moment: float


def inertias(scene: Scene) -> dict[str, Inertia]:
    """Return the inertias of all links, then of all slider blocks, 0 where they need no body."""
    own = {
        name: Inertia(link.mass_kg, link.centre_m, link.inertia_kg_m2)
        for name, link in scene.links.items()
    }
    for slider in scene.sliders.values():
        if slider.link is None:
            own[block_name(slider)] = Inertia(slider.mass_kg, (0.0, 0.0), slider.inertia_kg_m2)
    return own


class RigidBodies:
    """All rigid bodies of a scene at once (`BodySet`).

    ``markers`` are the number of a body, a place in its frame [m] and an angle against it [rad].
    """

    def __init__(
        self,
        bodies: Mapping[str, Inertia],
        markers: Sequence[tuple[int, Point, float]],
        gravity: Point,
    ) -> None:
        self.size = n = 3 * len(bodies)
        self.angular = np.arange(n) % 3 == 2
        self._owner = np.array([body for body, _, _ in markers], dtype=int)
        local = np.array([place for _, place, _ in markers]).reshape(-1, 2)
        self._local_x, self._local_y = local.T
        each = list(bodies.values())
        self._mass = np.array([one.mass for one in each])
        centre = np.array([one.centre for one in each]).reshape(-1, 2)
        self._centre_x, self._centre_y = centre.T
        self._gravity = gravity
        # Parts independent of the coordinates, and the places of the others in flat arrays.
        row, at = np.arange(len(markers)), 3 * self._owner
        self._ahead = np.zeros((len(markers), 3))
        self._ahead[:, 2] = [angle for _, _, angle in markers]
        self._gradient = np.zeros((len(markers), 3, n))
        for axis in range(3):
            self._gradient[row, axis, at + axis] = 1.0
        self._turned = np.concatenate([(3 * row + axis) * n + at + 2 for axis in (0, 1)])
        x = 3 * np.arange(len(each))
        y, turn = x + 1, x + 2
        self._inertia = np.zeros((n, n))
        self._inertia[x, x] = self._inertia[y, y] = self._mass
        # By the theorem of Steiner, about the origin of the frame.
        moment = np.array([one.moment for one in each])
        self._inertia[turn, turn] = moment + self._mass * np.sum(centre**2, axis=1)
        self._coupled = np.concatenate([x * n + turn, turn * n + x, y * n + turn, turn * n + y])

    def mark(self, q: Array, rates: Array) -> Markers:
        count, owner = len(q), self._owner
        theta = q[:, 2::3]
        c, s = np.cos(theta)[:, owner], np.sin(theta)[:, owner]
        arm_x = c * self._local_x - s * self._local_y
        arm_y = s * self._local_x + c * self._local_y
        place = q.reshape(count, -1, 3)[:, owner] + self._ahead
        place[:, :, 0] += arm_x
        place[:, :, 1] += arm_y
        gradient = np.repeat(self._gradient[None], count, axis=0)
        gradient.reshape(count, -1)[:, self._turned] = np.concatenate([-arm_y, arm_x], axis=1)
        square = (rates[:, 2::3] ** 2)[:, owner]
        drift = np.zeros_like(place)
        drift[:, :, 0], drift[:, :, 1] = -square * arm_x, -square * arm_y
        return Markers(place, gradient, drift)

    def weigh(self, q: Array, rates: Array) -> tuple[Array, Array]:
        count = len(q)
        first_x, first_y = (self._mass * arm for arm in self._arms(q))  # moments of first order
        matrix = np.repeat(self._inertia[None], count, axis=0)
        matrix.reshape(count, -1)[:, self._coupled] = np.concatenate(
            [-first_y, -first_y, first_x, first_x], axis=1
        )
        square, (g_x, g_y) = rates[:, 2::3] ** 2, self._gravity
        right = np.empty((count, self.size))
        right[:, 0::3] = self._mass * g_x + square * first_x
        right[:, 1::3] = self._mass * g_y + square * first_y
        right[:, 2::3] = first_x * g_y - first_y * g_x
        return matrix, right

    def _arms(self, q: Array) -> tuple[Array, Array]:
        """Return x and y from the origin of each frame to the centre of mass, (T, B)."""
        theta = q[:, 2::3]
        c, s = np.cos(theta), np.sin(theta)
        x, y = self._centre_x, self._centre_y
        return c * x - s * y, s * x + c * y

    def height_energy(self, q: Array) -> Array:
        arm_x, arm_y = self._arms(q)
        lifted = (q[:, 0::3] + arm_x) * self._gravity[0] + (q[:, 1::3] + arm_y) * self._gravity[1]
        return np.asarray(-lifted @ self._mass)

    def lost(self, rates: Array) -> Array:
        return np.zeros(len(rates))


@dataclass(frozen=True)
class Configuration:
    """Coordinates with their rates at T samples, (T, n), and the resulting K markers: places and
    velocities (T, K, 3), derivatives of places by coordinates (T, K, 3, n), and accelerations where
    the q'' are 0 (T, K, 3)."""

    q: Array
    rates: Array
    place: Array
    gradient: Array
    velocity: Array
    drift: Array

    def some(self, samples: Mask) -> Configuration:
        """Return the configuration at some of the samples."""
        return Configuration(*(own[samples] for own in vars(self).values()))


@dataclass(frozen=True)
class EnergyBalance:
    """Energies [J], (T,): of motion; of weights, over the ground's origin, and springs; and the
    ``work`` since time 0 of the forces that do not conserve it: loads, dampers, friction."""

    kinetic: Array
    potential: Array
    work: Array

    @property
    def balance(self) -> Array:
        """Constant up to errors: energy less the work that was put in [J], (T,)."""
        return np.asarray(self.kinetic + self.potential - self.work)

    @staticmethod
    def joined(parts: Sequence[EnergyBalance]) -> EnergyBalance:
        """Join the energies of successive instants."""
        each = zip(*(vars(part).values() for part in parts), strict=True)
        return EnergyBalance(*(np.concatenate(own) for own in each))
