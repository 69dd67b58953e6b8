"""Part of a compiled model that moves with the driven joint: rigid bodies, joints and closures."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal

import mujoco  # type: ignore[import-untyped]  # ships no stubs
import numpy as np

from models.array import Array
from models.errors import few, suggestion
from sim.mujoco.own_model.file import (
    IDLE,
    Coupling,
    ModelClosure,
    ModelError,
    body_name,
    equalities,
    name_of,
)

UP, ACROSS = np.array([0.0, 0.0, 1.0]), np.array([0.0, 1.0, 0.0])


@dataclass(frozen=True, eq=False)
class Plane:
    """Unit vectors in space, (3,): ``x`` and ``y`` in the plane, ``normal`` towards the viewer.
    Points and vectors of the plane are complex numbers; the origin is the world's."""

    x: Array
    y: Array
    normal: Array

    @staticmethod
    def across(axis: Array) -> Plane:
        """Make the plane across an axis, seen against the axis: counter-clockwise is positive. Up
        is up in the world, or the y-axis of the world for the x-y plane."""
        normal = axis / np.linalg.norm(axis)
        up = UP if abs(normal @ UP) < 0.99 else ACROSS
        y = up - (up @ normal) * normal
        y /= np.linalg.norm(y)
        return Plane(np.cross(y, normal), y, normal)

    def flat(self, vector: Array) -> complex:
        """Return the part of a point or vector in space (3,) that lies in the plane."""
        return complex(vector @ self.x, vector @ self.y)

    def height(self, vector: Array) -> float:
        """Return its part across the plane."""
        return float(vector @ self.normal)

    def off_normal_deg(self, axis: Array) -> float:
        """Return the angle of an axis to the normal, whichever way it points [deg]."""
        return math.degrees(
            math.atan2(float(np.linalg.norm(np.cross(axis, self.normal))), abs(self.height(axis)))
        )

    def turned(self, rotation: Array) -> tuple[float, float]:
        """Return a rotation's (3, 3) angle within the plane [rad], and its tilt out of it [deg]."""
        turn = self.flat(rotation @ self.x)
        return math.atan2(turn.imag, turn.real), self.off_normal_deg(rotation @ self.normal)


JOINTS = {
    kind.value: kind.name.removeprefix("mjJNT_").lower()
    for kind in mujoco.mjtJoint.__members__.values()
}
PARALLEL_DEG = 0.01
"""Smallest angle of an axis to its direction that is more than rounding of the file; less changes
lengths by 2e-8 of themselves."""
SHOWN = 6
WORLD = 0


@dataclass(frozen=True, eq=False)
class PlanarJoint:
    """A hinge or a slide of the model as drawn: its anchor, and the direction of a slide, in the
    plane; ``sense`` is -1 for a hinge whose positive angles are clockwise."""

    index: int
    name: str
    kind: Literal["hinge", "slide"]
    anchor: complex
    direction: complex
    sense: float


@dataclass(frozen=True, eq=False)
class RigidBody:
    """Bodies of the model without joints between them, by the id of the first; ``parent`` is the
    rigid body against which its joints turn or slide."""

    id: int
    name: str
    parent: int
    joints: tuple[PlanarJoint, ...]


@dataclass(frozen=True, eq=False)
class Component:
    """Everything connected with the driven joint without the ground, which has the id 0."""

    model: Any
    data: Any
    plane: Plane
    driven: int
    bodies: tuple[RigidBody, ...]
    closures: tuple[ModelClosure, ...]

    def rigid(self, body: int) -> int:
        """Return the rigid body of a body of the model."""
        return rigid(self.model, body)


def rigid(model: Any, body: int) -> int:
    """Return the rigid body of a body; mocap bodies count as ground."""
    root = int(model.body_weldid[body])
    return WORLD if int(model.body_mocapid[root]) >= 0 else root


