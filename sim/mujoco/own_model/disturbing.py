"""Disturbances of a model: everything beside its linkage that can spoil a comparison."""

import math
from collections.abc import Iterable, Iterator
from typing import Any

import mujoco  # type: ignore[import-untyped]  # ships no stubs
import numpy as np

from models.errors import few
from sim.mujoco.own_model.component import PARALLEL_DEG
from sim.mujoco.own_model.driven_loop import WORLD, is_hinge, joint_name, reading, rigid
from sim.mujoco.own_model.file import body_name, equalities, name_of, tendon_bodies
from sim.mujoco.own_model.linkage import Linkage, size
from sim.mujoco.own_model.pins import far_pins, misses
from sim.registry.own_models import FAR_PIN, Disturbance

SLIDE = mujoco.mjtJoint.mjJNT_SLIDE.value
SHOWN = 6
OPEN = 1e-4
"""Gap of a loop in a keyframe, over the size of the linkage, that is more than rounding."""
HEAVY = 1e3
"""Armature over the largest inertia of a body from which on soft loops yield first."""
SOFT_S = 0.02
"""MuJoCo's own time constant of a loop; a longer one is softer."""
STIFFNESS, DAMPING = 1.0 / SOFT_S**2, 2.0 / SOFT_S
"""Stiffness [1/s^2] and damping [1/s] of MuJoCo's own loop, as by a solref of numbers below 0."""


def disturbances(linkage: Linkage) -> list[Disturbance]:
    """List all disturbances except contacts, which depend on the positions of the links; a kind
    with a switch is a key of `variants.OFF`."""
    model = linkage.component.model
    ids = {body.id for body in linkage.component.bodies}
    found = [
        *_passive(model, ids, linkage.component.driven),
        *_readings(model, ids),
        *_keyframes(linkage),
        *((FAR_PIN, text) for text in far_pins(linkage)),
        *(("missed", text) for text in misses(linkage)),
        *_tendons(model, ids),
        *_actuators(model, ids),
        *_loads(linkage),
        *_carried(model, ids),
        *_loops(linkage),
        *_apart(linkage),
        *_others(model, ids),
    ]
    return [Disturbance(kind, text) for kind, text in found]


Kind = tuple[str, str]
"""Kind and text of a disturbance."""


def _own(model: Any, ids: set[int]) -> Iterator[tuple[int, int, str]]:
    """Yield the joints of the linkage, their first freedom, and their name."""
    for joint in range(model.njnt):
        if rigid(model, int(model.jnt_bodyid[joint])) in ids:
            yield joint, int(model.jnt_dofadr[joint]), joint_name(model, joint)


def _passive(model: Any, ids: set[int], driven: int) -> Iterator[Kind]:
    """Yield springs, damping, dry friction, heavy armatures and limits of joints; the driven
    joint's armature does not matter."""
    for joint, dof, name in _own(model, ids):
        hinge = is_hinge(model, joint)
        force, length = ("N m", "rad") if hinge else ("N", "m")
        at = f"joint {name}"
        for kind, value, what, unit in (
            ("springs", model.jnt_stiffness[joint], "a spring", f"{force}/{length}"),
            ("damping", model.dof_damping[dof], "damping", f"{force} s/{length}"),
            ("friction", model.dof_frictionloss[dof], "dry friction", force),
        ):
            if np.any(value):
                yield kind, f"{at}: {what} of {float(np.ravel(value)[0]):g} {unit}"
        rotor = float(model.dof_armature[dof])
        if rotor > HEAVY * float(model.body_inertia[1:].max()) and joint != driven:
            inertia = f"{rotor:.3g} {'kg m^2' if hinge else 'kg'}"
            yield "armature", f"{at}: an armature of {inertia}, which is hard to move"
        if model.jnt_limited[joint]:
            span = " to ".join(reading(float(end), hinge) for end in model.jnt_range[joint])
            more = ", and it is the driven one" if joint == driven else ""
            yield "limits", f"{at}: limited to {span}{more}"
            yield from _out_of_range(model, joint, at, hinge)


def _out_of_range(model: Any, joint: int, at: str, hinge: bool) -> Iterator[Kind]:
    """Yield a joint that is drawn outside its limits: its ref is wrong, or they are."""
    drawn = float(model.qpos0[model.jnt_qposadr[joint]])
    low, high = (float(end) for end in model.jnt_range[joint])
    if not low <= drawn <= high:
        text = f"{at}: it reads {reading(drawn, hinge)} as it is drawn, outside its limits"
        yield "reading", f"{text}; is its ref right?"


def _readings(model: Any, ids: set[int]) -> Iterator[Kind]:
    """Yield the joints that have a coordinate other than 0 as drawn, by their ref."""
    readings = [
        f"{name} {reading(ref, is_hinge(model, joint))}"
        for joint, _, name in _own(model, ids)
        if model.jnt_type[joint] >= SLIDE and (ref := float(model.qpos0[model.jnt_qposadr[joint]]))
    ]
    if readings:
        text = f"ref makes joints read as they are drawn: {few(readings, SHOWN)}"
        yield "reading", text


def _keyframes(linkage: Linkage) -> Iterator[Kind]:
    component, extent = linkage.component, size(linkage)
    model, data = component.model, mujoco.MjData(component.model)
    own = {each.index for each in component.closures}
    for key in range(model.nkey):
        mujoco.mj_resetDataKeyframe(model, data, key)
        mujoco.mj_kinematics(model, data)
        gaps = [
            (abs(component.plane.flat(each.anchors[1] - each.anchors[0])), each.name)
            for each in equalities(model, data)[0]
            if each.index in own
        ]
        gap, name = max(gaps)
        if gap > OPEN * extent:
            called = name_of(model, "key", key) or str(key)
            yield "reading", f"keyframe {called}: loop {name} is open by {gap:.3g} m"


