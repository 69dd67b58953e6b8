"""The plane of a mechanism in space: that across the axis of the driven hinge."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from models.array import Array

UP, ACROSS = np.array([0.0, 0.0, 1.0]), np.array([0.0, 1.0, 0.0])


@dataclass(frozen=True, eq=False)
class Plane:
    """Unit vectors in space, (3,): ``x`` and ``y`` in the plane, ``normal`` towards who looks at
    it. Points and vectors of the plane are complex numbers; the origin is that of the world."""

    x: Array
    y: Array
    normal: Array

    @staticmethod
    def across(axis: Array) -> Plane:
        """The plane across an axis, seen from where the axis points to: counter-clockwise is
        positive. Up is what is up in the world, or the y-axis of the world for the x-y plane."""
        normal = axis / np.linalg.norm(axis)
        up = UP if abs(normal @ UP) < 0.99 else ACROSS
        y = up - (up @ normal) * normal
        y /= np.linalg.norm(y)
        return Plane(np.cross(y, normal), y, normal)

    def flat(self, vector: Array) -> complex:
        """The part of a point or vector in space (3,) that lies in the plane."""
        return complex(vector @ self.x, vector @ self.y)

    def height(self, vector: Array) -> float:
        """Its part across the plane."""
        return float(vector @ self.normal)

    def off_normal_deg(self, axis: Array) -> float:
        """By how much an axis is off the normal, whichever way it points [deg]."""
        return math.degrees(
            math.atan2(float(np.linalg.norm(np.cross(axis, self.normal))), abs(self.height(axis)))
        )

    def turned(self, rotation: Array) -> tuple[float, float]:
        """By how much a rotation (3, 3) turns within the plane [rad], and tilts out of it [deg]."""
        turn = self.flat(rotation @ self.x)
        return math.atan2(turn.imag, turn.real), self.off_normal_deg(rotation @ self.normal)
