"""Cams by contact: the shape of a follower, against the facets of the profile.

::

     ________________            _
    |_______________|  face     (+)  roller: a ball of less than its radius
    _____ skin ______           (_)  capsules round the facets of the cam

The facets have a skin, as engines take segments for thick; the follower is so much smaller, or
farther away, that both touch where the follower would touch the facets themselves.
"""

import math
from dataclasses import dataclass

from models.errors import EngineError
from models.scene import Point, Scene
from models.scene.cams import OscillatingFollower
from models.scene.joints import bodies, less, local_point, sliding_angle, turned
from models.scene.pairs import CamPair

SKIN = 0.02
"""Share of the roller's radius, or of that of the base circle, that the skin has."""


@dataclass(frozen=True)
class FollowerShape:
    """A roller about ``place`` of the follower's frame, or a face through it with the direction
    ``away`` from the cam; ``reach_m`` on both sides, a face is as long as the cam needs [m]."""

    place: Point
    away: Point
    roller_m: float
    skin_m: float
    reach_m: float


def follower_shape(scene: Scene, pair: CamPair) -> FollowerShape:
    """Return the shape of the follower of a cam by contact. Raises EngineError for a follower
    without a body, a knife edge, and an outline that is not given."""
    follower, body = pair.profile.follower, pair.follower
    for fault, words in (
        (follower.contact == "knife", "a knife edge slips off corners; give it a roller"),
        (body not in bodies(scene), f"{body} is no body; give its slider a mass_kg above 0"),
        (len(pair.outline) != pair.facets, "no outline; see `analytic.cams.outline.outlined`"),
    ):
        if fault:
            raise EngineError(f"cams.{pair.name} by contact: {words}, or facets = 0")
    farthest = max(math.hypot(*point) for point in pair.outline)
    skin = SKIN * (pair.profile.base_m if follower.is_flat else follower.roller_m)
    if not isinstance(follower, OscillatingFollower):
        slider = scene.sliders[pair.slider]
        away = turned((1.0, 0.0), slider.direction_rad - sliding_angle(slider))
        place = local_point(scene, body, slider.point)
        centre = scene.points_of[pair.carrier][pair.pivots(scene.points_of)[0]]
        beside = math.dist(slider.through_m, centre)
        return FollowerShape(place, away, follower.roller_m, skin, 2.0 * (farthest + beside))
    pivot, tip = (
        local_point(scene, body, name) for name in (pair.pivots(scene.points_of)[1], pair.tip)
    )
    x, y = less(tip, pivot)
    arm = math.hypot(x, y)
    away = pair.side * y / arm, -pair.side * x / arm
    if follower.is_flat:
        tip = pivot[0] + follower.face_m * away[0], pivot[1] + follower.face_m * away[1]
    return FollowerShape(tip, away, follower.roller_m, skin, 2.0 * (farthest + follower.pivot_m))
