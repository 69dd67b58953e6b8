"""The exudyn system of a scene: a rigid body in the plane per link, a joint per pin and line.

The node of a body stands at its centre of mass; where that lies in the link's own frame is kept.
All bodies have three coordinates, the driven crank too: what drives it is one constraint more. A
pin of k bodies is k - 1 hinges. What runs on a line is a prismatic joint whose second marker, on
the guide, lies on the line; a massless block is one that leaves the angle free.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from models.errors import EngineError
from models.joints import (
    Prism,
    Slot,
    bodies,
    joints,
    less,
    local_point,
    riding_body,
    sliding_angle,
    turned,
)
from models.motion import State
from models.poses import centre_of, frames, mass_of
from models.scene import GROUND, Point, Scene
from sim.exudyn.library import exu, items

ANGLE = 2
"""The coordinate of a node that is its angle."""
Index = Any
"""exudyn's own numbers of nodes, objects, markers and loads."""


@dataclass(frozen=True)
class PlaneSystem:
    """A system that is not assembled yet: of the bodies by name, in the order they were added.

    ``centre`` is where the node of a body lies in the frame of its link [m]. ``hinge`` has, by pin,
    the joints of its first body with each of the others, ``prismatic`` the joint of each slider;
    ``weight`` is the load of each body's gravity. A system lives as long as its ``container``.
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

    def marker(self, scene: Scene, name: str, point: str) -> Index:
        """A new marker at a point of a body or of the ground."""
        return self.marker_at(name, local_point(scene, name, point))

    def marker_at(self, name: str, place: Point) -> Index:
        """A new marker at a place in the frame of a body or of the ground [m]."""
        body = self.ground if name == GROUND else self.body[name]
        x, y = less(place, self.centre.get(name, (0.0, 0.0)))
        return self.system.AddMarker(
            items.MarkerBodyRigid(bodyNumber=body, localPosition=[x, y, 0.0])
        )

    def crank_markers(self, link: str) -> list[Index]:
        """New markers of an angle of the ground and of that of a body."""
        return [self.angle_marker(GROUND), self.angle_marker(link)]

    def angle_marker(self, name: str) -> Index:
        """A new marker of the angle of a body or of the ground, which both count from the start."""
        if name == GROUND:
            node, coordinate = self.system.AddNode(items.NodePointGround()), 0
        else:
            node, coordinate = self.node[name], ANGLE
        return self.system.AddMarker(
            items.MarkerNodeCoordinate(nodeNumber=node, coordinate=coordinate)
        )


def build(scene: Scene, state: State, *, prescribed: bool) -> PlaneSystem:
    """The system of ``scene`` at ``state``, with nothing that drives it.

    Raises
    ------
    EngineError
        A link without mass that has to move freely (a ``prescribed`` crank need not have any), or
        a massless block that no body carries.
    """
    container = exu.SystemContainer()
    system = container.AddSystem()
    made = PlaneSystem(container, system, system.AddObject(items.ObjectGround()))
    ties = joints(scene)
    held = {prism.body for prism in ties.prisms}
    where = frames(scene, state)
    for name in bodies(scene):
        mass, inertia = mass_of(scene, name)
        if not (prescribed and name == scene.driver.link):
            _refuse_massless(name, mass, inertia, turns=name not in held)
        frame, centre = where[name], centre_of(scene, name)
        place = frame.at(centre)
        made.centre[name] = centre
        made.node[name] = system.AddNode(
            items.NodeRigidBody2D(
                referenceCoordinates=[*place, frame.theta],
                initialVelocities=[*frame.velocity_at(place), frame.omega],
            )
        )
        made.body[name] = system.AddObject(
            items.ObjectRigidBody2D(mass=mass, inertia=inertia, nodeNumber=made.node[name])
        )
        _weigh(scene, made, name)
    _join(scene, made)
    return made


def _refuse_massless(name: str, mass: float, inertia: float, *, turns: bool) -> None:
    """Raise EngineError for a body that a force would move at no cost."""
    if mass <= 0.0 or (inertia <= 0.0 and turns):
        raise EngineError(
            f"{name}: mass_kg {mass:g}, inertia_kg_m2 {inertia:g}; exudyn moves no body without "
            "both, give them"
        )


def _weigh(scene: Scene, made: PlaneSystem, name: str) -> None:
    """Add gravity to a body."""
    if any(scene.gravity_m_s2):
        marker = made.system.AddMarker(items.MarkerBodyMass(bodyNumber=made.body[name]))
        made.weight[name] = made.system.AddLoad(
            items.LoadMassProportional(markerNumber=marker, loadVector=[*scene.gravity_m_s2, 0.0])
        )


def _join(scene: Scene, made: PlaneSystem) -> None:
    """Add all joints."""
    ties = joints(scene)
    for pin in ties.pins:
        first, *others = sorted(pin.bodies, key=lambda name: name != GROUND)
        made.hinge[pin.point] = {
            (first, other): made.system.AddObject(
                items.ObjectJointRevolute2D(
                    markerNumbers=[
                        made.marker(scene, first, pin.point),
                        made.marker(scene, other, pin.point),
                    ]
                )
            )
            for other in others
        }
    for slide in ties.slides:
        slider, rider = slide.slider, riding_body(slide)
        axis = turned((1.0, 0.0), slider.direction_rad - _kept_angle(slide))
        normal = turned((0.0, 1.0), slider.direction_rad)
        joint = items.ObjectJointPrismatic2D(
            markerNumbers=[
                made.marker(scene, rider, slider.point),
                made.marker_at(slider.on, slider.through_m),
            ],
            axisMarker0=[*axis, 0.0],
            normalMarker1=[*normal, 0.0],
            constrainRotation=isinstance(slide, Prism),
        )
        made.prismatic[slider.name] = made.system.AddObject(joint)


def _kept_angle(slide: Prism | Slot) -> float:
    """The angle that a sliding body keeps to its guide [rad]; any for a point on a line."""
    return sliding_angle(slide.slider) if isinstance(slide, Prism) else 0.0


def masses(made: PlaneSystem) -> Mapping[str, tuple[float, float]]:
    """Mass [kg] and inertia about the centre of mass [kg m^2] of the bodies, as exudyn has them."""
    held = {name: made.system.GetObject(body) for name, body in made.body.items()}
    return {name: (float(o["mass"]), float(o["inertia"])) for name, o in held.items()}
