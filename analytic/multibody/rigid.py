"""Rigid bodies: x, y [m] and theta [rad] of the frame of each, in the order of their names."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from analytic.multibody.body_set import Markers
from models.array import Array
from models.joints import block_name
from models.scene import Point, Scene


@dataclass(frozen=True)
class Inertia:
    """Mass [kg], centre of mass in the frame of the body [m], and moment of inertia about it
    [kg m^2]."""

    mass: float
    centre: Point
    moment: float


def inertias(scene: Scene) -> dict[str, Inertia]:
    """Those of all links, then of all slider blocks, which have 0 where they need no body."""
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
        # What does not depend on the coordinates, and the places of what does in flat arrays.
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
        """From the origin of each frame to the centre of mass, x and y, (T, B)."""
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
