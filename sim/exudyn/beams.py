"""Beams in exudyn: cable elements in the plane, whose nodes have a place and a tangent vector.

An element is a cubic in its own length (absolute nodal coordinates); it bends by EI times the
curvature of its axis over its stretch, and stretches by EA (|r'| - 1). Source: exudyn's own manual,
ObjectANCFCable2D and NodePoint2DSlope1; J. Gerstmayr, H. Irschik, On the correct representation of
bending and axial deformation in the absolute nodal coordinate formulation, J. Sound and Vibration
318 (2008).
"""

from __future__ import annotations

import math
from collections.abc import Mapping

from models.elastic import Beam
from models.motion import State
from models.poses import Frame
from models.scene import Scene
from sim.exudyn.library import items
from sim.exudyn.plane_system import PlaneSystem

EPSILON = 2.0**-52


def add_node(made: PlaneSystem, name: str, frame: Frame, state: State) -> None:
    """Add a node of a beam: its place, and its tangent, longer than 1 by the strain there."""
    c, s = math.cos(frame.theta), math.sin(frame.theta)
    long, faster = 1.0 + state.strain.get(name, 0.0), state.strain_rate.get(name, 0.0)
    made.centre[name] = (0.0, 0.0)
    made.node[name] = made.system.AddNode(
        items.NodePoint2DSlope1(
            referenceCoordinates=[*frame.origin, long * c, long * s],
            initialVelocities=[
                *frame.velocity,
                faster * c - long * frame.omega * s,
                faster * s + long * frame.omega * c,
            ],
        )
    )
    made.looked[name] = frame.theta


def add_elements(scene: Scene, made: PlaneSystem, beam: Beam) -> None:
    """Add the elements between the nodes of a beam, straight at rest wherever these stand."""
    made.elements[beam.name] = [
        made.system.AddObject(
            items.ObjectANCFCable2D(
                length=beam.element_m,
                massPerLength=beam.density_kg_m,
                bendingStiffness=beam.flexural_n_m2,
                axialStiffness=beam.axial_n,
                bendingDamping=beam.damping_s * beam.flexural_n_m2,
                axialDamping=beam.damping_s * beam.axial_n,
                nodeNumbers=[made.node[near], made.node[far]],
            )
        )
        for near, far in zip(beam.nodes, beam.nodes[1:], strict=False)
    ]
    for i, element in enumerate(made.elements[beam.name]):
        made.weigh(scene, f"{beam.name} {i}", element)


def held_beams(scene: Scene, made: PlaneSystem) -> Mapping[str, tuple[Beam, ...]]:
    """Of each beam what exudyn has of it, by element: a beam of one element each."""
    return {
        name: tuple(
            _held(made.system.GetObject(element), name, pair)
            for element, pair in zip(
                made.elements[name], zip(beam.nodes, beam.nodes[1:], strict=False), strict=True
            )
        )
        for name, beam in scene.beams.items()
    }


def _held(own: Mapping[str, float], name: str, nodes: tuple[str, str]) -> Beam:
    """An element; one whose two dampings are not of one time has none that is a number."""
    flexural, axial = float(own["bendingStiffness"]), float(own["axialStiffness"])
    times = float(own["bendingDamping"]) / flexural, float(own["axialDamping"]) / axial
    one = math.isclose(*times, rel_tol=1e-12)
    return Beam(
        name,
        nodes,
        float(own["length"]),
        float(own["massPerLength"]),
        flexural,
        axial,
        times[0] if one else math.nan,
    )


def node_masses(scene: Scene, made: PlaneSystem) -> dict[str, float]:
    """The mass of each node [kg], half of that of the elements beside it, as exudyn has these."""
    found: dict[str, float] = {}
    for elements in held_beams(scene, made).values():
        for one in elements:
            for node in one.nodes:
                half = 0.5 * one.density_kg_m * one.length_m
                found[node] = found.get(node, 0.0) + half
    return found


def rounding_n(scene: Scene, state: State) -> float:
    """What rounding leaves of the axial force of a beam [N]: its strain is a difference of places
    over the length of an element. 0 without beams."""
    reach = max([scene.longest_m, *(math.hypot(*place) for place in state.position.values())])
    return max(
        (EPSILON * beam.axial_n * reach / beam.element_m for beam in scene.beams.values()),
        default=0.0,
    )
