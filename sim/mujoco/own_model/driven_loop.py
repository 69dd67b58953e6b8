"""The bodies that move with the driven joint in loops, their base, and the bodies that only hang on
them.

A body is in a loop with the driven joint if no single body, taken away, parts it from the joint's
two bodies (Menger's theorem). A loop that meets the ground nowhere moves against its base, the body
that the driven joint turns against, however that one stands.
"""

from __future__ import annotations

import copy
import math
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import mujoco  # type: ignore[import-untyped]  # ships no stubs
import numpy as np

from models.array import Array
from models.errors import few, suggestion
from sim.mujoco.own_model import file

JOINTS = {
    kind.value: kind.name.removeprefix("mjJNT_").lower()
    for kind in mujoco.mjtJoint.__members__.values()
}
FLOATING, BALL = "free", "ball"
"""Joints that turn about any axis, with and without a place of their own."""
SHOWN = 6
WORLD = 0
NOTHING = 1e-9
"""Singular values of the closures below this, over the largest, constrain nothing; shares of a
motion below its root are rounding."""
Ties = Mapping[int, set[int]]
"""Rigid bodies joined to each rigid body."""


@dataclass(frozen=True, eq=False)
class DrivenLoop:
    """The rigid bodies ``ids`` that move with the joint ``driven``, and the equalities that close
    them.

    ``model`` counts the base as ground, ``data`` is its pose. ``held`` are the freedoms of the base
    [columns of qvel], ``idle`` the equalities that would move it; ``follows`` says that bodies hang
    on the loop or follow it; ``notes`` say what is held or left out.
    """

    model: Any
    data: Any
    driven: int
    ids: tuple[int, ...]
    closures: tuple[file.ModelClosure, ...]
    held: tuple[int, ...] = ()
    idle: tuple[int, ...] = ()
    follows: bool = False
    notes: tuple[str, ...] = ()


def rigid(model: Any, body: int) -> int:
    """Return the rigid body of a body; mocap bodies count as ground."""
    root = int(model.body_weldid[body])
    return WORLD if int(model.body_mocapid[root]) >= 0 else root


def loop_of(model: Any, joint: str, qpos: Array) -> DrivenLoop:
    """Return the loop of the joint of that name, in the model as drawn, with its base as in
    ``qpos``.

    Raises
    ------
    ModelError
        No joint of that name, or no hinge against the ground or the base of its loop; no loop; an
        equality that couples its coordinates.
    """
    data = mujoco.MjData(model)
    driven = _driven(model, joint, _ties(model, file.equalities(model, data)[0]))
    crank = rigid(model, int(model.jnt_bodyid[driven]))
    base = rigid(model, int(model.body_parentid[crank]))
    above = _above(model, base)
    for each in _joints(model, above):
        at = slice(model.jnt_qposadr[each], [*model.jnt_qposadr, model.nq][each + 1])
        data.qpos[at] = qpos[at]
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    closures, couplings = file.equalities(model, data)
    grounded = copy.copy(model)
    grounded.body_weldid[np.isin(model.body_weldid, above)] = WORLD
    ties = _ties(grounded, closures)
    ids = _block((WORLD, crank), ties) - {WORLD}
    hung = _reached({crank}, ties, {WORLD}) - ids
    ends = [_ends(grounded, each) for each in closures]
    # If the driven joint is in no loop, the reason is in the bodies that hang on it.
    looped = len(ids) > 1 or any(on <= {WORLD, crank} for on in ends)
    if not (looped and _is_loose(grounded, data, hung, closures)):
        ids, hung = ids | hung, set()
    own = [c for c, on in zip(closures, ends, strict=True) if on & ids and on <= ids | {WORLD}]
    _refuse_open(model, own)
    followers = list(_followers(grounded, couplings, ids))
    notes = [
        f"left out: {one.name}, by which {file.body_name(model, body)} follows the loop"
        for one, body in followers
    ]
    if hung:
        names = few([file.body_name(model, body) for body in sorted(hung)], SHOWN)
        notes.insert(0, f"left out: {names} ({_joints_of(model, hung)}), hanging on the loop")
    called = file.body_name(model, base) if base != WORLD else ""
    if called:
        how = "the motion of the loop against it does not depend on where it is"
        notes.insert(0, f"base: body {called} is held ({_joints_of(model, above)}); {how}")
    return DrivenLoop(
        grounded,
        data,
        driven,
        tuple(sorted(ids)),
        tuple(own),
        tuple(_freedoms(model, above)),
        tuple(one.index for one, body in followers if rigid(grounded, body) == WORLD),
        bool(hung or followers),
        tuple(notes),
    )


