"""The driven loop in its plane: rigid bodies with their joints."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from models.array import Array
from sim.mujoco.own_model import driven_loop as loops
from sim.mujoco.own_model.file import ModelClosure, ModelError, body_name
from sim.mujoco.own_model.held_rods import HeldRod, matrix_of

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


PARALLEL_DEG = 0.01
"""Smallest angle of an axis to its direction that is more than rounding of the file; less changes
lengths by 2e-8 of themselves."""


@dataclass(frozen=True, eq=False)
class PlanarJoint:
    """A hinge or a slide of the model as drawn: its anchor, and the direction of a slide, in the
    plane; ``sense`` is -1 for a hinge whose positive angles are clockwise. ``columns`` are those of
    its coordinate and its rate, after all of the model for a rod's."""

    index: int
    name: str
    kind: Literal["hinge", "slide"]
    anchor: complex
    direction: complex
    sense: float
    columns: tuple[int, int]


@dataclass(frozen=True, eq=False)
class RigidBody:
    """Bodies of the model without joints between them, by the id of the first; ``parent`` is the
    rigid body against which its joints turn or slide."""

    id: int
    name: str
    parent: int
    joints: tuple[PlanarJoint, ...]


@dataclass(frozen=True, eq=False, kw_only=True)
class Component(loops.DrivenLoop):
    """The driven loop in its plane, without the ground, which has the id 0."""

    plane: Plane
    bodies: tuple[RigidBody, ...]
    rods: tuple[HeldRod, ...]

    def rigid(self, body: int) -> int:
        """Return the rigid body of a body of the model."""
        return loops.rigid(self.model, body)


def component(model: Any, joint: str, qpos: Array) -> Component:
    """Return the component of the joint of that name, at the drawn pose of the model; a base that
    is held stands as in ``qpos``.

    Raises
    ------
    ModelError
        See `driven_loop.loop_of`; a joint off the plane, or of another kind.
    """
    loop = loops.loop_of(model, joint, qpos)
    plane = Plane.across(loop.data.xaxis[loop.driven])
    rods: list[HeldRod] = []
    bodies = tuple(_body(loop, plane, body, rods) for body in loop.ids)
    return Component(**vars(loop), plane=plane, bodies=bodies, rods=tuple(rods))


def _body(loop: loops.DrivenLoop, plane: Plane, root: int, rods: list[HeldRod]) -> RigidBody:
    model, data = loop.model, loop.data
    first, count = int(model.body_jntadr[root]), int(model.body_jntnum[root])
    parent = loops.rigid(model, int(model.body_parentid[root]))
    joints = _rod(loop, plane, root, rods)
    joints = joints or tuple(_joint(model, data, plane, first + n) for n in range(count))
    return RigidBody(root, body_name(model, root), parent, joints)


def _rod(
    loop: loops.DrivenLoop, plane: Plane, root: int, rods: list[HeldRod]
) -> tuple[PlanarJoint, ...]:
    """Return the joints in the plane of a body on a free or ball joint that pins to bodies of the
    plane hold there at two places, and add it to the rods; none for any other body."""
    model, data, index = loop.model, loop.data, int(loop.model.body_jntadr[root])
    kind = loops.JOINTS[int(model.jnt_type[index])]
    carries = any(loops.rigid(model, int(model.body_parentid[body])) == root for body in loop.ids)
    if kind not in (loops.FLOATING, loops.BALL) or carries:
        return ()
    anchored = kind == loops.BALL
    places = [data.xanchor[index]] if anchored else []
    for each in (each for each in loop.closures if each.kind == "connect"):
        for end, other in ((0, 1), (1, 0)):
            beside = model.jnt_type[model.jnt_bodyid == loops.rigid(model, each.bodies[other])]
            planar = all(loops.JOINTS[int(joint)] in ("hinge", "slide") for joint in beside)
            if loops.rigid(model, each.bodies[end]) == root and planar:
                places.append(each.anchors[end])
    line = max((place - places[0] for place in places), key=np.linalg.norm, default=np.zeros(3))
    if not np.any(line):
        return ()
    ahead = 0 if anchored else 3  # coordinates of its place, before those of its turn
    at, dof = int(model.jnt_qposadr[index]) + ahead, int(model.jnt_dofadr[index]) + ahead
    own, turned = data.xmat[root].reshape(3, 3), np.array(data.qpos[at : at + 4])
    axes = np.array([plane.x, plane.y, plane.normal]) @ own @ matrix_of(turned).T
    arm, line = own.T @ (places[0] - data.xpos[root]), own.T @ line
    before = sum(rod.count for rod in rods)
    rods.append(
        HeldRod(at, dof, axes, turned, arm, line, None if anchored else np.array(places[0]))
    )
    columns = [(model.nq + before + n, model.nv + before + n) for n in range(rods[-1].count)]
    name, anchor = loops.joint_name(model, index), plane.flat(places[0])
    hinge = PlanarJoint(index, name, "hinge", anchor, 0j, 1.0, columns[-1])
    ways = zip((1.0 + 0j, 1j), columns[:-1], strict=False)
    return (*(PlanarJoint(index, name, "slide", 0j, way, 1.0, at) for way, at in ways), hinge)


