"""A vector equation of two ways to one point of a polygon, solved where two directions cross.

::

    base1 + known1 + a u1  =  base2 + known2 + b u2

The left way leads to the point over one link, the right one over another; on each, one vector has a
known direction u and an unknown length. Source: lecture "Phan tich dong hoc", part III.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from models.array import Array

Kind = Literal["whole", "rotation", "normal", "tangential", "coriolis", "sliding"]
"""``whole``: of a point against the ground; ``rotation``: of a point about another of its link;
``sliding``: of a point against the one of another body that lies under it."""
SUPERSCRIPTS: dict[Kind, str] = {
    "whole": "", "rotation": "", "normal": "n", "tangential": "t", "coriolis": "k", "sliding": "r",
}  # fmt: skip
PARALLEL = 1e-9
"""Sine of the angle between two directions below which they do not cross anywhere near."""


FLAT = 1e-2
"""Sine of the angle below which directions cross so flatly that a hand can not draw it."""


class ParallelError(Exception):
    """The two directions of a vector equation are parallel: it has no solution, or many."""


@dataclass(frozen=True)
class Term:
    """A vector of an equation: of what (``subscript``, as CB for C about B), what kind, and its
    value (2,); ``direction`` says in words what it is parallel or perpendicular to."""

    subscript: str
    kind: Kind
    value: Array
    direction: str = ""


@dataclass(frozen=True)
class EquationSide:
    """One side of the equation: from the point ``base`` of the polygon at ``start`` (2,) over
    ``known`` vectors, and on along the direction of ``unknown``, whose value is a unit vector."""

    base: str
    start: Array
    known: Sequence[Term]
    unknown: Term

    @property
    def before(self) -> Array:
        """Where the unknown vector begins (2,)."""
        return np.asarray(self.start + sum((term.value for term in self.known), np.zeros(2)))

    def with_length(self, length: float) -> tuple[Term, ...]:
        """All vectors of the way, the unknown one with its length, which may be below 0."""
        last = self.unknown
        return (
            *self.known,
            Term(last.subscript, last.kind, length * last.value, last.direction),
        )


def sine_between(one: EquationSide, other: EquationSide) -> float:
    """The sine of the angle from the direction of one way to that of the other."""
    u, v = one.unknown.value, other.unknown.value
    return float(u[0] * v[1] - u[1] * v[0])


def crossing(one: EquationSide, other: EquationSide) -> tuple[float, float]:
    """The lengths of the unknown vectors of both ways. Raises ParallelError."""
    u, v = one.unknown.value, other.unknown.value
    gap = other.before - one.before
    sine = sine_between(one, other)
    if abs(sine) < PARALLEL:
        raise ParallelError
    return (
        float(gap[0] * v[1] - gap[1] * v[0]) / sine,
        float(gap[0] * u[1] - gap[1] * u[0]) / sine,
    )