def component(model: Any, joint: str) -> Component:
    """Return the component of the joint of that name, at the drawn pose of the model.

    Raises
    ------
    ModelError
        No joint of that name, or no hinge against the ground; no loop; a joint off the plane, or of
        another kind; an equality that couples coordinates.
    """
    driven = _driven(model, joint)
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    closures, couplings = equalities(model, data)
    plane = Plane.across(data.xaxis[driven])
    ids = _together(model, int(model.jnt_bodyid[driven]), closures)
    own = [each for each in closures if {rigid(model, body) for body in each.bodies} & ids]
    _refuse_couplings(model, couplings, ids)
    _refuse_open(model, own)
    bodies = tuple(_body(model, data, plane, body) for body in sorted(ids))
    return Component(model, data, plane, driven, bodies, tuple(own))


def _driven(model: Any, joint: str) -> int:
    """Return the joint of that name, or refuse it as the driver."""
    names = [name_of(model, "joint", index) for index in range(model.njnt)]
    able = [name for index, name in enumerate(names) if name and not _not_drivable(model, index)]
    can = f"drivable: {few(able, SHOWN)}" if able else "no named hinge turns against the ground"
    if not joint:
        raise ModelError(f"--drive is missing: name the joint that turns the crank; {can}")
    if joint not in names:
        there = [name for name in names if name]
        hint = suggestion(joint, there, "it has") if there else "none of its joints has a name"
        raise ModelError(f"--drive {joint!r}: the model has no joint of that name; {hint}; {can}")
    index = names.index(joint)
    if why := _not_drivable(model, index):
        raise ModelError(f"--drive {joint!r}: {why}; {can}")
    return index


def _not_drivable(model: Any, index: int) -> str:
    """Return the reason why a joint cannot be the driver; "" if it can."""
    kind, body = JOINTS[int(model.jnt_type[index])], int(model.jnt_bodyid[index])
    if kind != "hinge":
        return f"it is a {kind}, and a crank turns on a hinge"
    if int(model.body_jntnum[body]) > 1:
        return f"body {body_name(model, body)} has {int(model.body_jntnum[body])} joints"
    parent = rigid(model, int(model.body_parentid[rigid(model, body)]))
    if parent != WORLD:
        return f"it turns against body {body_name(model, parent)}, and not against the ground"
    return ""


def is_hinge(model: Any, joint: int) -> bool:
    """True if a joint turns, and does not slide."""
    return bool(JOINTS[int(model.jnt_type[joint])] == "hinge")


def reading(coordinate: float, hinge: bool) -> str:
    """Return a joint coordinate in words."""
    return f"{math.degrees(coordinate):.4g} deg" if hinge else f"{coordinate:.4g} m"


def joint_name(model: Any, joint: int) -> str:
    """Return the name of a joint, or of its body."""
    name = name_of(model, "joint", joint)
    return name or f"a joint of {body_name(model, int(model.jnt_bodyid[joint]))}"


def _together(model: Any, body: int, closures: Sequence[ModelClosure]) -> set[int]:
    """Return the rigid bodies connected with a body by joints and closures, without the ground."""
    ties = [
        (rigid(model, root), rigid(model, int(model.body_parentid[root])))
        for root in range(1, model.nbody)
        if int(model.body_weldid[root]) == root
    ]
    ties += [(rigid(model, each.bodies[0]), rigid(model, each.bodies[1])) for each in closures]
    ids, waiting = set(), [rigid(model, body)]
    while waiting:
        one = waiting.pop()
        if one == WORLD or one in ids:
            continue
        ids.add(one)
        waiting += [b if a == one else a for a, b in ties if one in (a, b)]
    return ids


def _refuse_couplings(model: Any, couplings: Sequence[Coupling], ids: set[int]) -> None:
    for one in couplings:
        if any(rigid(model, body) in ids for body in one.bodies) or not one.bodies:
            raise ModelError(
                f"{one.name}: a <{one.kind}> equality couples coordinates, and closes no loop that "
                "a closed form is known for; take it out, and close loops with <connect>"
            )


