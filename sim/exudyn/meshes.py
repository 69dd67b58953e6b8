"""Gears of a system: their relation of angles, as constraints of coordinates.

A constraint takes the coordinates of two nodes. Where a relation holds the angles of three bodies,
a node without mass has two of them, given by two constraints, and a third one takes both to the
third body. All exert couples alone.
"""

from models.scene import GROUND
from models.scene.pairs import Gear
from sim.exudyn.system import ANGLE, Index, PlaneSystem


def add_mesh(made: PlaneSystem, gear: Gear) -> None:
    """Add the constraints of a pair of gears; angles of nodes count from the start."""
    terms = [(body, factor) for body, factor in gear.relation.items() if body != GROUND and factor]
    (first, one), (second, two), *others = terms
    if not others:
        ends = [made.coordinate_marker(first), made.coordinate_marker(second)]
        made.add("ObjectConnectorCoordinate", markerNumbers=ends, factor1=-two / one)
        return
    both = _node_of(made, first, second)
    ((third, last),) = others
    ends = [made.add("MarkerNodeCoordinates", nodeNumber=n) for n in (both, made.node[third])]
    made.add(
        "ObjectConnectorCoordinateVector",
        markerNumbers=ends,
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
