"""Joints as rows of successive turns and displacements of their freedoms.

The pose of the second link in the first one is exp(s1 q1) exp(s2 q2) ..., with the screws s of the
drawn position, exact however far the joint moves. Higher pairs are replaced beyond the instant: a
planar contact by the centres of curvature of its two profiles (exact to the second order, for
circles and straight lines always), gears by the line of centres, about whose two ends they roll.

Two profiles that touch move against each other, to the second order, as if a link joined their
centres of curvature; a straight profile has its centre at infinity, and is replaced by a block that
slides along it. Teeth of involutes have their centres where the line of action touches the base
circles. A link and two joints of class 5 for one of class 4 leave the count as it is: 3 - 2*2 = -1.
Source: I. I. Artobolevskii, Theory of Mechanisms, chapter on structure; problem book "Bai tap co
hoc may", chapter on schemes.

A frictionless contact takes forces along its normals: a point one line of force, a straight line
two of them, a surface as many as its normals span. The class is the number of independent ones, 1
to 5; the freedoms are the motions against which none of them does work. Contact over surfaces makes
a lower pair, along lines or in points a higher one. Source: problem book "Bai tap co hoc may",
chapter on joint classes; K. H. Hunt, Kinematic Geometry of Mechanisms, chapter 1.
"""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np

from analytic.lectures.schemes import screws
from models.array import Array
from models.errors import StructureError
from models.lectures.scheme import PLANAR, Place, Scheme, SchemeJoint
from models.lectures.touching import Contact, Touching

UP = (0.0, 0.0, 1.0)
"""Normal of the plane of a planar scheme."""


@dataclass(frozen=True)
class Element:
    """Screw, and its factor of the freedom numbered ``freedom``."""

    twist: Array
    freedom: int
    factor: float = 1.0


def chain_of(joint: SchemeJoint) -> tuple[Element, ...]:
    """Return the row of screws that a joint leaves, from the first link to the second."""
    found = _KINDS[joint.kind](joint)
    if joint.kind == "gear":
        _, _, roll = found
        first, second = joint.radii
        # About the line of centres the second gear turns r1 / r2 as much as the first one.
        return (Element(found[0], 0), Element(found[1], 1), Element(roll, 0, first / second))
    return tuple(Element(twist, freedom) for freedom, twist in enumerate(found))


def curvature_centres(joint: SchemeJoint) -> tuple[Array | None, Array | None]:
    """Return the centres of curvature of a planar contact's profiles, None for a straight one."""
    at, normal = np.array(joint.at), np.array(joint.axes[0])
    first, second = joint.radii
    return (
        None if math.isinf(first) else at - first * normal,
        None if math.isinf(second) else at + second * normal,
    )


def gear_centres(joint: SchemeJoint) -> tuple[Array, Array]:
    """Return the centres of two gears."""
    at = np.array(joint.at)
    return at, at + abs(sum(joint.radii)) * np.array(joint.axes[0])


def _contact(joint: SchemeJoint) -> list[Array]:
    tangent = np.cross(UP, joint.axes[0])
    return [
        screws.translation(tangent) if centre is None else screws.rotation(centre, UP)
        for centre in curvature_centres(joint)
    ]


def _gear(joint: SchemeJoint) -> list[Array]:
    first, second = (screws.rotation(centre, UP) for centre in gear_centres(joint))
    return [first, screws.translation(joint.axes[0]), second]


def _turns(joint: SchemeJoint) -> list[Array]:
    return [screws.rotation(joint.at, axis) for axis in np.eye(3)]


def _slides(normal: tuple[float, float, float]) -> list[Array]:
    return [screws.translation(axis) for axis in screws.across(normal)]


