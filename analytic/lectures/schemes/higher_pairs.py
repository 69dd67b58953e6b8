"""Planar schemes with links and lower pairs in place of higher pairs.

Two profiles that touch move against each other, to the second order, as if a link joined their
centres of curvature; a straight profile has its centre infinitely far, and a block that slides
along it in its place. Teeth of involutes have their centres where the line of action touches the
base circles. A link and two joints of class 5 for one of class 4 leave the count as it is:
3 - 2*2 = -1. Source: I. I. Artobolevskii, Theory of Mechanisms, chapter on structure; problem book
"Bai tap co hoc may", chapter on schemes.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from analytic.lectures.schemes.joint_chains import curvature_centres, gear_centres
from models.array import Array
from models.errors import StructureError
from models.lectures.scheme import PLANAR, Place, Scheme, SchemeJoint


def replaced(scheme: Scheme) -> Scheme:
    """The scheme with every contact and every pair of teeth replaced by a link or a block.

    It has the count, the velocities and (but for teeth on centres that move against each other)
    the accelerations of the given one, in this position.

    Raises
    ------
    StructureError
        A spatial scheme: a link between centres of curvature stands for a contact in the plane.
    """
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
    """The centres of curvature of two teeth that touch at the pitch point.

    They are the feet of the perpendiculars from both wheels' centres on the line of action, which
    goes through the pitch point, at the pressure angle from the common tangent.
    """
    first, second = gear_centres(joint)
    along = np.array(joint.axes[0])
    outward = np.sign(sum(joint.radii)) * along  # out of the first wheel where they touch
    pitch = first + joint.radii[0] * outward
    tangent = np.cross((0.0, 0.0, 1.0), along)
    action = np.cos(joint.pressure) * tangent + np.sin(joint.pressure) * along
    return (
        pitch + ((first - pitch) @ action) * action,
        pitch + ((second - pitch) @ action) * action,
    )


def _pairs(joint: SchemeJoint, link: str, scheme: Scheme) -> list[SchemeJoint]:
    """The two lower pairs of the link that stands for a higher pair."""
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
    """A name that is not taken yet, of at most 40 characters."""
    name = name[-36:]
    number = 2
    fresh = name
    while fresh in names:
        fresh, number = f"{name}-{number}", number + 1
    return fresh
