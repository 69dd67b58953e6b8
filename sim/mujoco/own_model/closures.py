"""Equality constraints of a compiled model: loop closures, and others."""

import re
from collections.abc import Container
from dataclasses import dataclass
from typing import Any, Literal

import mujoco  # type: ignore[import-untyped]  # ships no stubs
import numpy as np

from models.array import Array
from models.errors import EngineError


class ModelError(EngineError):
    """A model that cannot be read, or that is no planar mechanism with one driver."""


MOST = 40
SEPARATORS = "./:"
"""Separators between the names of a body and of a thing on it."""
REMARK = ": "


def scene_name(name: str, otherwise: str, taken: Container[str]) -> str:
    """Return an unused name for a scene: the model's own as far as possible."""
    plain = re.sub(r"[^A-Za-z0-9_-]+", "-", name).strip("-_")[:MOST]
    if not plain or not plain[0].isalpha():
        plain = f"{otherwise}{'-' if plain else ''}{plain}"[:MOST]
    unused, count = plain, 1
    while unused in taken:
        count += 1
        tail = f"-{count}"
        unused = plain[: MOST - len(tail)] + tail
    return unused


def point_of(name: str, bodies: Container[str]) -> str:
    """Return the point of a name: ``crank.B`` on body ``crank`` is ``B``, and a remark after a
    colon is left out."""
    point = name.partition(REMARK)[0] or name
    for at, sign in enumerate(point):
        if sign in SEPARATORS and point[:at] in bodies and point[at + 1 :]:
            return point[at + 1 :]
    return point


SITE = mujoco.mjtObj.mjOBJ_SITE.value
IDLE = int(mujoco.mjtDisableBit.mjDSBL_EQUALITY) | int(mujoco.mjtDisableBit.mjDSBL_CONSTRAINT)
"""Flags of a model without active constraints."""
KINDS = {
    kind.value: kind.name.removeprefix("mjEQ_").lower()
    for kind in mujoco.mjtEq.__members__.values()
}


@dataclass(frozen=True, eq=False)
class ModelClosure:
    """A `connect` or `weld` between two bodies.

    ``anchors`` are the two copies of its point in space (3,) [m] as the model is drawn;
    ``rotation`` (3, 3) is the second body's when the weld holds, for the first as drawn. A weld of
    no torque is a ``connect`` here: it leaves the angle free.
    """

    index: int
    name: str
    kind: Literal["connect", "weld"]
    bodies: tuple[int, int]
    anchors: tuple[Array, Array]
    rotation: Array


@dataclass(frozen=True)
class Coupling:
    """Any other equality, with its bodies; it couples coordinates, and closes no loop."""

    name: str
    kind: str
    bodies: tuple[int, ...]


def name_of(model: Any, kind: str, index: int) -> str:
    """Return the name in the file of a ``joint``, a ``body`` and the like; empty without one."""
    own = getattr(mujoco.mjtObj, f"mjOBJ_{kind.upper()}")
    return mujoco.mj_id2name(model, own.value, index) or ""


def body_name(model: Any, body: int) -> str:
    """Return the name of a body, or its number."""
    return name_of(model, "body", body) or f"body{body}"


def equalities(model: Any, data: Any) -> tuple[list[ModelClosure], list[Coupling]]:
    """Return the active equalities of the model, at the pose of ``data``."""
    closures, couplings = [], []
    if int(model.opt.disableflags) & IDLE:
        return [], []
    for index in map(int, np.flatnonzero(model.eq_active0)):
        kind = KINDS[int(model.eq_type[index])]
        name = name_of(model, "equality", index)
        if kind in ("connect", "weld"):
            closures.append(_closure(model, data, index, name, kind))
        else:
            couplings.append(
                Coupling(name or f"equality {index}", kind, _coupled(model, index, kind))
            )
    return closures, couplings


def _closure(model: Any, data: Any, index: int, name: str, kind: str) -> ModelClosure:
    ends = (int(model.eq_obj1id[index]), int(model.eq_obj2id[index]))
    own = model.eq_data[index]
    if int(model.eq_objtype[index]) == SITE:
        first, second = (int(model.site_bodyid[site]) for site in ends)
        anchors = tuple(data.site_xpos[site].copy() for site in ends)
        frames = [data.site_xmat[site].reshape(3, 3) for site in ends]
        rotation = frames[0] @ frames[1].T @ _rotation(data, second)
        sites = [name_of(model, "site", site) for site in ends]
        name = name or REMARK.join(filter(None, sites))
    else:
        first, second = ends
        # In a weld the anchors are the other way round.
        locals_ = (own[0:3], own[3:6]) if kind == "connect" else (own[3:6], own[0:3])
        anchors = tuple(
            data.xpos[body] + _rotation(data, body) @ local
            for body, local in zip(ends, locals_, strict=True)
        )
        relative = np.empty(9)
        mujoco.mju_quat2Mat(relative, own[6:10] if kind == "weld" else np.array([1.0, 0, 0, 0]))
        rotation = _rotation(data, first) @ relative.reshape(3, 3)
    if not name:
        name = " to ".join(body_name(model, body) for body in (first, second))
    if not np.isfinite([*anchors, *rotation]).all():
        raise ModelError(f"<{kind}> {name}: its anchor or pose is not finite")
    turns = kind == "connect" or float(own[10]) == 0.0
    return ModelClosure(
        index,
        name,
        "connect" if turns else "weld",
        (first, second),
        (anchors[0], anchors[1]),
        rotation,
    )


def _rotation(data: Any, body: int) -> Array:
    return np.array(data.xmat[body]).reshape(3, 3)


def _coupled(model: Any, index: int, kind: str) -> tuple[int, ...]:
    """Return the bodies whose coordinates an equality couples."""
    ends = [int(model.eq_obj1id[index]), int(model.eq_obj2id[index])]
    if kind == "joint":
        return tuple(int(model.jnt_bodyid[joint]) for joint in ends if joint >= 0)
    if kind == "tendon":
        return tuple(
            body for tendon in ends if tendon >= 0 for body in tendon_bodies(model, tendon)
        )
    return ()


def tendon_bodies(model: Any, tendon: int) -> tuple[int, ...]:
    """Return the bodies that a tendon goes over."""
    first = int(model.tendon_adr[tendon])
    bodies = []
    for wrap in range(first, first + int(model.tendon_num[tendon])):
        kind, index = int(model.wrap_type[wrap]), int(model.wrap_objid[wrap])
        if kind == mujoco.mjtWrap.mjWRAP_JOINT.value:
            bodies.append(int(model.jnt_bodyid[index]))
        elif kind == mujoco.mjtWrap.mjWRAP_SITE.value:
            bodies.append(int(model.site_bodyid[index]))
        elif kind in (mujoco.mjtWrap.mjWRAP_SPHERE.value, mujoco.mjtWrap.mjWRAP_CYLINDER.value):
            bodies.append(int(model.geom_bodyid[index]))
    return tuple(bodies)
