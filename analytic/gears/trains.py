"""Speeds of a gear train from the relations of its pairs, in exact fractions.

Each pair relates the speeds of its gears and of their carrier (`models.scene.pairs.Gear`):

    z0 omega0 + s z1 omega1 - (z0 + s z1) omega_c = 0

With the ground at rest the mobility is the number of moving bodies less the rank of these rows; the
null space has the ratios. An elementary train is the gears that mesh with each other on one
carrier: seen from it, gear a over gear b turns by the product of teeth along the way between them,
each external mesh reversing it, (omega_a - omega_c)/(omega_b - omega_c) = prod (-+ z/z'). Sources:
Willis, Principles of Mechanism (1841), as rows of one matrix; Mueller, Epicyclic Drive Trains
(1982); Shigley, Mechanical Engineering Design, 13-13 (train value e).
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

from analytic.structure.gear_groups import reduced
from models.errors import CrankcheckError, few
from models.scene import GROUND
from models.scene.pairs import Gear

LISTED = 12
"""Names that a message lists."""


@dataclass(frozen=True)
class Train:
    """The gear pairs of a train. Raises CrankcheckError for none, and for pairs that lock each
    other: an over-constrained train."""

    gears: tuple[Gear, ...]

    def __post_init__(self) -> None:
        if not self.gears:
            raise CrankcheckError("a gear train has one pair of gears or more; found none")
        locked = self.gears if _lock(self.gears) else ()
        for gear in locked:  # as few as lock each other: without any one of them they move
            without = tuple(each for each in locked if each is not gear)
            locked = without if _lock(without) else locked
        if locked:
            names = few((gear.name for gear in locked), LISTED)
            moves = "" if self.mobility else ", and the train does not move"
            raise CrankcheckError(
                f"gears {names}: an over-constrained train{moves}; their relations contradict "
                "each other unless all their bodies turn as one: leave one of them out, or release "
                "a body (one that is the ground, or another carrier)"
            )

    @cached_property
    def bodies(self) -> tuple[str, ...]:
        """Moving bodies, in the order of the pairs."""
        named = (body for gear in self.gears for body in (*gear.bodies, gear.carrier))
        return tuple(body for body in dict.fromkeys(named) if body != GROUND)

    @cached_property
    def mobility(self) -> int:
        """Number of independent inputs: 1 of most trains, 2 of a differential."""
        return len(self.bodies) - _rank(self.gears, self.bodies)

    @property
    def passive(self) -> int:
        """Number of dependent relations: those of all equal planets but one."""
        return len(self.gears) - len(self.bodies) + self.mobility

    def influence(self, inputs: Sequence[str]) -> Mapping[str, tuple[Fraction, ...]]:
        """Return the speed of each body as a sum over the speeds of the inputs: its coefficients,
        by body, the inputs and the ground included.

        Raises CrankcheckError for inputs that the train lacks, that depend on each other, or that
        leave bodies open.
        """
        for body in inputs:
            if body not in self.bodies:
                raise CrankcheckError(
                    f"{body}: no body of the train; use {few(self.bodies, LISTED)}"
                )
        others = [body for body in self.bodies if body not in inputs]
        rows, pivots = reduced(_rows(self.gears, (*others, *inputs)))
        if pivots and pivots[-1] >= len(others):
            parts = zip(inputs, rows[-1][len(others) :], strict=True)
            tie = " ".join(f"{'-' if x < 0 else '+'} {abs(x)} omega_{b}" for b, x in parts if x)
            raise CrankcheckError(
                f"speeds of {' and '.join(inputs)}: not independent, as {tie} = 0 in this train "
                f"of mobility {self.mobility}; give fewer, or those of others"
            )
        if len(inputs) < self.mobility:
            alone = [sum(map(bool, row[: len(others)])) == 1 for row in rows]
            settled = {n for n, one in zip(pivots, alone, strict=True) if one}
            hidden = [body for n, body in enumerate(others) if n not in settled]
            raise CrankcheckError(
                f"speeds of {' and '.join(inputs) or 'no body'}: the train has mobility "
                f"{self.mobility}, and they leave {few(hidden, LISTED)} open; give "
                f"{self.mobility - len(inputs)} more"
            )
        unit = {body: tuple(Fraction(body == one) for one in inputs) for body in (GROUND, *inputs)}
        solved = zip(others, rows, strict=True)
        own = {body: tuple(-x for x in row[len(others) :]) for body, row in solved}
        return {body: (own | unit)[body] for body in (GROUND, *self.bodies)}

    def speeds(self, inputs: Mapping[str, float]) -> dict[str, float]:
        """Return the speeds of all bodies, the ground's 0 first [rad/s], for those of the inputs.
        Raises CrankcheckError as `influence`."""
        coefficients = self.influence(tuple(inputs))
        given = [Fraction(speed) for speed in inputs.values()]
        return {
            body: float(sum(x * u for x, u in zip(row, given, strict=True)))
            for body, row in coefficients.items()
        }


def _lock(gears: Sequence[Gear]) -> bool:
    """True if every motion, the ground free to turn too, turns one of the pairs as one body: then
    its gear's speed less its carrier's is a combination of the rows."""
    bodies = {body: None for gear in gears for body in gear.relation}
    rows, rank = _rows(gears, bodies), _rank(gears, bodies)
    for gear in gears:
        one = next(body for body in gear.bodies if body != gear.carrier)
        apart = [Fraction((body == one) - (body == gear.carrier)) for body in bodies]
        if len(reduced([*rows, apart])[1]) == rank:
            return True
    return False


def _rows(gears: Iterable[Gear], bodies: Collection[str]) -> list[list[Fraction]]:
    return [[Fraction(gear.relation.get(body, 0)) for body in bodies] for gear in gears]


def _rank(gears: Iterable[Gear], bodies: Collection[str]) -> int:
    return len(reduced(_rows(gears, bodies))[1])


@dataclass(frozen=True)
class ElementaryTrain:
    """Gears that mesh on one ``carrier``; ``values``, by gear, are their speeds against it over
    that of the first, basic ratios, and ``gears`` the names of the pairs."""

    carrier: str
    values: Mapping[str, Fraction]
    gears: tuple[str, ...]


def elementary_trains(gears: Iterable[Gear]) -> list[ElementaryTrain]:
    """Return the elementary trains of gear pairs, in the order of their first pairs."""
    left, found = list(gears), list[ElementaryTrain]()
    while left:
        first = left[0]
        values, used = {first.bodies[0]: Fraction(1)}, list[Gear]()
        while meshing := next((g for g in left if g.carrier == first.carrier
                               and not values.keys().isdisjoint(g.bodies)), None):  # fmt: skip
            left.remove(meshing)
            used.append(meshing)
            ratio = Fraction(-meshing.teeth[0], meshing.second)
            a, b = meshing.bodies
            if a in values:
                values.setdefault(b, values[a] * ratio)
            else:
                values[a] = values[b] / ratio
        found.append(ElementaryTrain(first.carrier, values, tuple(g.name for g in used)))
    return found
