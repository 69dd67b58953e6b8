r"""Gear trains in the structure of a mechanism: links whose angles follow from known ones.

::

        known angles          relations of gears              train
                              z0 (t0 - tc) + z1 (t1 - tc) = k
      sun, ground  ---------->  sun - planet, arm   ------>  planet, arm
                                planet - ring, arm

As many relations as unknown links, and each link on a pin of a known one or of the train. With C
the coefficients of the unknown links, a row for each gear, the angles are C^-1 (k - C_known t), and
the couples that the gears exert are -C^-T times the moments on the links about their pins.

Source: R. Willis' formula, e.g. Norton, Design of Machinery, section 9.9.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction

from models.scene.pairs import Gear

Rows = tuple[tuple[Fraction, ...], ...]
Hanging = Mapping[str, Sequence[tuple[str, Sequence[str]]]]
"""Pairs of each unplaced body: the name of its pin, "" for a slider, and the bodies of the pair."""


@dataclass(frozen=True)
class GearGroup:
    """Links placed by gears, each after the link that carries its pin.

    ``pins`` names the pin of each, ``gears`` the relations, ``inverse`` is C^-1, a row for each
    link and a column for each gear.
    """

    bodies: tuple[str, ...]
    pins: tuple[str, ...]
    gears: tuple[Gear, ...]
    inverse: Rows

    @property
    def kind(self) -> str:
        """Name of the group: its gears, and its links."""
        return f"train of {len(self.gears)}"

    @property
    def known(self) -> tuple[str, ...]:
        """Known links and the ground, whose angles the relations hold."""
        every = dict.fromkeys(body for gear in self.gears for body in gear.relation)
        return tuple(body for body in every if body not in self.bodies)

    def shares(self, body: str) -> Mapping[str, Fraction]:
        """Return the part of each known link's angle in that of a link of the train."""
        row = self.inverse[self.bodies.index(body)]
        pairs = [*zip(row, self.gears, strict=True)]
        return {
            known: -sum((r * g.relation.get(known, 0) for r, g in pairs), Fraction(0))
            for known in self.known
        }

    def phase_rad(self, body: str) -> float:
        """Return the constant part of a link's angle [rad]."""
        row = self.inverse[self.bodies.index(body)]
        return sum(float(r) * g.constant_rad for r, g in zip(row, self.gears, strict=True))


def gear_group(gears: Sequence[Gear], hanging: Hanging) -> GearGroup | None:
    """Return the group of gears that can be placed next; None if there is none.

    The relations of all open gears are reduced to the angles that known ones determine; those that
    share gears are placed together.
    """
    left = [gear for gear in gears if _unknown(gear, hanging)]
    bodies = list(dict.fromkeys(body for gear in left for body in _unknown(gear, hanging)))
    rows = [
        [Fraction(gear.relation.get(body, 0)) for body in bodies]
        + [Fraction(int(one is gear)) for one in left]
        for gear in left
    ]
    shares: dict[str, dict[str, Fraction]] = {}
    for row, pivot in zip(*reduced(rows), strict=True):
        if pivot < len(bodies) and sum(map(bool, row[: len(bodies)])) == 1:
            own = zip(left, row[len(bodies) :], strict=True)
            shares[bodies[pivot]] = {gear.name: share for gear, share in own if share}
    for body, used in shares.items():
        group, names = {body}, set(used)
        while more := {b for b in shares.keys() - group if names & shares[b].keys()}:
            group |= more
            names |= {name for b in more for name in shares[b]}
        chosen = tuple(gear for gear in left if gear.name in names)
        placing = _placing([b for b in shares if b in group], hanging)
        if len(chosen) == len(group) and placing is not None:
            inverse = tuple(
                tuple(shares[b].get(gear.name, Fraction(0)) for gear in chosen) for b in placing
            )
            return GearGroup(tuple(placing), tuple(placing.values()), chosen, inverse)
    return None


def _unknown(gear: Gear, hanging: Mapping[str, object]) -> list[str]:
    return [body for body, factor in gear.relation.items() if factor and body in hanging]


def _placing(bodies: Sequence[str], hanging: Hanging) -> dict[str, str] | None:
    """Return the links in the order of placing, each with its pin; None where one does not hang on
    one pin."""
    placing: dict[str, str] = {}
    while len(placing) < len(bodies):
        unplaced = hanging.keys() - placing.keys()
        for body in bodies:
            pins = [pin for pin, on in hanging[body] if any(b not in unplaced for b in on)]
            if body not in placing and len(pins) == 1 and pins[0]:
                placing[body] = pins[0]
                break
        else:
            return None
    return placing


def reduced(rows: Sequence[Sequence[Fraction]]) -> tuple[list[list[Fraction]], list[int]]:
    """Return the reduced echelon form of rows, without those of zeros, and its pivot columns."""
    left, done, pivots = [list(row) for row in rows], list[list[Fraction]](), list[int]()
    for column in range(len(left[0]) if left else 0):
        at = next((n for n, row in enumerate(left) if row[column]), None)
        if at is None:
            continue
        pivot = left.pop(at)
        pivot = [x / pivot[column] for x in pivot]
        for row in (*done, *left):
            if factor := row[column]:
                row[:] = [x - factor * y for x, y in zip(row, pivot, strict=True)]
        done.append(pivot)
        pivots.append(column)
    return done, pivots
