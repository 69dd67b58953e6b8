"""Rigid bodies: x, y [m] and theta [rad] of the frame of each, in the order of their names."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

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
    """All rigid bodies of a scene at once (`Body`).

    ``markers`` are the number of a body, a place in its frame [m] and an angle against it [rad].
    """

    def __init__(
        self,
        bodies: Mapping[str, Inertia],
        markers: Sequence[tuple[int, Point, float]],
        gravity: Point,
    ) -> None:
        self.size = 3 * len(bodies)
        self._owner = np.array([body for body, _, _ in markers], dtype=int)
        self._local = np.array([place for _, place, _ in markers], dtype=float).reshape(-1, 2)
        self._ahead = np.array([angle for _, _, angle in markers])
        self._row = np.arange(len(markers))
        each = list(bodies.values())
        self._mass = np.array([one.mass for one in each])
        self._centre = np.array([one.centre for one in each]).reshape(-1, 2)
        # By the theorem of Steiner, about the origin of the frame.
        self._moment = np.array([one.moment for one in each]) + self._mass * np.sum(
            self._centre**2, axis=1
        )
        self._gravity = np.array(gravity)
        self._first = 3 * np.arange(len(each))

    def _frames(self, q: Array) -> Array:
        return q.reshape(len(q), -1, 3)

    def _arms(self, q: Array, owner: Array | slice, local: Array) -> tuple[Array, Array]:
        """From the origin of the frame to places of bodies, x and y, (T, K)."""
        theta = self._frames(q)[:, owner, 2]
        c, s = np.cos(theta), np.sin(theta)
        x, y = local[:, 0], local[:, 1]
        return c * x - s * y, s * x + c * y

    def mark(self, q: Array, place: Array, gradient: Array) -> None:
        arm_x, arm_y = self._arms(q, self._owner, self._local)
        place[:] = self._frames(q)[:, self._owner]
        place[:, :, 0] += arm_x
        place[:, :, 1] += arm_y
        place[:, :, 2] += self._ahead
        row, at = self._row, 3 * self._owner
        gradient[:, row, 0, at] = gradient[:, row, 1, at + 1] = gradient[:, row, 2, at + 2] = 1.0
        gradient[:, row, 0, at + 2] = -arm_y
        gradient[:, row, 1, at + 2] = arm_x

    def drift(self, q: Array, rates: Array) -> Array:
        square = rates.reshape(len(q), -1, 3)[:, self._owner, 2] ** 2
        arm_x, arm_y = self._arms(q, self._owner, self._local)
        towards = np.zeros((*square.shape, 3))
        towards[:, :, 0], towards[:, :, 1] = -square * arm_x, -square * arm_y
        return towards

    def mass(self, q: Array) -> Array:
        arm_x, arm_y = self._arms(q, slice(None), self._centre)
        matrix, x = np.zeros((len(q), self.size, self.size)), self._first
        y, turn = x + 1, x + 2
        matrix[:, x, x] = matrix[:, y, y] = self._mass
        matrix[:, x, turn] = matrix[:, turn, x] = -self._mass * arm_y
        matrix[:, y, turn] = matrix[:, turn, y] = self._mass * arm_x
        matrix[:, turn, turn] = self._moment
        return matrix

    def push(self, q: Array, rates: Array) -> Array:
        arm_x, arm_y = self._arms(q, slice(None), self._centre)
        square = rates[:, 2::3] ** 2
        g_x, g_y = self._gravity
        right = np.empty((len(q), self.size))
        right[:, 0::3] = self._mass * (g_x + square * arm_x)
        right[:, 1::3] = self._mass * (g_y + square * arm_y)
        right[:, 2::3] = self._mass * (arm_x * g_y - arm_y * g_x)
        return right

    def height_energy(self, q: Array) -> Array:
        arm_x, arm_y = self._arms(q, slice(None), self._centre)
        lifted = (q[:, 0::3] + arm_x) * self._gravity[0] + (q[:, 1::3] + arm_y) * self._gravity[1]
        return np.asarray(-lifted @ self._mass)
