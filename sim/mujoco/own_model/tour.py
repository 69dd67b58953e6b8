"""What a model meets on its way round, held in the poses of the closed form: contacts, limits."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import mujoco  # type: ignore[import-untyped]  # ships no stubs
import numpy as np

from models.motion import State
from models.scene import Scene
from sim.mujoco.own_model.closures import ModelError, body_name, name_of
from sim.mujoco.own_model.component import JOINTS, joint_name, rigid
from sim.mujoco.own_model.linkage import size
from sim.mujoco.own_model.planar_model import PlanarModel, coordinates
from sim.mujoco.stepped import heard
from sim.own_models import Tour

MISREAD = 1e-6
"""A loop that MuJoCo sees open by more, over the size of the linkage, is not the one that was
read."""
EQUALITY = mujoco.mjtConstraint.mjCNSTR_EQUALITY.value


def tour(own: PlanarModel, scene: Scene, states: Sequence[State]) -> Tour:
    """Hold the model in each of the states, and look at what MuJoCo says.

    Raises
    ------
    ModelError
        MuJoCo sees a loop open that the closed form has shut: the model was misread.
    """
    model, data = own.model, mujoco.MjData(own.model)
    touching: dict[tuple[str, str], int] = {}
    low, high = np.full(model.nq, np.inf), np.full(model.nq, -np.inf)
    positions, senses = list(own.limbs.positions), np.array(own.limbs.senses)
    q = senses * own.qpos[positions]
    with heard(lambda _: None):
        for state in states:
            q = coordinates(own.limbs, scene, state, near=q)[0]
            data.qpos[positions] = senses * q
            mujoco.mj_fwdPosition(model, data)
            _refuse_misread(own, data, state)
            low, high = np.fmin(low, data.qpos), np.fmax(high, data.qpos)
            for pair in _touching(own, data):
                touching[pair] = touching.get(pair, 0) + 1
    shares = {pair: count / len(states) for pair, count in touching.items()}
    most_first = sorted(shares.items(), key=lambda item: (-item[1], item[0]))
    return Tour(dict(most_first), _passed(own, low, high))


def _refuse_misread(own: PlanarModel, data: Any, state: State) -> None:
    """Compare with MuJoCo's own residual of each loop, in the plane."""
    plane, limit = own.linkage.component.plane, MISREAD * size(own.linkage)
    rows = np.flatnonzero(np.array(data.efc_type) == EQUALITY)
    for closure in own.linkage.component.closures:
        mine = [row for row in rows if int(data.efc_id[row]) == closure.index][:3]
        if not mine:  # MuJoCo leaves out what holds nothing, such as a pin in the axis of a hinge
            continue
        gap = abs(plane.flat(np.array([data.efc_pos[row] for row in mine])))
        if not gap <= limit:
            raise ModelError(
                f"loop {closure.name}: closed in the closed form at t = {state.time_s:.4g} s, and "
                f"open by {gap:.3g} m as MuJoCo sees it: the model was misread; please report it"
            )


def _touching(own: PlanarModel, data: Any) -> set[tuple[str, str]]:
    """The pairs of geoms that push one another, one of them on the linkage: a body beside it may
    rest on its floor."""
    model, pairs = own.model, set()
    moving = {body.id for body in own.linkage.component.bodies}
    for index in range(int(data.ncon)):
        contact = data.contact[index]
        bodies = {rigid(model, int(model.geom_bodyid[g])) for g in contact.geom if g >= 0}
        pushes = int(contact.exclude) == 0 and int(contact.efc_address) >= 0
        if pushes and not moving.isdisjoint(bodies):
            first, second = sorted(_geom(model, int(geom)) for geom in contact.geom)
            pairs.add((first, second))
    return pairs


def _geom(model: Any, geom: int) -> str:
    """The name of a geom, or that of its body."""
    if geom < 0:
        return "a flex"
    name = name_of(model, mujoco.mjtObj.mjOBJ_GEOM, geom)
    return name or f"a geom of {body_name(model, int(model.geom_bodyid[geom]))}"


def _passed(own: PlanarModel, low: Any, high: Any) -> list[str]:
    """The limited joints that the way leads past their limits."""
    model, texts = own.model, []
    for body in own.linkage.component.bodies:
        for joint in (each.index for each in body.joints):
            if not model.jnt_limited[joint]:
                continue
            at = int(model.jnt_qposadr[joint])
            least, most = (float(end) for end in model.jnt_range[joint])
            past = max(least - float(low[at]), float(high[at]) - most)
            if past > 0.0:
                hinge = JOINTS[int(model.jnt_type[joint])] == "hinge"
                far = f"{math.degrees(past):.3g} deg" if hinge else f"{past:.3g} m"
                texts.append(f"joint {joint_name(model, joint)} is led past its limit by {far}")
    return texts