_KINDS: Mapping[str, Callable[[SchemeJoint], list[Array]]] = {
    "pin": lambda j: [screws.rotation(j.at, UP)],
    "slider": lambda j: [screws.translation(j.axes[0])],
    "contact": _contact,
    "gear": _gear,
    "revolute": lambda j: [screws.rotation(j.at, j.axes[0])],
    "prismatic": lambda j: [screws.translation(j.axes[0])],
    "screw": lambda j: [screws.rotation(j.at, j.axes[0], j.lead / (2.0 * math.pi))],
    "cylindrical": lambda j: [screws.translation(j.axes[0]), screws.rotation(j.at, j.axes[0])],
    "universal": lambda j: [screws.rotation(j.at, j.axes[0]), screws.rotation(j.at, j.axes[1])],
    "spherical": _turns,
    "planar": lambda j: [*_slides(j.axes[0]), screws.rotation(j.at, j.axes[0])],
    "ball-in-tube": lambda j: [screws.translation(j.axes[0]), *_turns(j)],
    "cylinder-on-plane": lambda j: [
        *_slides(j.axes[1]),
        screws.rotation(j.at, j.axes[1]),
        screws.rotation(j.at, j.axes[0]),
    ],
    "ball-on-plane": lambda j: [*_slides(j.axes[0]), *_turns(j)],
}


def replaced(scheme: Scheme) -> Scheme:
    """Return the scheme with every contact and every pair of teeth replaced by a link or a block.
    It has the count, the velocities and (except teeth on centres that move against each other) the
    accelerations of the given one, in this position. Raises StructureError for a spatial scheme: a
    link between centres of curvature replaces a contact in the plane only."""
    if scheme.space != PLANAR:
        raise StructureError(
            f"{scheme.name}: a spatial scheme; higher pairs are replaced in planar ones"
        )
    links, joints = list(scheme.links), []
    for joint in scheme.joints:
        if joint.kind not in ("contact", "gear"):
            joints.append(joint)
            continue
        link = _unused(f"{joint.name}-link", scheme.links)
        links.append(link)
        joints += _pairs(joint, link, scheme)
    return replace(scheme, links=tuple(links), joints=tuple(joints))


def teeth_centres(joint: SchemeJoint) -> tuple[Array, Array]:
    """Return the centres of curvature of two teeth that touch at the pitch point. They are the feet
    of the perpendiculars from both wheels' centres on the line of action, which goes through the
    pitch point, at the pressure angle from the common tangent."""
    first, second = gear_centres(joint)
    along = np.array(joint.axes[0])
    outward = np.sign(sum(joint.radii)) * along  # out of the first wheel where they touch
    pitch = first + joint.radii[0] * outward
    tangent = np.cross((0.0, 0.0, 1.0), along)
    action = np.cos(joint.pressure) * tangent + np.sin(joint.pressure) * along
    one, other = (pitch + ((centre - pitch) @ action) * action for centre in (first, second))
    return one, other


def _pairs(joint: SchemeJoint, link: str, scheme: Scheme) -> list[SchemeJoint]:
    """Return the two lower pairs of the link that replaces a higher pair."""
    centres = teeth_centres(joint) if joint.kind == "gear" else curvature_centres(joint)
    names = [each.name for each in scheme.joints]
    found = []
    for number, centre in enumerate(centres):
        name = _unused(f"{joint.name}-{number + 1}", names)
        own = joint.between[number]
        between = (own, link) if number == 0 else (link, own)
        if centre is None:
            x, y, _ = joint.axes[0]
            found.append(SchemeJoint(name, "slider", between, joint.at, ((-y, x, 0.0),)))
        else:
            found.append(SchemeJoint(name, "pin", between, _place(centre)))
    return found


def _place(point: Array) -> Place:
    x, y, z = map(float, point)
    return (x, y, z)


def _unused(name: str, names: list[str] | tuple[str, ...]) -> str:
    """Return an unused name, of at most 40 characters."""
    fresh = name = name[-36:]
    number = 2
    while fresh in names:
        fresh, number = f"{name}-{number}", number + 1
    return fresh


OPENS = 1e-7
"""Rate at which a contact opens, of at most 1."""


@dataclass(frozen=True)
class JointClass:
    """Number of constraints, and names of the remaining freedoms."""

    constraints: int
    freedoms: tuple[str, ...]

    def __str__(self) -> str:
        leaves = ", ".join(self.freedoms) or "nothing: the two are one link"
        return f"class {self.constraints}, leaves {leaves}"


