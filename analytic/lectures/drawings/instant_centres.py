"""The instant centres of a mechanism by the theorem of Aronhold and Kennedy.

Three bodies have their three centres on a line. What joints show is known from the start: a pin is
the centre of its two bodies; that of a slider and its guide is at infinity, across the line. Each
other centre is where two lines cross, each through two centres that are known (the polygon of
centres has the bodies as its corners, known centres as sides, and a new one as the diagonal that
closes two triangles).

Centres and lines are homogeneous and of unit length, lengths over the longest link, so that what is
at infinity (a direction, the line of all directions) is as good as anything else.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from analytic.lectures.drawings.placed_mechanism import PlacedMechanism, quarter_turn
from models.array import Array
from models.scene import GROUND

Pair = frozenset[str]
SURE = 1e-7
"""Length of the product of two lines, of unit length each, below which they are one line."""
FAR = 1e-12
"""The third coordinate of what is at infinity, but for rounding."""


@dataclass(frozen=True)
class Centre:
    """An instant centre: its ``place`` [m], (2,), or None where it is at infinity, across the unit
    vector ``along`` then, in which the two bodies slide against each other.

    ``by`` names the two pairs of centres whose lines cross in it, and is empty for that of a joint.
    """

    place: Array | None
    along: Array | None = None
    by: tuple[tuple[Pair, Pair], ...] = ()


@dataclass(frozen=True)
class _Known:
    """A centre in homogeneous coordinates (3,)."""

    at: Array
    by: tuple[tuple[Pair, Pair], ...] = ()


def instant_centres(placement: PlacedMechanism) -> dict[Pair, Centre]:
    """The centres of all pairs of bodies that the theorem leads to, the joints' first."""
    size = placement.scene.longest_m
    found = _of_joints(placement, size)
    bodies = [GROUND, *placement.structure.bodies]
    while new := _crossings(bodies, found):
        found |= new
    return {pair: _centre(known, size) for pair, known in found.items()}


def _centre(known: _Known, size: float) -> Centre:
    x, y, w = known.at
    if abs(w) < FAR:
        return Centre(None, -quarter_turn(np.array([x, y])), known.by)
    return Centre(size * np.array([x, y]) / w, None, known.by)


def _of_joints(placement: PlacedMechanism, size: float) -> dict[Pair, _Known]:
    """The centres that pins and sliders show."""
    found: dict[Pair, _Known] = {}
    for point, bodies in placement.structure.pins.items():
        at = _Known(_unit(np.array([*placement.points[point] / size, 1.0])))
        found |= {frozenset(pair): at for pair in itertools.combinations(bodies, 2)}
    for slider, ends in placement.structure.prismatics.items():
        across = quarter_turn(placement.along(slider))
        found[frozenset(ends)] = _Known(np.array([*across, 0.0]))
    return found


def _crossings(bodies: list[str], found: Mapping[Pair, _Known]) -> dict[Pair, _Known]:
    """The centres that the known ones lead to at once, each by the two lines that cross best."""
    new: dict[Pair, _Known] = {}
    for pair in map(frozenset, itertools.combinations(bodies, 2)):
        if pair in found:
            continue
        lines = list(_lines(pair, bodies, found))
        crossed = [
            (np.cross(one, other), (a, b))
            for (a, one), (b, other) in itertools.combinations(lines, 2)
        ]
        at, by = max(crossed, key=lambda each: _length(each[0]), default=(np.zeros(3), ()))
        if _length(at) > SURE:
            new[pair] = _Known(_unit(at), by)
    return new


def _lines(
    pair: Pair, bodies: list[str], found: Mapping[Pair, _Known]
) -> Iterator[tuple[tuple[Pair, Pair], Array]]:
    """The lines that the centre of a pair is on, one for each third body that both have a centre
    with, but for two that are one."""
    one, other = sorted(pair)
    for third in bodies:
        sides = frozenset({one, third}), frozenset({other, third})
        if third in pair or not all(side in found for side in sides):
            continue
        line = np.cross(found[sides[0]].at, found[sides[1]].at)
        if _length(line) > SURE:
            yield sides, _unit(line)


def _length(vector: Array) -> float:
    return float(np.linalg.norm(vector))


def _unit(vector: Array) -> Array:
    return np.asarray(vector / np.linalg.norm(vector))
