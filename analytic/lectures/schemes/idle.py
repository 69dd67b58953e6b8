"""Idle freedoms: what a link, or a row of two, can do by itself while all others stay.

A roller turns about its pin, a rod between two ball joints about the line of these: the count has
such a freedom, and no other link feels it. A link at the end of an arm, and a shaft in its bearings
alone, move others or are what is to be moved; so idle is what stands between two other bodies.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from analytic.lectures.schemes.drawing_frame import DrawingFrame
from analytic.lectures.schemes.freedom_names import axis_in_words
from analytic.lectures.schemes.scheme_loops import Loops
from analytic.lectures.schemes.screws import DEPENDENT, kernel, reciprocal
from models.array import Array
from models.lectures.scheme import Scheme, SchemeJoint


@dataclass(frozen=True)
class Idle:
    """A freedom that only ``links`` have, and what it is in the drawn position."""

    links: tuple[str, ...]
    freedoms: int
    motion: str

    def __str__(self) -> str:
        return f"{' with '.join(self.links)}: {self.motion}"


def idle_freedoms(loops: Loops, q: Array) -> list[Idle]:
    """The idle freedoms that a scheme has next to its drawn position, at ``q`` (f,)."""
    scheme = loops.scheme
    next_to = loops.joint_twists(q)
    drawn = loops.joint_twists(np.zeros(loops.freedoms))
    found: list[Idle] = []
    for links in _rows(scheme):
        if any(set(links) & set(idle.links) for idle in found):
            continue
        outer = _outer(scheme, links)
        if len({_far(joint, links) for joint in outer}) < 2:
            continue
        own = _common(next_to, outer)
        if own.shape[1]:
            words = _words(_common(drawn, outer), own.shape[1], outer, loops.frame)
            found.append(Idle(links, own.shape[1], words))
    return found


def _rows(scheme: Scheme) -> Iterator[tuple[str, ...]]:
    """Single links, then links of two joints in pairs: both turn where their joint holds them."""
    yield from ((link,) for link in scheme.links)
    binary = {link for link in scheme.links if len(list(scheme.joints_of(link))) == 2}
    for joint in scheme.joints:
        if binary.issuperset(joint.between):
            yield joint.between


def _outer(scheme: Scheme, links: tuple[str, ...]) -> list[SchemeJoint]:
    """The joints of some links with others."""
    return [joint for joint in scheme.joints if len(set(joint.between) & set(links)) == 1]


def _far(joint: SchemeJoint, links: tuple[str, ...]) -> str:
    first, second = joint.between
    return second if first in links else first


def _common(twists: Mapping[str, Array], joints: list[SchemeJoint]) -> Array:
    """The motions (6, d) that all of some joints leave."""
    return kernel(np.vstack([reciprocal(twists[joint.name]) for joint in joints]))


def _words(motions: Array, freedoms: int, outer: list[SchemeJoint], frame: DrawingFrame) -> str:
    """What the motion is, by the joints' names where its axis goes through both."""
    if freedoms > 1 or motions.shape[1] != 1:
        return f"{freedoms} freedoms of its own"
    twist = motions[:, 0]
    places = [frame.at(joint.at) for joint in outer]
    omega, v = twist[:3], twist[3:]
    stays = [np.abs(v + np.cross(omega, place)).max() < DEPENDENT for place in places]
    names = [joint.name for joint in outer]
    if len(outer) == 2 and all(stays) and np.ptp(places, axis=0).max() > DEPENDENT:
        return f"turns about the line through {names[0]} and {names[1]}"
    if np.abs(omega[:2]).max() < DEPENDENT and any(stays):
        return f"turns about {names[stays.index(True)]}"
    return axis_in_words(frame.in_drawing(twist))
