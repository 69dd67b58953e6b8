"""Poses of the links' own frames, from the coordinates that exudyn has of their nodes: those of
centres of mass, or places and tangents of beams."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from models.array import Array
from models.scene import Point
from sim.engine import BodyPose
from sim.exudyn.plane_system import PlaneSystem

LEVELS = ("Coordinates", "Coordinates_t", "Coordinates_tt")


def widths(made: PlaneSystem) -> list[int]:
    """How many coordinates each node has, in turn: x, y, angle, or x, y and the tangent's."""
    return [4 if name in made.looked else 3 for name in made.node]


def beam_angles(
    made: PlaneSystem, looked: Mapping[str, float], levels: Sequence[Array]
) -> dict[str, Array]:
    """Angles of the tangents of nodes of beams, the first within half a turn of where they
    ``looked`` [rad] and each within that of the one before: of samples of every step, or turns are
    lost."""
    angles = {}
    for row, (name, node) in enumerate(made.node.items()):
        if name in looked:
            place = levels[len(LEVELS) * row] + made.system.GetNode(node)["referenceCoordinates"]
            turned = np.arctan2(place[:, 3], place[:, 2])
            angles[name] = np.unwrap(np.concatenate([[looked[name]], turned]))[1:]
    return angles


def body_poses(
    made: PlaneSystem, levels: Sequence[Array], angles: Mapping[str, Array]
) -> dict[str, BodyPose]:
    """Poses by body, of samples (T, width) of the three levels of each node in turn, and of the
    ``angles`` (T,) of nodes of beams."""
    poses = {}
    for row, (name, node) in enumerate(made.node.items()):
        moved, rate, push = (levels[len(LEVELS) * row + k] for k in range(len(LEVELS)))
        place = moved + made.system.GetNode(node)["referenceCoordinates"]
        if name in angles:
            poses[name] = _tangent_pose(place, rate, push, angles[name])
        else:
            poses[name] = _pose(place, rate, push, made.centre[name])
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


def _tangent_pose(place: Array, rate: Array, push: Array, theta: Array) -> BodyPose:
    """A frame along the tangent of a beam, which is at those angles."""
    (x, y), (u, v), (a, b) = (each[:, 2:].T for each in (place, rate, push))
    far = x**2 + y**2
    omega = (x * v - y * u) / far
    return BodyPose(
        origin=place[:, :2],
        theta=theta,
        velocity=rate[:, :2],
        omega=omega,
        origin_acceleration=push[:, :2],
        alpha=(x * b - y * a) / far - 2.0 * omega * (x * u + y * v) / far,
    )