def _refuse_open(model: Any, closures: Sequence[ModelClosure]) -> None:
    if not closures:
        idle = int(model.neq - np.count_nonzero(model.eq_active0))
        if int(model.opt.disableflags) & IDLE:
            raise ModelError('no loop: <flag equality="disable"/>, or constraint, lets none close')
        found = "no equality is active" if idle else "the model has no <equality>"
        if model.neq > idle:
            found = "no equality ties a body that moves with the driven joint"
            found += f" ({idle} of {model.neq} are not active)" if idle else ""
        raise ModelError(
            f"no loop: {found}; close the loop with <equality><connect .../></equality>"
        )


def _body(model: Any, data: Any, plane: Plane, root: int) -> RigidBody:
    first, count = int(model.body_jntadr[root]), int(model.body_jntnum[root])
    joints = tuple(_joint(model, data, plane, joint) for joint in range(first, first + count))
    parent = rigid(model, int(model.body_parentid[root]))
    return RigidBody(root, body_name(model, root), parent, joints)


def _joint(model: Any, data: Any, plane: Plane, index: int) -> PlanarJoint:
    """Return a joint in the plane. Raises ModelError for a joint that leaves it."""
    name, kind = joint_name(model, index), JOINTS[int(model.jnt_type[index])]
    of = f"joint {name} of body {body_name(model, int(model.jnt_bodyid[index]))}"
    if kind not in ("hinge", "slide"):
        raise ModelError(
            f"{of}: a {kind} joint leaves the plane of the driven hinge; use hinges across the "
            "plane and slides within it"
        )
    axis, anchor = data.xaxis[index], plane.flat(data.xanchor[index])
    off = plane.off_normal_deg(axis)
    if kind == "hinge":
        if off > PARALLEL_DEG:
            raise ModelError(
                f"{of}: its axis is {off:.3g} deg off that of the driven hinge; in a planar "
                f"mechanism they are parallel, to {PARALLEL_DEG:g} deg"
            )
        return PlanarJoint(
            index, name, "hinge", anchor, 0j, 1.0 if plane.height(axis) > 0 else -1.0
        )
    if 90.0 - off > PARALLEL_DEG:
        raise ModelError(
            f"{of}: it slides {90.0 - off:.3g} deg off the plane across the driven hinge; in a "
            f"planar mechanism it slides within it, to {PARALLEL_DEG:g} deg"
        )
    direction = plane.flat(axis)
    return PlanarJoint(index, name, "slide", anchor, direction / abs(direction), 1.0)


NOTHING = 1e-9
"""Singular values of the closures below this, over the largest, constrain nothing; shares of a
motion below its root are rounding."""


def loose_joints(component: Component) -> list[str]:
    """List the joints that move in some motion of the model as drawn, while the driven joint is
    fixed: the null space of the Jacobian of its closures."""
    model = component.model
    joints = [
        joint.index
        for body in component.bodies
        for joint in body.joints
        if joint.index != component.driven
    ]
    columns = [int(model.jnt_dofadr[joint]) for joint in joints]
    rows = [_rows(component, each)[:, columns] for each in component.closures]
    if not joints:
        return []
    _, values, directions = np.linalg.svd(np.vstack(rows))
    held = int(np.count_nonzero(values > NOTHING * (values[0] or 1.0)))
    moving = np.abs(directions[held:]).max(axis=0, initial=0.0) > NOTHING**0.5
    return [joint_name(model, joint) for joint, moves in zip(joints, moving, strict=True) if moves]


def _rows(component: Component, closure: ModelClosure) -> Array:
    """Return the speeds in the plane that a closure forbids, (2 or 3, nv)."""
    model, data, plane = component.model, component.data, component.plane
    ends = []
    for body, anchor in zip(closure.bodies, closure.anchors, strict=True):
        along, about = np.zeros((3, model.nv)), np.zeros((3, model.nv))
        mujoco.mj_jac(model, data, along, about, anchor, body)
        ends.append([plane.x @ along, plane.y @ along, plane.normal @ about])
    rows: Any = np.array(ends[1]) - np.array(ends[0])
    return np.asarray(rows if closure.kind == "weld" else rows[:2])