def _tendons(model: Any, ids: set[int]) -> Iterator[Kind]:
    for tendon in range(model.ntendon):
        if any(rigid(model, body) in ids for body in tendon_bodies(model, tendon)):
            name = name_of(model, "tendon", tendon) or str(tendon)
            acts = [
                kind
                for kind, value in (
                    ("springs", model.tendon_stiffness[tendon]),
                    ("damping", model.tendon_damping[tendon]),
                    ("friction", model.tendon_frictionloss[tendon]),
                    ("limits", model.tendon_limited[tendon]),
                )
                if np.any(value)
            ]
            for kind in acts:
                yield kind, f"tendon {name} goes over the linkage: {kind}"
            rotor = float(model.tendon_armature[tendon])
            if rotor:
                text = f"tendon {name} goes over the linkage: an armature of {rotor:g}"
                yield "armature", f"{text}, which moves with it"


def _actuators(model: Any, ids: set[int]) -> Iterator[Kind]:
    """Yield actuators of joints and tendons of the linkage; their control is 0, or the key's."""
    kinds = mujoco.mjtTrn
    for index in range(model.nu):
        kind, target = int(model.actuator_trntype[index]), int(model.actuator_trnid[index, 0])
        if kind in (kinds.mjTRN_JOINT.value, kinds.mjTRN_JOINTINPARENT.value):
            on, where = [int(model.jnt_bodyid[target])], f"joint {joint_name(model, target)}"
        elif kind == kinds.mjTRN_TENDON.value:
            on, where = list(tendon_bodies(model, target)), "a tendon"
        elif kind in (kinds.mjTRN_SITE.value, kinds.mjTRN_SLIDERCRANK.value):
            on, where = [int(model.site_bodyid[target])], "a site"
        else:
            on, where = list(range(model.nbody)), "bodies"
        if any(rigid(model, body) in ids for body in on):
            name = name_of(model, "actuator", index) or str(index)
            yield "actuators", f"actuator {name} acts on {where}"


def _loads(linkage: Linkage) -> Iterator[Kind]:
    opt, plane = linkage.component.model.opt, linkage.component.plane
    gravity = np.array(opt.gravity, dtype=np.float64)
    across = plane.height(gravity)
    if abs(plane.flat(gravity)) > 0.0:
        yield "gravity", f"gravity of {abs(plane.flat(gravity)):.4g} m/s^2 in the plane"
    if abs(across) > math.sin(math.radians(PARALLEL_DEG)) * (float(np.linalg.norm(gravity)) or 1.0):
        text = f"gravity of {abs(across):.4g} m/s^2 across the plane: the bearings carry it"
        yield "gravity", text
    if float(opt.density) or float(opt.viscosity):
        yield "medium", f"a medium of density {opt.density:g}, viscosity {opt.viscosity:g}"


def _carried(model: Any, ids: set[int]) -> Iterator[Kind]:
    """Yield bodies of the linkage whose weight is reduced or increased, where there is gravity."""
    if not np.any(model.opt.gravity):
        return
    for body in np.flatnonzero(model.body_gravcomp):
        if rigid(model, int(body)) in ids:
            share, name = float(model.body_gravcomp[body]), body_name(model, int(body))
            text = f"body {name}: gravcomp lifts it by {share:g} x its weight"
            yield "gravity", text


def _loops(linkage: Linkage) -> Iterator[Kind]:
    """Yield loops that are softer than MuJoCo's own."""
    model = linkage.component.model
    for each in linkage.component.closures:
        first, second = (float(number) for number in model.eq_solref[each.index])
        # Both above 0 are a time constant and a damping ratio, both below a stiffness and a damping
        # with the sign changed; for others MuJoCo takes its own.
        if first > SOFT_S * (1 + 1e-9) and second > 0.0:
            text = f"time constant of {first:g} s, {first / SOFT_S:.2g} times MuJoCo's own"
            yield "softness", f"loop {each.name}: solref gives it a {text}"
        elif max(first, second) <= 0.0 and (-first < STIFFNESS or -second < DAMPING):
            text = (
                f"stiffness of {abs(first):g} 1/s^2 and a damping of {abs(second):g} 1/s; "
                f"MuJoCo's own are {STIFFNESS:g} and {DAMPING:g}"
            )
            yield "softness", f"loop {each.name}: solref gives it a {text}"


def _apart(linkage: Linkage) -> Iterator[Kind]:
    """Yield closures whose two points are at different heights over the plane: they never meet."""
    component = linkage.component
    for each in component.closures:
        first, second = each.anchors
        apart = abs(component.plane.height(second - first))
        if apart > 1e-9 * max(1.0, float(np.abs(first).max())):
            text = f"its two points are {apart:.4g} m apart across the plane"
            yield "apart", f"loop {each.name}: {text}"


def _others(model: Any, ids: Iterable[int]) -> Iterator[Kind]:
    """Yield moving bodies beside the linkage, and mocap bodies."""
    roots = {int(body) for body in model.body_weldid} - set(ids) - {WORLD}
    moving = [body_name(model, body) for body in sorted(roots) if int(model.body_mocapid[body]) < 0]
    if moving:
        yield "others", f"bodies beside the linkage: {few(moving, SHOWN)}"
    if model.nmocap:
        yield "others", "mocap bodies count as ground"
