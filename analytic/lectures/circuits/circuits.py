r"""Circuits: the connected pieces of all configurations of a mechanism.

::

    output |   ____        Two branches of a dyad (+ and -) end in the same limit positions of the
           | /   +  \     driver, and are there one: a circuit is one connected piece. To come from
           |<        >     one circuit to another a mechanism has to be taken apart; from one branch
           | \__ - _/     to another of its circuit it can be brought, but not by this driver.
           +----------- driver

Source: T. R. Chase and J. A. Mirth, Circuits and branches of single-degree-of-freedom planar
linkages, Journal of Mechanical Design 115 (1993), pages 223 to 230, whose words these are.
"""

import itertools
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from analytic.change_points.find import passages
from analytic.dyads.chunk import Chunk
from analytic.lectures.circuits.arcs import Arc, ArcEnd, SignedScene, Signs, arcs
from analytic.prepared import prepared
from analytic.structure.groups import Group
from analytic.structure.mobility import analyse
from models.array import Array
from models.errors import CrankcheckError
from models.scene import Scene

SAME = 1e-7
"""Distance of limit positions [rad] that are one: groups after a dyad near its own limit have their
place to a root of rounding."""

Defect = Literal["none", "branch", "circuit", "order"]


@dataclass(frozen=True)
class Position:
    """Configuration: the driver's angle [rad] and the signs of the dyads."""

    driver_rad: float
    signs: Signs


@dataclass(frozen=True)
class Circuits:
    """Circuits of a scene, each its branches; ``change_points`` is True if some of them meet in
    change points, and then count as one."""

    signed: SignedScene
    circuits: tuple[tuple[Arc, ...], ...]
    change_points: bool

    @property
    def own(self) -> tuple[int, Arc]:
        """Circuit, from 0 on, and branch of the scene at time 0."""
        return self.place(Position(self.signed.start_rad, self.signed.signs))

    @property
    def course(self) -> list[tuple[Arc, bool]]:
        """Branches that the scene goes through, as `loop`: its own alone if it is driven."""
        own = self.own[1]
        return self.loop(own) if self.signed.scene.is_free else [(own, True)]

    def loop(self, arc: Arc) -> list[tuple[Arc, bool]]:
        """Return the branches that follow each other from ``arc`` until it is back, through the
        limit positions of the driver, each with True if its angle rises. It is the arc alone where
        that has no ends, or where branches also meet in change points."""
        every = [each for circuit in self.circuits for each in circuit]
        path, end = [(arc, True)], arc.high
        while end is not None and not self.change_points:
            here, rises = path[-1]
            end = here.high if rises else here.low
            assert end is not None  # the branch beyond a limit position ends there as well
            here = every[_beyond(self.signed, every, here, end, upper=rises)]
            if here is arc:
                break
            path.append((here, not rises))
        return path

    def place(self, position: Position) -> tuple[int, Arc]:
        """Return the circuit, from 0 on, and the branch of a position. Raises CrankcheckError where
        the mechanism can not be assembled so."""
        for number, circuit in enumerate(self.circuits):
            for arc in circuit:
                if arc.signs == position.signs and arc.holds(position.driver_rad, SAME):
                    return number, arc
        name, at = self.signed.scene.name, math.degrees(position.driver_rad)
        text = "".join("+" if sign > 0 else "-" for sign in position.signs)
        same = [a.range_rad for c in self.circuits for a in c if a.signs == position.signs]
        spans = " and ".join(f"{math.degrees(a):.6g} to {math.degrees(b):.6g}" for a, b in same)
        raise CrankcheckError(
            f"{name}: the position {at:.6g} deg with the signs {text or 'none'} can not be "
            f"assembled; these signs can at {spans or 'no angle'} deg"
        )

    def defect(self, positions: Sequence[Position]) -> Defect:
        """Return the defect that keeps the driver from the positions in their order: they lie on
        several circuits, on several branches of one, or are met in another order. A driver that
        turns fully may have either sense."""
        places = [self.place(position) for position in positions]
        if len({number for number, _ in places}) > 1:
            return "circuit"
        if len({id(arc) for _, arc in places}) > 1:
            return "branch"
        return "none" if _in_order(places[0][1], positions) else "order"


def _in_order(arc: Arc, positions: Sequence[Position]) -> bool:
    """True if a driver that goes one way along an arc meets the positions in their order."""
    low = arc.range_rad[0]
    angles = [(position.driver_rad - low + SAME) % math.tau for position in positions]
    if arc.low is None:
        ahead = [(b - a) % math.tau for a, b in itertools.pairwise(angles)]
        behind = [(a - b) % math.tau for a, b in itertools.pairwise(angles)]
        return min(sum(ahead), sum(behind)) < math.tau
    return angles in (sorted(angles), sorted(angles, reverse=True))


def circuits_of(scene: Scene) -> Circuits:
    """Find the circuits of a mechanism whose driver is a crank. Raises StructureError for another
    driver; a group other than a dyad; too many dyads; CrankcheckError for a limit position whose
    two sides do not fit together: as good as a change point."""
    signed = SignedScene.of(scene)
    every = arcs(signed)
    joined = list(range(len(every)))
    for index, arc in enumerate(every):
        for end, upper in ((arc.low, False), (arc.high, True)):
            if end is not None:
                _join(joined, index, _beyond(signed, every, arc, end, upper=upper))
    meets = _join_change_points(signed, every, joined)
    groups: dict[int, list[Arc]] = {}
    for index, arc in enumerate(every):
        groups.setdefault(_root(joined, index), []).append(arc)
    return Circuits(signed, tuple(tuple(group) for group in groups.values()), meets)