@dataclass(frozen=True)
class JointAnalysis:
    """Analysis of a joint by its contacts alone, and with the guidance of neighbouring joints.
    ``kept`` is True if its form keeps the two together; else a force must."""

    touching: Touching
    alone: JointClass
    guided: Mapping[str, JointClass]
    kept: bool


def analyse_joint(touching: Touching) -> JointAnalysis:
    """Find class and freedoms of a joint, its contacts taken as closed."""
    away = [np.subtract(contact.at, touching.at) for contact in touching.contacts]
    size = float(max(np.abs(each).max() for each in away)) or 1.0  # about the joint's point [m]
    loads = {
        contact: np.array(_LOADS[contact.kind](contact, np.asarray(each / size), size))
        for contact, each in zip(touching.contacts, away, strict=True)
    }
    rows = np.vstack(list(loads.values()))
    twists, guided = screws.named_twists(), {}
    for name, guide in touching.guides.items():
        held = screws.reciprocal(np.array([twists[each] for each in guide.leaves]).T)
        guided[name] = _class_of(np.vstack([rows, held]), touching, size)
    return JointAnalysis(touching, _class_of(rows, touching, size), guided, _is_kept(loads))


def _class_of(rows: Array, touching: Touching, size: float) -> JointClass:
    """Return the class of wrenches, about the joint's own point and over its size."""
    free = screws.kernel(rows)
    free[3:] = size * free[3:] + np.cross(np.array(touching.at), free[:3].T).T
    return JointClass(screws.rank(rows), tuple(screws.names_of_freedoms(free, touching.at)))


def _is_kept(loads: Mapping[Contact, Array]) -> bool:
    """True if no motion opens a contact: by a linear program that opens as much as it can."""
    from scipy.optimize import linprog  # type: ignore[import-untyped]  # ships no stubs

    closed = [rows for contact, rows in loads.items() if contact.both_ways]
    opening = [rows for contact, rows in loads.items() if not contact.both_ways]
    if not opening:
        return True
    rows = np.vstack(opening)
    count = len(rows)
    # In t and s: the rates W t are at least s, s is from 0 to 1, and their sum is maximised.
    held = np.vstack([np.zeros((0, 6)), *closed])
    answer = linprog(
        np.concatenate([np.zeros(6), -np.ones(count)]),
        A_ub=np.hstack([-rows, np.eye(count)]),
        b_ub=np.zeros(count),
        A_eq=np.hstack([held, np.zeros((len(held), count))]) if len(held) else None,
        b_eq=np.zeros(len(held)) if len(held) else None,
        bounds=[(None, None)] * 6 + [(0.0, 1.0)] * count,
    )
    return bool(-answer.fun < OPENS)


def _line(contact: Contact, at: Array, size: float) -> list[Array]:
    ends = (at - np.array(contact.along), at + np.array(contact.along))
    return [screws.force(end, contact.normal) for end in ends]


def _plane(contact: Contact, at: Array, size: float) -> list[Array]:
    first, second = screws.across(contact.normal)
    return [screws.force(at + each, contact.normal) for each in (first, second, -first - second)]


def _circle(contact: Contact, at: Array, size: float) -> list[Array]:
    return [screws.force(at, each) for each in screws.across(contact.axis)]


def _leaving(*twists: Array) -> list[Array]:
    """Return the wrenches of a joint that leaves some motions, and these alone."""
    return list(screws.reciprocal(np.array(twists).T))


def _thread(contact: Contact, at: screws.Vector, size: float) -> list[Array]:
    return _leaving(screws.rotation(at, contact.axis, contact.lead / (2.0 * np.pi * size)))


_LOADS: Mapping[str, Callable[[Contact, Array, float], list[Array]]] = {
    "point": lambda contact, at, _: [screws.force(at, contact.normal)],
    "line": _line,
    "circle": _circle,
    "plane": _plane,
    "cylinder": lambda contact, at, _: _leaving(
        screws.rotation(at, contact.axis), screws.translation(contact.axis)
    ),
    "sphere": lambda _, at, __: [screws.force(at, axis) for axis in np.eye(3)],
    "revolution": lambda contact, at, _: _leaving(screws.rotation(at, contact.axis)),
    "prism": lambda contact, _, __: _leaving(screws.translation(contact.axis)),
    "thread": _thread,
}
