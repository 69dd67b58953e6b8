"""Gears and cams of a system: their relations, as constraints of coordinates of nodes.

A constraint takes the coordinates of two nodes. Where gears relate the angles of three bodies, a
node without mass has two of them, given by two constraints, and a third one takes both to the third
body; all exert couples alone. exudyn needs the value of a cam's relation and its derivatives at
each iteration, by functions in Python.
"""

import math
from typing import Any

import numpy as np

from models.array import Array
from models.errors import EngineError
from models.scene import GROUND
from models.scene.joints import less, local_point, turned
from models.scene.pairs import CamPair, Gear
from sim.exudyn.system import ANGLE, Index, PlaneSystem

NODE = 3
"""Number of the coordinates of a node: its place, its angle."""


def add_gear(made: PlaneSystem, gear: Gear) -> None:
    """Add the constraints of a pair of gears; angles of nodes count from the start."""
    terms = [(body, factor) for body, factor in gear.relation.items() if body != GROUND and factor]
    (first, one), (second, two), *others = terms
    if not others:
        ends = [made.coordinate_marker(first), made.coordinate_marker(second)]
        made.add("ObjectConnectorCoordinate", markerNumbers=ends, factor1=-two / one)
        return
    both = _node_of(made, first, second)
    ((third, last),) = others
    made.add(
        "ObjectConnectorCoordinateVector",
        markerNumbers=_markers(made, both, made.node[third]),
        scalingMarker0=[[1.0, two / one]],
        scalingMarker1=[[0.0] * ANGLE + [-last / one]],
        offset=[-last / one * made.start_rad[third]],  # such markers count from 0, not the start
    )


def _node_of(made: PlaneSystem, *bodies: str) -> Index:
    """Add a node without mass for the angles of some bodies."""
    zero = [0.0 for _ in bodies]
    node = made.add(
        "NodeGenericODE2",
        referenceCoordinates=zero,
        initialCoordinates=zero,
        initialCoordinates_t=[made.state.omega[body] for body in bodies],
        numberOfODE2Coordinates=len(bodies),
    )
    for coordinate, body in enumerate(bodies):
        own = made.add("MarkerNodeCoordinate", nodeNumber=node, coordinate=coordinate)
        ends = [own, made.coordinate_marker(body)]
        made.add("ObjectConnectorCoordinate", markerNumbers=ends)
    return node


def _markers(made: PlaneSystem, *nodes: Index) -> list[Index]:
    return [made.add("MarkerNodeCoordinates", nodeNumber=node) for node in nodes]


def add_cam(made: PlaneSystem, pair: CamPair) -> None:
    """Add the constraint of a cam. Raises EngineError for a moving carrier."""
    if pair.carrier != GROUND:
        raise EngineError(
            f"cams.{pair.name}: a cam on a moving carrier, {pair.carrier}, is not offered by "
            "crankcheck in exudyn; use another engine"
        )
    (way, ahead), none = _follower(made, pair), np.zeros((1, NODE))

    def row(slope: float) -> Array:
        return np.array([*none[0, :ANGLE], -slope, *way])

    def value(_: Any, time_s: float, item: int, q: Any, rates: Any, at_rates: bool) -> list[float]:
        lift, slope, _ = pair.lift(float(q[ANGLE]))
        if at_rates:
            return [float(row(slope) @ np.asarray(rates))]
        return [float(way @ np.asarray(q)[NODE:]) + ahead - lift]

    def jacobian(_: Any, time_s: float, item: int, q: Any, rates: Any, at_rates: bool) -> Array:
        return row(pair.lift(float(q[ANGLE]))[1])[None]

    made.add(
        "ObjectConnectorCoordinateVector",
        markerNumbers=_markers(made, made.node[pair.cam], made.node[pair.follower]),
        scalingMarker0=none,  # for their number of rows
        scalingMarker1=none,
        constraintUserFunction=value,
        jacobianUserFunction=jacobian,
    )


def _follower(made: PlaneSystem, pair: CamPair) -> tuple[Array, float]:
    """Return the follower's coordinate beyond its lowest, by the coordinates of its node: their
    factors (3,), and a constant."""
    scene, body = made.scene, pair.follower
    angle, lowest = made.start_rad[body], pair.lowest(scene.points_of, scene.sliders)
    if not pair.slider:
        whole = math.tau * round((angle - lowest) / math.tau)
        return np.array([0.0, 0.0, 1.0]), -lowest - whole
    slider = scene.sliders[pair.slider]
    u = turned((1.0, 0.0), slider.direction_rad)
    # The lever of the point, so that the force acts there, and not at the node.
    tip = turned(less(local_point(scene, body, slider.point), made.centre[body]), angle)
    lever = u[1] * tip[0] - u[0] * tip[1]
    x, y = less(tip, slider.through_m)
    return np.array([*u, lever]), u[0] * x + u[1] * y - lever * angle - lowest
