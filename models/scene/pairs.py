"""Higher pairs of a scene: gears in mesh, rolling on their pitch circles; cams with a follower.

::

      external pair, a = m (z0 + z1)/2            internal pair, a = m (z1 - z0)/2

         ( 0 o )( o   1   )                          ( o ( 0 o )   1  )
             |____|   carrier                          |_____|   carrier
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from models.array import Array
from models.scene.cam_laws import CamLift
from models.scene.cams import Cam

Points = Mapping[str, tuple[float, float]]


class Slides(Protocol):
    """Line of a slider in the frame of its guide."""

    @property
    def through_m(self) -> tuple[float, float]: ...

    @property
    def direction_rad(self) -> float: ...


def shared_point(points: Mapping[str, Points], body: str, carrier: str) -> str:
    """Return the point that a body shares with its carrier. Raises ValueError unless it is one."""
    shared = [point for point in points[body] if point in points[carrier]]
    if len(shared) != 1:
        raise ValueError(
            f"{body} shares {' and '.join(shared) or 'no point'} with its carrier {carrier}; it "
            "turns on its carrier about one point: list that, its centre, in both"
        )
    return shared[0]


@dataclass(frozen=True)
class CamPair:
    """A cam, ``cam``, a link that turns about a point of the ``carrier``, and its follower.

    A translating ``follower`` is the body of ``slider``, whose guide is the carrier; an oscillating
    one is a link pinned to the carrier, and ``tip`` the centre of its roller, or a point on the
    parallel of its face through the pivot. The tip lies to the right of the line from the pivot to
    the cam with ``side`` +1, and lifts turn it further. The law of ``profile`` begins at the angle
    ``start_rad`` of the cam against the carrier.

    Engines hold it as a relation of the two or, with ``facets`` above 0, by contact of the follower
    with the ``outline``: as many points of the profile in the frame of the cam's link [m], in the
    order of its law (`analytic.cams.outline`).
    """

    name: str
    cam: str
    follower: str
    carrier: str
    profile: Cam
    slider: str = ""
    tip: str = ""
    side: int = 1
    start_rad: float = 0.0
    facets: int = 0
    outline: tuple[tuple[float, float], ...] = ()

    @property
    def sense(self) -> int:
        """Sense in which its law counts the angle of the cam, +1 counter-clockwise."""
        return self.profile.sense * (1 if self.slider else self.side)

    def law_angle(self, cam_rad: Array, carrier_rad: Array | float) -> Array:
        """Return the angle of its law (T,) [rad] at angles of cam and carrier."""
        return np.asarray(self.sense * (cam_rad - carrier_rad - self.start_rad))

    def law_at(self, theta: Mapping[str, Array]) -> CamLift:
        """Return its law at the angles of bodies (T,) [rad]; the ground has none."""
        return self.profile.law.at(self.law_angle(theta[self.cam], theta.get(self.carrier, 0.0)))

    def lift(self, turned_rad: float) -> tuple[float, float, float]:
        """Return the follower's coordinate beyond its lowest, and its first two derivatives by the
        angle of the cam against the carrier, at one such angle."""
        value, first, second, _ = self.profile.law.at_one(
            self.sense * (turned_rad - self.start_rad)
        )
        return self.way * value, self.way * self.sense * first, self.way * second

    def pivots(self, points: Mapping[str, Points]) -> tuple[str, str]:
        """Return the names of the cam's centre and, of an oscillating follower, its pivot, else
        "". Raises ValueError where they are not shared with the carrier, or several."""
        centre = shared_point(points, self.cam, self.carrier)
        return centre, "" if self.slider else shared_point(points, self.follower, self.carrier)

    def lowest(self, points: Mapping[str, Points], sliders: Mapping[str, Slides]) -> float:
        """Return the follower's coordinate at lift 0: the displacement of its slider [m], or the
        angle of its link against the carrier [rad]. Raises ValueError as `pivots`."""
        centre, pivot = self.pivots(points)
        ox, oy = points[self.carrier][centre]
        if self.slider:
            line = sliders[self.slider]
            (tx, ty), angle = line.through_m, line.direction_rad
            foot = (ox - tx) * math.cos(angle) + (oy - ty) * math.sin(angle)
            return foot + self.profile.start
        px, py = points[self.carrier][pivot]
        (ax, ay), (bx, by) = (points[self.follower][name] for name in (pivot, self.tip))
        towards = math.atan2(oy - py, ox - px)
        return towards - self.side * self.profile.start - math.atan2(by - ay, bx - ax)

    @property
    def way(self) -> int:
        """Sense of the follower's coordinate over its lift."""
        return 1 if self.slider else -self.side


FITS = 1e-6
"""Largest difference between the centre distance and that of module and teeth, over it."""


@dataclass(frozen=True)
class Gear:
    """Two gears in mesh: ``bodies``, links or the ground (a fixed gear), with ``teeth``, on centres
    carried by ``carrier``, a link or the ground.

    Their relation is z0 (theta0 - theta_c) + s z1 (theta1 - theta_c) = const, with s = +1 for an
    external pair, and -1 for an ``internal`` one, whose second gear is the ring. ``efficiency`` is
    that of the mesh with its carrier at rest. Without ``module_m`` the module follows from the
    centre distance (`module`), and is that of the working pitch circles.
    """

    name: str
    bodies: tuple[str, str]
    teeth: tuple[int, int]
    carrier: str = "ground"
    internal: bool = False
    module_m: float | None = None
    pressure_angle_rad: float = math.radians(20)
    efficiency: float = 1.0
    phase_rad: float = 0.0

    @property
    def constant_rad(self) -> float:
        """The constant of its relation [rad]."""
        return self.second * self.phase_rad

    @property
    def relation(self) -> Mapping[str, int]:
        """Coefficients of its relation between angles, by body: they sum to 0, so that of the
        ground (angle 0) may be left out."""
        first, second = self.teeth[0], self.second
        return {self.bodies[0]: first, self.bodies[1]: second, self.carrier: -(first + second)}

    @property
    def second(self) -> int:
        """Teeth of the second gear, negative for a ring."""
        return -self.teeth[1] if self.internal else self.teeth[1]

    def pivots(self, points: Mapping[str, Points]) -> tuple[str, str]:
        """Return the names of the two centres, which a gear and the carrier share; ``points`` are
        those of all bodies, the ground's too. Raises ValueError where there is none, or several."""
        first, second = (shared_point(points, body, self.carrier) for body in self.bodies)
        return first, second

    def distance_m(self, points: Mapping[str, Points]) -> float:
        """Return the centre distance. Raises ValueError as `pivots`."""
        first, second = (points[self.carrier][point] for point in self.pivots(points))
        return math.dist(first, second)

    def module(self, points: Mapping[str, Points]) -> float | None:
        """Return the module [m], given or from the centre distance: None for two gears about one
        centre, a relation without a mesh. Raises ValueError as `pivots`."""
        found = 2.0 * self.distance_m(points) / abs(self.teeth[0] + self.second)
        return self.module_m if self.module_m is not None else found or None

    def slip_m(self, points: Mapping[str, Points]) -> float:
        """Return the slip of the pitch circles [m] at 1 of the relation: half the module; about
        one centre, without a mesh, such that the larger gear has a radius of 1 m."""
        module = self.module(points)
        return 0.5 * module if module is not None else 1.0 / max(self.teeth)
