"""Rods on a free or ball joint that pins hold in the plane: their coordinates there, and back.

A rod is held by two pins, or by one beside its ball joint. It may turn about the line through them,
which moves nothing in the plane; so the angle is that of this line, and the place that of a pin.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import mujoco  # type: ignore[import-untyped]  # ships no stubs
import numpy as np

from models.array import Array


@dataclass(frozen=True, eq=False)
class HeldRod:
    """A rod, by the first columns of its quaternion in qpos, and of its angular speed in qvel.

    The rows of ``axes`` (3, 3) are the x-axis, the y-axis and the normal of the plane in the frame
    that the joint moves in; ``turned`` is the quaternion as drawn, ``arm`` leads to a pin and
    ``line`` to the other, in the frame of the rod; ``place`` is that pin as drawn, None for a ball.
    """

    position: int
    rate: int
    axes: Array
    turned: Array
    arm: Array
    line: Array
    place: Array | None

    @property
    def count(self) -> int:
        """Number of coordinates in the plane."""
        return 1 if self.place is None else 3

    def seen(self, q: Array, rate: Array, push: Array) -> tuple[Array, Array, Array]:
        """Return places along x and y (not of a ball) and the angle, with their first and second
        rates, (T, count) each, from all coordinates (T, nq) and their rates (T, nv)."""
        at, dof = self.position, self.rate
        turns = np.array([matrix_of(row) for row in q[:, at : at + 4]])
        normal = self.axes[2]
        spin, swing = (
            np.einsum("tij,tj->ti", turns, each[:, dof : dof + 3]) for each in (rate, push)
        )
        line, drawn = turns @ self.line, matrix_of(self.turned) @ self.line
        angle = np.unwrap(_angle(self.axes @ line.T)) - _angle(self.axes @ drawn)
        rows = [angle[:, None], (spin @ normal)[:, None], (swing @ normal)[:, None]]
        if self.place is not None:
            arm, flat = turns @ self.arm, self.axes[:2].T
            turning = np.cross(spin, arm)
            moved = (
                q[:, at - 3 : at] + arm - self.place,
                rate[:, dof - 3 : dof] + turning,
                push[:, dof - 3 : dof] + np.cross(swing, arm) + np.cross(spin, turning),
            )
            rows = [np.hstack([m @ flat, row]) for m, row in zip(moved, rows, strict=True)]
        return rows[0], rows[1], rows[2]

    def put(self, data: Any, q: Array, rate: Array) -> None:
        """Set qpos and qvel to coordinates in the plane (count,) and their rates."""
        at, dof = self.position, self.rate
        turn, quaternion = np.empty(4), np.empty(4)
        mujoco.mju_axisAngle2Quat(turn, self.axes[2], q[-1])
        mujoco.mju_mulQuat(quaternion, turn, self.turned)
        matrix, spin = matrix_of(quaternion), rate[-1] * self.axes[2]
        data.qpos[at : at + 4], data.qvel[dof : dof + 3] = quaternion, matrix.T @ spin
        if self.place is not None:
            arm = matrix @ self.arm
            data.qpos[at - 3 : at] = self.place + q[:2] @ self.axes[:2] - arm
            data.qvel[dof - 3 : dof] = rate[:2] @ self.axes[:2] - np.cross(spin, arm)


def _angle(vector: Array) -> Array:
    return np.asarray(np.arctan2(vector[1], vector[0]))


def matrix_of(quaternion: Array) -> Array:
    """Return the rotation (3, 3) of a quaternion (4,) of any length."""
    matrix, unit = np.empty(9), np.array(quaternion, dtype=np.float64)
    mujoco.mju_normalize4(unit)
    mujoco.mju_quat2Mat(matrix, unit)
    return matrix.reshape(3, 3)
