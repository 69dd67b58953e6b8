"""What a batch of pymunk says of its bodies, a row each, and how it reads as poses."""

from __future__ import annotations

import numpy as np
import pymunk
import pymunk.batch

from models.array import Array
from models.scene import Point
from sim.engine import BodyPose
from sim.pymunk.space import SpaceModel

FIELDS = (
    pymunk.batch.BodyFields.POSITION
    | pymunk.batch.BodyFields.ANGLE
    | pymunk.batch.BodyFields.VELOCITY
    | pymunk.batch.BodyFields.ANGULAR_VELOCITY
)
WIDTH = 6
"""Numbers per body: x, y, angle, vx, vy, omega."""


def finite(rows: Array) -> int:
    """How many samples (T, bodies, numbers) are finite, up to the first that is not."""
    good = np.isfinite(rows).all(axis=(1, 2))
    return len(rows) if good.all() else int(np.argmin(good))


def rows_of(model: SpaceModel) -> dict[str, int]:
    """Which row of a batch belongs to which body; the static body of the space has one too."""
    buffer = pymunk.batch.Buffer()
    pymunk.batch.get_space_bodies(model.space, pymunk.batch.BodyFields.BODY_ID, buffer)
    order = np.frombuffer(buffer.int_buf(), dtype=np.uintp).tolist()
    return {name: order.index(body.id) for name, body in model.bodies.items()}


def pose(row: Array, centre: Point, lag_s: float) -> BodyPose:
    """The frame whose point ``centre`` is the origin of the pymunk body; no accelerations."""
    theta, omega = row[:, 2], row[:, 5]
    later = _arm(theta + lag_s * omega, centre)
    across = np.stack([-later[:, 1], later[:, 0]], axis=-1)
    none = np.full(len(theta), np.nan)
    return BodyPose(
        origin=row[:, 0:2] - _arm(theta, centre),
        theta=theta,
        velocity=row[:, 3:5] - omega[:, None] * across,
        omega=omega,
        origin_acceleration=np.full((len(theta), 2), np.nan),
        alpha=none,
    )


def _arm(theta: Array, local: Point) -> Array:
    """A vector of a body's frame in the plane (T, 2)."""
    c, s = np.cos(theta), np.sin(theta)
    return np.stack([c * local[0] - s * local[1], s * local[0] + c * local[1]], axis=-1)
