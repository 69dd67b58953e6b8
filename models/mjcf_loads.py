"""The loads of a scene in its MJCF text: an actuator each, whose control is the size of the load.

A force acts at a site of its body, along the axes of that site or, by ``refsite``, of the ground; a
torque likewise. MuJoCo leaves such actuators out of what `mj_rnePostConstraint` takes for forces
from outside: who reads reactions has to take them off.
"""

from __future__ import annotations

from dataclasses import dataclass

from models.characteristics import Constant
from models.driver_course import driver_place_in
from models.errors import EngineError
from models.joints import Slot, block_name, joints, local_point, riding_body, turned
from models.loads import Load
from models.mjcf_text import AttributeRow, attributes, commentable
from models.motion import State
from models.poses import centre_of
from models.scene import GROUND, Point, Scene

AXES = "ground axes"
"""The site that stands still, along whose axes forces in the ground's frame act."""


@dataclass(frozen=True)
class PointOfApplication:
    """Where a load acts on the bodies of the tree: ``place`` [m] of ``body``, and for a force its
    direction there, in the frame of the body where it ``turns`` with it, else in the ground's."""

    body: str
    place: Point
    direction_rad: float = 0.0
    turns: bool = False


def point_of_application(scene: Scene, load: Load) -> PointOfApplication:
    """That of a load. A block without mass is no body: it hands a force to the body that is pinned
    to it, and a torque to its guide.

    Raises
    ------
    EngineError
        A force on a block without mass, along a guide that moves.
    """
    slot = _block_without_mass(scene, load.body)
    if slot is None:
        if load.point is None:
            return PointOfApplication(load.body, centre_of(scene, load.body))
        place = local_point(scene, load.body, load.point)
        return PointOfApplication(load.body, place, load.direction_rad, load.frame == "body")
    slider = slot.slider
    if load.point is None:
        return PointOfApplication(slider.on, slider.through_m)
    carrier = riding_body(slot)
    place, direction = local_point(scene, carrier, slider.point), load.direction_rad
    if load.frame == "body":
        if slider.on != GROUND:
            raise EngineError(
                f"loads.{load.name}: slider {slider.name} is a block without mass, which is no "
                f"body in MuJoCo, so a force along its guide, {slider.on}, cannot be held; give "
                f"sliders.{slider.name} a mass_kg above 0, or the force in the ground's frame"
            )
        direction += slider.direction_rad
    return PointOfApplication(carrier, place, direction)


def _block_without_mass(scene: Scene, body: str) -> Slot | None:
    """The slot whose block it is; None for other bodies."""
    slots = joints(scene).slots
    return next((slot for slot in slots if block_name(slot.slider) == body), None)


def load_sites(scene: Scene, body: str) -> list[AttributeRow]:
    """The sites that the loads of a body need, and on the ground that of its axes."""
    rows: list[AttributeRow] = []
    acting = [(load, point_of_application(scene, load)) for load in scene.loads.values()]
    if body == GROUND and any(_needs_axes(load, at) for load, at in acting):
        rows.append({"name": AXES})
    return rows + [
        {"name": _name(load), "pos": (*at.place, 0.0)} for load, at in acting if at.body == body
    ]


def _needs_axes(load: Load, at: PointOfApplication) -> bool:
    return load.point is not None and not at.turns


def _name(load: Load) -> str:
    """Of its actuator and its site; nothing else of a scene has a space in its name there."""
    return f"load {load.name}"


def load_actuators(scene: Scene) -> list[str]:
    """The actuators, in the order of the loads."""
    if not scene.loads:
        return []
    lines = [
        "    <!-- loads: the control of each is its size [N or N m]. The keyframe has those of -->",
        "    <!-- the start; load it, as without it all controls are 0 and no load acts. -->",
    ]
    for load in scene.loads.values():
        if not isinstance(load.characteristic, Constant) or load.stroke != "both":
            lines += _not_in_the_file(load)
        at = point_of_application(scene, load)
        row: AttributeRow = {"name": _name(load), "site": _name(load)}
        if load.point is None:
            row["gear"] = (0, 0, 0, 0, 0, 1)
        else:
            if _needs_axes(load, at):
                row["refsite"] = AXES
            row["gear"] = (*turned((1.0, 0.0), at.direction_rad), 0, 0, 0, 0)
        lines.append(f"    <motor{attributes(row)}/>")
    return lines


def _not_in_the_file(load: Load) -> list[str]:
    """The remark that the size of a load comes from outside."""
    course = "" if isinstance(load.characteristic, Constant) else f" over the {load.over}"
    stroke = "" if load.stroke == "both" else f" on the {load.stroke} stroke"
    slider = "" if load.slider is None else f" of {load.slider}"
    return [
        f"    <!-- {commentable(load.name)}: its course{course}{stroke}{slider} is not in this -->",
        "    <!-- file: it comes as the control of each step. -->",
    ]


def load_sizes(scene: Scene, state: State) -> tuple[float, ...]:
    """The sizes of the loads in a state [N or N m]."""
    theta = driver_place_in(scene, state)
    sliding = {name: (s, state.speed[name]) for name, s in state.displacement.items()}
    return tuple(
        load.size(state.time_s, theta, sliding, state.omega.get(load.body, 0.0))
        for load in scene.loads.values()
    )
