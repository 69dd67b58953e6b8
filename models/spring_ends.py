"""Where on which bodies a spring acts, for whoever has bodies, and not a solved mechanism."""

from __future__ import annotations

import math

from models.errors import EngineError
from models.joints import carriers, local_point
from models.scene import Point, Scene
from models.springs import LineSpring, PinSpring

End = tuple[str, Point]
"""A body, or the ground, and a place in its frame [m]."""


def line_ends(scene: Scene, spring: LineSpring) -> tuple[End, End]:
    """The two ends of a spring between points, each on the first body that carries the point.

    Raises EngineError for a point that only a slider block without mass has, which is no body.
    """
    first, second = spring.points
    return _end(scene, spring, first), _end(scene, spring, second)


def _end(scene: Scene, spring: LineSpring, point: str) -> End:
    bodies = carriers(scene).get(point, ())
    if not bodies:
        raise EngineError(
            f"springs.{spring.name}: no body carries point {point}; give its slider a mass_kg "
            "above 0"
        )
    return bodies[0], local_point(scene, bodies[0], point)


def whole_turns(spring: PinSpring, angle_rad: float) -> float:
    """The whole turns [rad] to be added to the angle of the second body less that of the first at
    the start, so that the q of a spring in a pin begins within half a turn of its free angle."""
    return -math.tau * round((angle_rad - spring.free) / math.tau)