def _above(model: Any, body: int) -> list[int]:
    """Return a rigid body and those that carry it, without the ground."""
    found = []
    while body != WORLD:
        found.append(body)
        body = rigid(model, int(model.body_parentid[body]))
    return found


def _joints(model: Any, bodies: Collection[int]) -> list[int]:
    return [int(joint) for joint in np.flatnonzero(np.isin(model.jnt_bodyid, list(bodies)))]


def _freedoms(model: Any, bodies: Collection[int]) -> list[int]:
    return [int(dof) for dof in np.flatnonzero(np.isin(model.dof_bodyid, list(bodies)))]


def _joints_of(model: Any, bodies: Collection[int]) -> str:
    told = [
        (JOINTS[int(model.jnt_type[joint])], file.name_of(model, "joint", joint))
        for joint in _joints(model, bodies)
    ]
    return few([f"{kind} {name}" if name else f"a {kind}" for kind, name in told], SHOWN)


def _ends(model: Any, closure: file.ModelClosure) -> set[int]:
    return {rigid(model, body) for body in closure.bodies}


def _ties(model: Any, closures: Sequence[file.ModelClosure]) -> Ties:
    """Return the ties by joints and closures; joints that leave a body free in the plane tie
    none."""
    pairs = [tuple(rigid(model, body) for body in each.bodies) for each in closures]
    for root in range(1, model.nbody):
        kinds = [JOINTS[int(model.jnt_type[joint])] for joint in _joints(model, [root])]
        floats = kinds.count("slide") >= 2 and len(kinds) > kinds.count("slide")
        if rigid(model, root) == root and FLOATING not in kinds and not floats:
            pairs.append((root, rigid(model, int(model.body_parentid[root]))))
    ties: dict[int, set[int]] = {}
    for first, second in pairs:
        ties.setdefault(first, set()).add(second)
        ties.setdefault(second, set()).add(first)
    return ties


def _reached(start: Iterable[int], ties: Ties, without: Collection[int] = ()) -> set[int]:
    """Return the rigid bodies connected with those of the start, past none of ``without``."""
    found, waiting = set(), list(start)
    while waiting:
        body = waiting.pop()
        if body not in found and body not in without:
            found.add(body)
            waiting += ties.get(body, ())
    return found


def _block(ends: tuple[int, int], ties: Ties) -> set[int]:
    """Return the rigid bodies in a loop with the joint between two of them, with these."""
    found = _reached(ends[1:], ties, ends[:1]) | {ends[0]}
    ties = {body: ties.get(body, set()) & found for body in found}
    for body in ties:
        found &= _reached({*ends} - {body}, ties, {body}) | {body}
    return found


def _is_loose(model: Any, data: Any, part: set[int], closures: Sequence[file.ModelClosure]) -> bool:
    """True if bodies move while the loop that they hang on stands still, or may leave its plane."""
    freedoms = _freedoms(model, part)
    rows = [
        np.vstack(speeds(model, data, each)[: 1 if each.kind == "connect" else 2])[:, freedoms]
        for each in closures
        if _ends(model, each) & part
    ]
    values = np.linalg.svd(np.vstack(rows), compute_uv=False) if rows else np.zeros(1)
    rank = int(np.count_nonzero(values > NOTHING * (values[0] or 1.0)))
    return rank < len(freedoms) or len(freedoms) > len(_joints(model, part))


def speeds(model: Any, data: Any, closure: file.ModelClosure) -> tuple[Array, Array]:
    """Return the relative speeds of a closure's ends, and their angular ones, (3, nv) each."""
    ends = []
    for body, anchor in zip(closure.bodies, closure.anchors, strict=True):
        along, about = np.zeros((3, model.nv)), np.zeros((3, model.nv))
        mujoco.mj_jac(model, data, along, about, anchor, body)
        ends.append((along, about))
    return ends[1][0] - ends[0][0], ends[1][1] - ends[0][1]


