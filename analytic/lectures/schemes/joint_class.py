"""Class of a joint and its freedoms, from how its links touch.

A frictionless contact takes forces along its normals: a point one line of force, a straight line
two of them, a surface as many as its normals span. The class is the number of independent ones, 1
to 5; what does no work against any of them are the freedoms. Contact over surfaces makes a lower
pair, along lines or in points a higher one. Source: problem book "Bai tap co hoc may", chapter on
joint classes; K. H. Hunt, Kinematic Geometry of Mechanisms, chapter 1.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from scipy.optimize import linprog  # type: ignore[import-untyped]  # ships no stubs

from analytic.lectures.schemes.screws import (
    Vector,
    across,
    force,
    kernel,
    named_twists,
    names_of_freedoms,
    rank,
    reciprocal,
    rotation,
    translation,
)
from models.array import Array
from models.lectures.touching import Contact, Touching

OPENS = 1e-7
"""A rate at which a contact opens, of at most 1."""


@dataclass(frozen=True)
class JointClass:
    """The count of constraints and the freedoms that are left, by name."""

    constraints: int
    freedoms: tuple[str, ...]

    def __str__(self) -> str:
        leaves = ", ".join(self.freedoms) or "nothing: the two are one link"
        return f"class {self.constraints}, leaves {leaves}"


@dataclass(frozen=True)
class JointAnalysis:
    """A joint by its contacts alone, and as the joints next to it guide it.

    ``kept`` is whether its form keeps the two together; else a force must.
    """

    touching: Touching
    alone: JointClass
    guided: Mapping[str, JointClass]
    kept: bool


def analyse_joint(touching: Touching) -> JointAnalysis:
    """Class and freedoms of a joint, its contacts taken as closed."""
    size = _size(touching)
    loads = {
        contact: np.array(_LOADS[contact.kind](contact, _place(contact, touching, size), size))
        for contact in touching.contacts
    }
    rows = np.vstack(list(loads.values()))
    twists = named_twists()
    guided = {
        name: _class_of(
            np.vstack([rows, reciprocal(np.array([twists[each] for each in guide.leaves]).T)]),
            touching,
            size,
        )
        for name, guide in touching.guides.items()
    }
    return JointAnalysis(touching, _class_of(rows, touching, size), guided, _is_kept(loads))


def _class_of(rows: Array, touching: Touching, size: float) -> JointClass:
    """The class that wrenches make, about the joint's own point and over its size."""
    free = kernel(rows)
    free[3:] = size * free[3:] + np.cross(np.array(touching.at), free[:3].T).T
    return JointClass(rank(rows), tuple(names_of_freedoms(free, touching.at)))


def _is_kept(loads: Mapping[Contact, Array]) -> bool:
    """Whether no motion opens a contact: found by a linear program that opens as much as it can."""
    closed = [rows for contact, rows in loads.items() if contact.both_ways]
    opening = [rows for contact, rows in loads.items() if not contact.both_ways]
    if not opening:
        return True
    rows = np.vstack(opening)
    count = len(rows)
    # Of t and s: the rates W t are at least s, s is from 0 to 1, and their sum is to be large.
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


def _size(touching: Touching) -> float:
    """How far the contacts are from the joint's point at most [m]; 1 where they are in it."""
    far = [np.abs(np.subtract(contact.at, touching.at)).max() for contact in touching.contacts]
    return float(max(far)) or 1.0


def _place(contact: Contact, touching: Touching, size: float) -> Array:
    return np.asarray(np.subtract(contact.at, touching.at) / size)


def _line(contact: Contact, at: Array, size: float) -> list[Array]:
    ends = (at - np.array(contact.along), at + np.array(contact.along))
    return [force(end, contact.normal) for end in ends]


def _plane(contact: Contact, at: Array, size: float) -> list[Array]:
    first, second = across(contact.normal)
    return [force(at + each, contact.normal) for each in (first, second, -first - second)]


def _circle(contact: Contact, at: Array, size: float) -> list[Array]:
    return [force(at, each) for each in across(contact.axis)]


def _leaving(*twists: Array) -> list[Array]:
    """The wrenches of a joint that leaves some motions, and these alone."""
    return list(reciprocal(np.array(twists).T))


def _thread(contact: Contact, at: Vector, size: float) -> list[Array]:
    return _leaving(rotation(at, contact.axis, contact.lead / (2.0 * np.pi * size)))


_LOADS: Mapping[str, Callable[[Contact, Array, float], list[Array]]] = {
    "point": lambda contact, at, _: [force(at, contact.normal)],
    "line": _line,
    "circle": _circle,
    "plane": _plane,
    "cylinder": lambda contact, at, _: _leaving(
        rotation(at, contact.axis), translation(contact.axis)
    ),
    "sphere": lambda _, at, __: [force(at, axis) for axis in np.eye(3)],
    "revolution": lambda contact, at, _: _leaving(rotation(at, contact.axis)),
    "prism": lambda contact, _, __: _leaving(translation(contact.axis)),
    "thread": _thread,
}
