"""Cams of a system as a relation: a constraint between the coordinates of two bodies.

exudyn asks for its value and its derivatives at each iteration, by functions in Python.
"""

import math
from typing import Any

import numpy as np

from models.array import Array
from models.errors import EngineError
from models.scene import GROUND
from models.scene.joints import less, local_point, turned
from models.scene.pairs import CamPair
from sim.exudyn.system import ANGLE, PlaneSystem

NODE = 3
"""Number of the coordinates of a node: its place, its angle."""


def add_cam(made: PlaneSystem, pair: CamPair) -> None:
    """Add the constraint of a cam. Raises EngineError for a moving carrier."""
    if pair.carrier != GROUND:
        raise EngineError(
            f"cams.{pair.name}: a cam on a moving carrier, {pair.carrier}, is not offered by "
            "crankcheck in exudyn; take another engine"
        )
    relation, none = _Relation(made, pair), np.zeros((1, NODE))
    made.add(
        "ObjectConnectorCoordinateVector",
        markerNumbers=[
            made.add("MarkerNodeCoordinates", nodeNumber=made.node[body])
            for body in (pair.cam, pair.follower)
        ],
        scalingMarker0=none,  # for their number of rows
        scalingMarker1=none,
        constraintUserFunction=relation.value,
        jacobianUserFunction=relation.jacobian,
    )


class _Relation:
    """Relation over the coordinates of cam and follower, of which the follower's is ``way`` times
    the coordinates of its node, and ``ahead``."""

    def __init__(self, made: PlaneSystem, pair: CamPair) -> None:
        scene, body = made.scene, pair.follower
        self.pair, lowest = pair, pair.lowest(scene.points_of, scene.sliders)
        if pair.slider:
            slider = scene.sliders[pair.slider]
            u = turned((1.0, 0.0), slider.direction_rad)
            tip = less(local_point(scene, body, slider.point), made.centre[body])
            angle = made.start_rad[body]
            x, y = turned(tip, angle)  # so that the force acts at the point, not at the node
            lever = u[1] * x - u[0] * y
            self.way = np.array([*u, lever])
            x, y = less((x, y), slider.through_m)
            self.ahead = u[0] * x + u[1] * y - lever * angle - lowest
        else:
            whole = math.tau * round((made.start_rad[body] - lowest) / math.tau)
            self.way, self.ahead = np.array([0.0, 0.0, 1.0]), -lowest - whole

    def _row(self, slope: float) -> Array:
        return np.concatenate([np.zeros(ANGLE), [-slope], self.way])

    def value(
        self, _: Any, time_s: float, item: int, q: Array, rates: Array, at_rates: bool
    ) -> list[float]:
        """Return the violation of the relation [m or rad], or of its rates."""
        value, slope, _ = self.pair.lift(float(q[ANGLE]))
        if at_rates:
            return [float(self._row(slope) @ np.asarray(rates))]
        return [float(self.way @ np.asarray(q)[NODE:]) + self.ahead - value]

    def jacobian(
        self, _: Any, time_s: float, item: int, q: Array, rates: Array, at_rates: bool
    ) -> Array:
        """Return the derivatives of the relation by all coordinates, (1, 6)."""
        return self._row(self.pair.lift(float(q[ANGLE]))[1])[None]