def _followers(
    model: Any, couplings: Sequence[file.Coupling], ids: set[int]
) -> Iterator[tuple[file.Coupling, int]]:
    """Yield the couplings by which a body beside the loop follows it, with that body. Raises
    ModelError for one that couples coordinates of the loop, and for a body that follows twice."""
    seen: set[int] = set()
    for one in couplings:
        beside = [side for side in one.sides if not {rigid(model, body) for body in side} & ids]
        if len(beside) == len(one.sides) > 0:
            continue
        if not beside or seen.intersection(*beside):
            bodies = [body for side in beside or one.sides for body in side]
            told = [f"{file.body_name(model, b)} ({_joints_of(model, [b])})" for b in bodies]
            raise file.ModelError(
                f"{one.name}: a <{one.kind}> equality couples coordinates of {few(told, SHOWN)} "
                f"{'twice with' if beside else 'in'} the loop, of which no closed form is "
                "known; remove it, and close loops with <connect>"
            )
        seen.update(*beside)
        yield one, beside[0][0]


def _driven(model: Any, joint: str, ties: Ties) -> int:
    """Return the joint of that name, or refuse it as the driver."""
    names = [file.name_of(model, "joint", index) for index in range(model.njnt)]
    why = _not_drivable(model, names.index(joint), ties) if joint and joint in names else ""
    if joint and joint in names and not why:
        return names.index(joint)
    able = [
        name for index, name in enumerate(names) if name and not _not_drivable(model, index, ties)
    ]
    can = f"drivable: {few(able, SHOWN)}" if able else "no named hinge turns against the ground"
    if not joint:
        raise file.ModelError(f"--drive is missing: name the joint that turns the crank; {can}")
    if joint not in names:
        there = [name for name in names if name]
        hint = suggestion(joint, there, "it has") if there else "none of its joints has a name"
        raise file.ModelError(
            f"--drive {joint!r}: the model has no joint of that name; {hint}; {can}"
        )
    raise file.ModelError(f"--drive {joint!r}: {why}; {can}")


def _not_drivable(model: Any, index: int, ties: Ties) -> str:
    """Return the reason why a joint cannot be the driver; "" if it can."""
    kind, body = JOINTS[int(model.jnt_type[index])], int(model.jnt_bodyid[index])
    if kind != "hinge":
        return f"it is a {kind}, and a crank turns on a hinge"
    if int(model.body_jntnum[body]) > 1:
        return f"body {file.body_name(model, body)} has {int(model.body_jntnum[body])} joints"
    parent = rigid(model, int(model.body_parentid[rigid(model, body)]))
    if parent == WORLD:
        return ""
    block, above = _block((parent, rigid(model, body)), ties), _above(model, parent)
    if len(block) > 2 and not block & {WORLD, *above[1:]}:
        return ""
    told = f"it turns against body {file.body_name(model, parent)}, and not against the ground"
    movers = [b for b in above if not all(is_hinge(model, j) for j in _joints(model, [b]))]
    if movers and len(block) > 2:
        told += f", which its loop meets too; fix that body: remove {_joints_of(model, movers)}"
    return told


def is_hinge(model: Any, joint: int) -> bool:
    """True if a joint turns, and does not slide."""
    return bool(JOINTS[int(model.jnt_type[joint])] == "hinge")


def reading(coordinate: float, hinge: bool) -> str:
    """Return a joint coordinate in words, without its rounding."""
    coordinate = round(coordinate, 12) + 0.0
    return f"{math.degrees(coordinate):.4g} deg" if hinge else f"{coordinate:.4g} m"


def joint_name(model: Any, joint: int) -> str:
    """Return the name of a joint, or of its body."""
    name = file.name_of(model, "joint", joint)
    return name or f"a joint of {file.body_name(model, int(model.jnt_bodyid[joint]))}"


def _refuse_open(model: Any, closures: Sequence[file.ModelClosure]) -> None:
    if not closures:
        idle = int(model.neq - np.count_nonzero(model.eq_active0))
        if int(model.opt.disableflags) & file.IDLE:
            raise file.ModelError(
                'no loop: <flag equality="disable"/>, or constraint, lets none close'
            )
        found = "no equality is active" if idle else "the model has no <equality>"
        if model.neq > idle:
            found = "no equality ties a body that moves with the driven joint"
            found += f" ({idle} of {model.neq} are not active)" if idle else ""
        raise file.ModelError(
            f"no loop: {found}; close the loop with <equality><connect .../></equality>"
        )
