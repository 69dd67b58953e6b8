"""The exudyn system of a scene: a rigid body in the plane per link, a joint per pin and line.

The node of a body stands at its centre of mass; where that lies in the link's own frame is kept.
All bodies have three coordinates, the driven crank too: what drives it is one constraint more. A
pin of k bodies is k - 1 hinges. What runs on a line is a prismatic joint whose second marker, on
the guide, lies on the line; a massless block is one that leaves the angle free. The nodes of beams
have a tangent in place of an angle.
"""

from __future__ import annotations

from models.errors import EngineError
from models.joints import Prism, Slot, bodies, joints, riding_body, sliding_angle, turned
from models.motion import State
from models.poses import centre_of, frames, mass_of
from models.scene import GROUND, Scene
from sim.exudyn.beams import add_elements, add_node
from sim.exudyn.library import exu, items
from sim.exudyn.plane_system import PlaneSystem


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
    nodes = {node for beam in scene.beams.values() for node in beam.nodes}
    for name in bodies(scene):
        if name in nodes:
            add_node(made, name, where[name], state)
            continue
        mass, inertia = mass_of(scene, name)
        if not (prescribed and name == scene.driver.link and not scene.driver.is_inner):
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
        made.weigh(scene, name, made.body[name])
    for beam in scene.beams.values():
        add_elements(scene, made, beam)
    _join(scene, made)
    return made


def _refuse_massless(name: str, mass: float, inertia: float, *, turns: bool) -> None:
    """Raise EngineError for a body that a force would move at no cost."""
    if mass <= 0.0 or (inertia <= 0.0 and turns):
        raise EngineError(
            f"{name}: mass_kg {mass:g}, inertia_kg_m2 {inertia:g}; exudyn moves no body without "
            "both, give them"
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
