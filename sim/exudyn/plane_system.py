"""A system of exudyn with its items by the names of the scene."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from models.errors import EngineError
from models.joints import less, local_point
from models.scene import GROUND, Point, Scene
from sim.exudyn.library import items

ANGLE = 2
"""The coordinate of a node that is its angle."""
Index = Any
"""exudyn's own numbers of nodes, objects, markers and loads."""


@dataclass(frozen=True)
class PlaneSystem:
    """A system that is not assembled yet: of the bodies by name, in the order they were added.

    ``centre`` is where the node of a body lies in the frame of its link [m]. ``hinge`` has, by pin,
    the joints of its first body with each of the others, ``prismatic`` the joint of each slider;
    ``weight`` is the load of each body's gravity. Nodes of beams are in ``node`` alone, and where
    they look at the start [rad] in ``looked``; the elements of each beam are in ``elements``. A
    system lives as long as its ``container``.
    """

    container: Any
    system: Any
    ground: Index
    body: dict[str, Index] = field(default_factory=dict)
    node: dict[str, Index] = field(default_factory=dict)
    centre: dict[str, Point] = field(default_factory=dict)
    hinge: dict[str, dict[tuple[str, str], Index]] = field(default_factory=dict)
    prismatic: dict[str, Index] = field(default_factory=dict)
    weight: dict[str, Index] = field(default_factory=dict)
    looked: dict[str, float] = field(default_factory=dict)
    elements: dict[str, list[Index]] = field(default_factory=dict)

    def marker(self, scene: Scene, name: str, point: str) -> Index:
        """A new marker at a point of a body or of the ground."""
        return self.marker_at(name, local_point(scene, name, point))

    def marker_at(self, name: str, place: Point) -> Index:
        """A new marker at a place in the frame of a body or of the ground [m]."""
        x, y = less(place, self.centre.get(name, (0.0, 0.0)))
        if name in self.looked:
            if (x, y) != (0.0, 0.0):
                raise EngineError(
                    f"{name}: something acts {y:g} m beside it; exudyn's beams take forces on "
                    "their line, give that link segments (--springs plain)"
                )
            return self.system.AddMarker(items.MarkerNodeRigid(nodeNumber=self.node[name]))
        body = self.ground if name == GROUND else self.body[name]
        return self.system.AddMarker(
            items.MarkerBodyRigid(bodyNumber=body, localPosition=[x, y, 0.0])
        )

    def crank_markers(self, link: str, base: str = GROUND) -> list[Index]:
        """New markers of the angles of a base and of a body."""
        return [self.angle_marker(base), self.angle_marker(link)]

    def place_markers(self, link: str, coordinate: int) -> list[Index]:
        """New markers of a coordinate of the ground, which is 0, and of one of a body's centre."""
        own = items.MarkerNodeCoordinate(nodeNumber=self.node[link], coordinate=coordinate)
        return [self.angle_marker(GROUND), self.system.AddMarker(own)]

    def angle_marker(self, name: str) -> Index:
        """A new marker of the angle of a body or of the ground, which both count from the start.

        Raises EngineError for the node of a beam, whose angle is no coordinate.
        """
        if name in self.looked:
            raise EngineError(
                f"{name}: something turns it, and the nodes of exudyn's beams have no angle; give "
                "that link segments (--springs plain)"
            )
        if name == GROUND:
            node, coordinate = self.system.AddNode(items.NodePointGround()), 0
        else:
            node, coordinate = self.node[name], ANGLE
        return self.system.AddMarker(
            items.MarkerNodeCoordinate(nodeNumber=node, coordinate=coordinate)
        )

    def weigh(self, scene: Scene, name: str, body: Index) -> None:
        """Add gravity to a body or an element."""
        if any(scene.gravity_m_s2):
            marker = self.system.AddMarker(items.MarkerBodyMass(bodyNumber=body))
            self.weight[name] = self.system.AddLoad(
                items.LoadMassProportional(
                    markerNumber=marker, loadVector=[*scene.gravity_m_s2, 0.0]
                )
            )

    def masses(self) -> Mapping[str, tuple[float, float]]:
        """Mass [kg] and inertia about the centre of mass [kg m^2] of the bodies, as exudyn has
        them."""
        held = {name: self.system.GetObject(body) for name, body in self.body.items()}
        return {name: (float(o["mass"]), float(o["inertia"])) for name, o in held.items()}
