"""What acts on the bodies of a space in one step, added up."""

from __future__ import annotations

from collections.abc import Iterable

import pymunk

from models.joints import less
from models.poses import Frame
from models.scene import Point

Push = tuple[float, float, float]
"""A force [N] and a moment [N m]."""
NONE: Push = (0.0, 0.0, 0.0)


def moves_freely(body: pymunk.Body) -> bool:
    """Whether pushes move a body: it is neither the ground nor driven."""
    return bool(body.body_type == pymunk.Body.DYNAMIC)


class Pushes:
    """Forces at the origins of bodies with moments about them, by body, and what of that acts on
    slider blocks without mass, which pass it on, by slider."""

    def __init__(self, bodies: Iterable[str], blocks: Iterable[str]) -> None:
        self.on_bodies = dict.fromkeys(bodies, NONE)
        self.on_blocks = dict.fromkeys(blocks, NONE)

    def torque(self, body: str, size: float) -> None:
        """Add a torque [N m]."""
        self.on_bodies[body] = _sum(self.on_bodies[body], (0.0, 0.0, size))

    def force(self, body: str, frame: Frame, place: Point, force: Point) -> None:
        """Add a force [N] on a body, whose frame stands there, at a place of the plane [m]."""
        x, y = less(place, frame.origin)
        push = force[0], force[1], x * force[1] - y * force[0]
        self.on_bodies[body] = _sum(self.on_bodies[body], push)

    def note(self, slider: str, push: Push) -> None:
        """Say what acts on a block without mass, beside the bodies that take it."""
        self.on_blocks[slider] = _sum(self.on_blocks[slider], push)


def _sum(a: Push, b: Push) -> Push:
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]
