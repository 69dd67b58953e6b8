"""How well each dyad is driven: its transmission angle over a branch, and the kin of a six-bar.

The sine of a dyad is its conditioning: of two links (RRR) that of the transmission angle, of a rod
and a slider (RRP) the cosine of the pressure angle. The determinant of the constraint equations of
the whole mechanism is the product of the dyads' own, as they are solved one after the other; over
the lengths in it, the product of the sines is its index of merit: 1 at best, 0 at a dead point.

Source: R. L. Norton, Design of Machinery, section 4.8 (transmission angle, toggle).
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from analytic.circuits.circuits import Circuits
from analytic.dyads.chunk import Chunk
from analytic.prepared import prepared
from analytic.structure.groups import Group
from analytic.structure.mobility import analyse
from models.array import Array

LOOKS = 2880
ZOOMS, FINER = 8, 33


@dataclass(frozen=True)
class Extreme:
    """A value and the driver's angle [rad] at which it is taken."""

    value: float
    driver_rad: float


@dataclass(frozen=True)
class Transmission:
    """Of a dyad: the least sine [1]; of two links (RRR) the smallest and the largest transmission
    angle [rad] as well; of a rod and slider (RRP) the largest pressure angle [rad]."""

    dyad: str
    kind: str
    least_sine: Extreme
    smallest_rad: Extreme | None = None
    largest_rad: Extreme | None = None

    @property
    def pressure_rad(self) -> float | None:
        """The largest pressure angle [rad], of a dyad with a slider outside."""
        return math.acos(min(self.least_sine.value, 1.0)) if self.kind == "RRP" else None


def transmissions(circuits: Circuits) -> tuple[list[Transmission], Extreme]:
    """Those of the dyads in solving order, over the branch that the scene is on, and the least
    index of merit of the whole."""
    groups = analyse(circuits.signed.scene).groups
    found = []
    for group in groups:
        least = _extreme(circuits, group, _sine, -1.0)
        if group.kind == "RRR":
            small = _extreme(circuits, group, _angle, -1.0)
            large = _extreme(circuits, group, _angle, 1.0)
            found.append(Transmission(group.branch_key, group.kind, least, small, large))
        else:
            found.append(Transmission(group.branch_key, group.kind, least))
    merit = _extreme(circuits, groups[0], _merit, -1.0) if groups else Extreme(1.0, 0.0)
    return found, merit


def _sine(chunk: Chunk, group: Group) -> Array:
    sines: Mapping[str, object] = chunk.sines
    return np.array(np.broadcast_to(np.abs(sines[group.branch_key]), chunk.theta.shape))  # type: ignore[call-overload]  # a number or an array


def _merit(chunk: Chunk, group: Group) -> Array:
    product = np.ones(chunk.theta.shape)
    for sine in chunk.sines.values():
        product = product * np.abs(sine)
    return product


def _angle(chunk: Chunk, group: Group) -> Array:
    """The angle at the inner pin between the lines to the outer ones [rad], 0 to pi."""
    inner = chunk.point(group.first, group.inner).p
    one = chunk.point(group.first, group.outer1).p - inner
    other = chunk.point(group.second, group.outer2).p - inner
    across = np.abs(one.x * other.y - one.y * other.x)
    angle = np.arctan2(across, one.x * other.x + one.y * other.y)
    return np.array(np.broadcast_to(angle, chunk.theta.shape))


def _extreme(circuits: Circuits, group: Group, of: object, sense: float) -> Extreme:
    """The largest (``sense`` 1) or smallest value over the branch."""
    assert callable(of)
    ready, (_, arc) = prepared(circuits.signed.scene), circuits.own
    looks = arc.angles(LOOKS + 1)
    best = Extreme(-sense * math.inf, 0.0)
    for _ in range(ZOOMS):
        value = of(ready.stretched(looks), group)
        k = int(np.nanargmax(sense * value))
        if sense * (float(value[k]) - best.value) > 0.0:
            best = Extreme(float(value[k]), math.remainder(float(looks[k]), math.tau))
        looks = np.linspace(looks[max(k - 1, 0)], looks[min(k + 1, len(looks) - 1)], FINER)
    return best
