"""The line of an elastic link: from one of its two pins to the other."""

from __future__ import annotations

import math
from dataclasses import dataclass

from models.joints import joined_at, less, turned
from models.scene import Point, Scene


@dataclass(frozen=True)
class Line:
    """From the first of two ``pins`` to the second, in the frame of the link: from ``start`` [m],
    at ``lean_rad``, ``length_m`` long."""

    pins: tuple[str, str]
    start: Point
    lean_rad: float
    length_m: float
    density_kg_m: float

    def at(self, x: float) -> Point:
        """The place on it that is x from the first pin [m], in the frame of the link."""
        c, s = turned((x, 0.0), self.lean_rad)
        return self.start[0] + c, self.start[1] + s

    def along(self, place: Point) -> Point:
        """A place in the frame of the link as x along the line from the first pin, and y across."""
        return turned(less(place, self.start), -self.lean_rad)


def line_of(scene: Scene, link: str) -> Line:
    """The line of a link that has two pins."""
    own, joined = scene.links[link], joined_at(scene)
    first, second = (point for point in own.points if link in joined.get(point, ()))
    (ax, ay), (bx, by) = own.points[first], own.points[second]
    length = math.hypot(bx - ax, by - ay)
    lean = math.atan2(by - ay, bx - ax)
    return Line((first, second), (ax, ay), lean, length, own.mass_kg / length)
