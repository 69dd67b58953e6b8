"""Higher pairs of a scene: gears in mesh, rolling on their pitch circles.

::

      external pair, a = m (z0 + z1)/2            internal pair, a = m (z1 - z0)/2

         ( 0 o )( o   1   )                          ( o ( 0 o )   1  )
             |____|   carrier                          |_____|   carrier
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

Points = Mapping[str, tuple[float, float]]
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
        centres = []
        for body in self.bodies:
            shared = [point for point in points[body] if point in points[self.carrier]]
            if len(shared) != 1:
                raise ValueError(
                    f"{body} shares {' and '.join(shared) or 'no point'} with its carrier "
                    f"{self.carrier}; a gear turns on its carrier about one point: list that, "
                    "its centre, in both"
                )
            centres.append(shared[0])
        return centres[0], centres[1]

    def distance_m(self, points: Mapping[str, Points]) -> float:
        """Return the centre distance. Raises ValueError as `pivots`."""
        first, second = (points[self.carrier][point] for point in self.pivots(points))
        return math.dist(first, second)

    def module(self, points: Mapping[str, Points]) -> float | None:
        """Return the module [m], given or from the centre distance: None for two gears about one
        centre, a relation without a mesh. Raises ValueError as `pivots`."""
        found = 2.0 * self.distance_m(points) / abs(self.teeth[0] + self.second)
        return self.module_m if self.module_m is not None else found or None
