"""Poses of the links' own frames, from the coordinates that exudyn has of their centres of mass."""

from __future__ import annotations

import numpy as np

from models.array import Array
from models.scene import Point
from sim.engine import BodyPose
from sim.exudyn.system import PlaneSystem

LEVELS = ("Coordinates", "Coordinates_t", "Coordinates_tt")
WIDTH = 3
"""Coordinates of a body: x, y, angle."""


def body_poses(made: PlaneSystem, levels: Array) -> dict[str, BodyPose]:
    """Poses by body, of samples of the three levels of each body in turn."""
    poses = {}
    for row, (name, node) in enumerate(made.node.items()):
        place, rate, push = (levels[:, len(LEVELS) * row + k] for k in range(len(LEVELS)))
        reference = made.system.GetNode(node)["referenceCoordinates"]
        poses[name] = _pose(place + reference, rate, push, made.centre[name])
    return poses


def _pose(place: Array, rate: Array, push: Array, centre: Point) -> BodyPose:
    """The frame in which ``centre`` is where the node is, from coordinates and their rates."""
    theta, omega, alpha = place[:, 2], rate[:, 2], push[:, 2]
    c, s = np.cos(theta), np.sin(theta)
    arm = np.stack([c * centre[0] - s * centre[1], s * centre[0] + c * centre[1]], axis=-1)
    across = np.stack([-arm[:, 1], arm[:, 0]], axis=-1)
    return BodyPose(
        origin=place[:, :2] - arm,
        theta=theta,
        velocity=rate[:, :2] - omega[:, None] * across,
        omega=omega,
        origin_acceleration=push[:, :2] - alpha[:, None] * across + omega[:, None] ** 2 * arm,
        alpha=alpha,
    )