def _beyond(signed: SignedScene, every: list[Arc], arc: Arc, end: ArcEnd, *, upper: bool) -> int:
    """Return the branch beyond a limit position, back with the other sign of its dyad."""
    flipped = _flipped(signed, arc.signs, end.dyad)
    best, where = math.inf, -1
    for index, other in enumerate(every):
        meets = other.high if upper else other.low
        if other.signs == flipped and meets is not None and meets.dyad == end.dyad:
            off = abs(math.remainder(meets.angle_rad - end.angle_rad, math.tau))
            best, where = min((best, where), (off, index))
    if best > SAME:
        raise CrankcheckError(
            f"{signed.scene.name}: the limit position of the driver at "
            f"{math.degrees(end.angle_rad):.6g} deg (dyad {end.dyad}) can not be distinguished "
            "from a change point; change a length by more than rounding"
        )
    return where


def _join_change_points(signed: SignedScene, every: list[Arc], joined: list[int]) -> bool:
    """Join the branches that meet in change points; True if there are any."""
    meets, steps = False, prepared(signed.scene).steps
    for index, arc in enumerate(every):
        for key, passage in passages(signed.with_signs(arc.signs), steps).items():
            flipped = _flipped(signed, arc.signs, key)
            for angle in passage.angles.tolist():
                for other, candidate in enumerate(every):
                    if candidate.signs == flipped and candidate.holds(angle) and arc.holds(angle):
                        _join(joined, index, other)
                        meets = True
    return meets


def _flipped(signed: SignedScene, signs: Signs, dyad: str) -> Signs:
    return tuple(-s if key == dyad else s for key, s in zip(signed.dyads, signs, strict=True))


def _root(joined: list[int], index: int) -> int:
    while joined[index] != index:
        index = joined[index]
    return index


def _join(joined: list[int], one: int, other: int) -> None:
    first, second = sorted((_root(joined, one), _root(joined, other)))
    joined[second] = first


LOOKS = 2880
ZOOMS, FINER = 8, 33


@dataclass(frozen=True)
class AngleExtreme:
    """Extreme value and its driver angle [rad]."""

    value: float
    driver_rad: float


@dataclass(frozen=True)
class Transmission:
    """Dyad's least sine [1]; for two links (RRR) also the smallest and the largest transmission
    angle [rad]; for a rod and slider (RRP) the largest pressure angle [rad]."""

    dyad: str
    kind: str
    least_sine: AngleExtreme
    smallest_rad: AngleExtreme | None = None
    largest_rad: AngleExtreme | None = None

    @property
    def pressure_rad(self) -> float | None:
        """Largest pressure angle [rad], of a dyad with a slider outside."""
        return math.acos(min(self.least_sine.value, 1.0)) if self.kind == "RRP" else None


def transmissions(circuits: Circuits) -> tuple[list[Transmission], AngleExtreme]:
    """Return the transmissions of the dyads in solving order, over the scene's branch (over its
    circuit if it is free), and the least index of merit of the whole.

    The sine of a dyad is its conditioning: for two links (RRR) that of the transmission angle, for
    a rod and a slider (RRP) the cosine of the pressure angle. The determinant of the constraint
    equations of the whole mechanism is the product of the dyads' own, as they are solved one after
    the other; over the lengths in it, the product of the sines is its index of merit: 1 at best, 0
    at a dead point.

    Source: R. L. Norton, Design of Machinery, section 4.8 (transmission angle, toggle).
    """
    groups = analyse(circuits.signed.scene).groups
    found = []
    for group in groups:
        least = _extreme(circuits, group, _sine, -1.0)
        senses = (-1.0, 1.0) if group.kind == "RRR" else ()
        angles = [_extreme(circuits, group, _angle, sense) for sense in senses]
        found.append(Transmission(group.branch_key, group.kind, least, *angles))
    merit = _extreme(circuits, groups[0], _merit, -1.0) if groups else AngleExtreme(1.0, 0.0)
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
    """Return the angle at the inner pin between the lines to the outer ones [rad], 0 to pi."""
    inner = chunk.point(group.first, group.inner).p
    one = chunk.point(group.first, group.outer1).p - inner
    other = chunk.point(group.second, group.outer2).p - inner
    across = np.abs(one.x * other.y - one.y * other.x)
    angle = np.arctan2(across, one.x * other.x + one.y * other.y)
    return np.array(np.broadcast_to(angle, chunk.theta.shape))


def _extreme(
    circuits: Circuits, group: Group, of: Callable[[Chunk, Group], Array], sense: float
) -> AngleExtreme:
    """Return the largest (``sense`` 1) or smallest value over the scene's course."""
    best = AngleExtreme(-sense * math.inf, 0.0)
    for arc, _ in circuits.course:
        ready, looks = prepared(circuits.signed.with_signs(arc.signs)), arc.angles(LOOKS + 1)
        for _ in range(ZOOMS):
            value = of(ready.stretched(looks), group)
            k = int(np.nanargmax(sense * value))
            if sense * (float(value[k]) - best.value) > 0.0:
                best = AngleExtreme(float(value[k]), math.remainder(float(looks[k]), math.tau))
            looks = np.linspace(looks[max(k - 1, 0)], looks[min(k + 1, len(looks) - 1)], FINER)
    return best