def _joint(model: Any, data: Any, plane: Plane, index: int) -> PlanarJoint:
    """Return a joint in the plane. Raises ModelError for a joint that leaves it."""
    name, kind = loops.joint_name(model, index), loops.JOINTS[int(model.jnt_type[index])]
    of = f"joint {name} of body {body_name(model, int(model.jnt_bodyid[index]))}"
    if kind not in ("hinge", "slide"):
        raise ModelError(
            f"{of}: a {kind} joint leaves the plane of the driven hinge, but where two pins to "
            "bodies of the plane hold a body that carries none; use hinges across the plane and "
            "slides within it"
        )
    axis, anchor = data.xaxis[index], plane.flat(data.xanchor[index])
    columns = int(model.jnt_qposadr[index]), int(model.jnt_dofadr[index])
    off = plane.off_normal_deg(axis)
    if kind == "hinge":
        if off > PARALLEL_DEG:
            raise ModelError(
                f"{of}: its axis is {off:.3g} deg off that of the driven hinge; in a planar "
                f"mechanism they are parallel, to {PARALLEL_DEG:g} deg"
            )
        sense = 1.0 if plane.height(axis) > 0 else -1.0
        return PlanarJoint(index, name, "hinge", anchor, 0j, sense, columns)
    if 90.0 - off > PARALLEL_DEG:
        raise ModelError(
            f"{of}: it slides {90.0 - off:.3g} deg off the plane across the driven hinge; in a "
            f"planar mechanism it slides within it, to {PARALLEL_DEG:g} deg"
        )
    direction = plane.flat(axis)
    return PlanarJoint(index, name, "slide", anchor, direction / abs(direction), 1.0, columns)


def loose_joints(component: Component) -> list[str]:
    """List the joints that move in some motion of the model as drawn, while the driven joint is
    fixed: the null space of the Jacobian of its closures."""
    model = component.model
    joints = [
        joint.index
        for body in component.bodies
        for joint in body.joints
        if joint.index != component.driven and joint.columns[1] < model.nv
    ]
    columns = [int(model.jnt_dofadr[joint]) for joint in joints]
    rows = [_rows(component, each)[:, columns] for each in component.closures]
    if not joints:
        return []
    _, values, directions = np.linalg.svd(np.vstack(rows))
    held = int(np.count_nonzero(values > loops.NOTHING * (values[0] or 1.0)))
    moving = np.abs(directions[held:]).max(axis=0, initial=0.0) > loops.NOTHING**0.5
    return [
        loops.joint_name(model, joint) for joint, moves in zip(joints, moving, strict=True) if moves
    ]


def _rows(component: Component, closure: ModelClosure) -> Array:
    """Return the speeds in the plane that a closure forbids, (2 or 3, nv)."""
    model, data, plane = component.model, component.data, component.plane
    along, about = loops.speeds(model, data, closure)
    rows: Any = np.array([plane.x @ along, plane.y @ along, plane.normal @ about])
    return np.asarray(rows if closure.kind == "weld" else rows[:2])
