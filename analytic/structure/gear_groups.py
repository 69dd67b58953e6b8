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

import itertools
from collections.abc import Iterator, Mapping, Sequence
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


def gear_groups(gears: Sequence[Gear], hanging: Hanging) -> Iterator[GearGroup]:
    """Yield the trains that can be placed next, those of the fewest gears first."""
    open_gears = [gear for gear in gears if _unknown(gear, hanging)]
    for size in range(1, len(open_gears) + 1):
        for chosen in itertools.combinations(open_gears, size):
            bodies = list(dict.fromkeys(b for gear in chosen for b in _unknown(gear, hanging)))
            if len(bodies) != size or (placing := _placing(bodies, hanging)) is None:
                continue
            inverse = _inverse([[gear.relation.get(b, 0) for b in placing] for gear in chosen])
            if inverse is not None:
                yield GearGroup(tuple(placing), tuple(placing.values()), chosen, inverse)


def _unknown(gear: Gear, hanging: Mapping[str, object]) -> list[str]:
    return [body for body, factor in gear.relation.items() if factor and body in hanging]


def _placing(bodies: Sequence[str], hanging: Hanging) -> dict[str, str] | None:
    """Return the links in the order of placing, each with its pin; None where one does not hang on
    exactly one pin."""
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


def _inverse(rows: Sequence[Sequence[int]]) -> Rows | None:
    """Return the inverse of a square matrix, exact; None where it is singular."""
    size = len(rows)
    left = [[Fraction(one) for one in row] for row in rows]
    for k, row in enumerate(left):
        row += [Fraction(int(k == j)) for j in range(size)]
    for k in range(size):
        pivot = next((j for j in range(k, size) if left[j][k]), None)
        if pivot is None:
            return None
        left[k], left[pivot] = left[pivot], left[k]
        left[k] = [one / left[k][k] for one in left[k]]
        for j in range(size):
            if j != k and left[j][k]:
                left[j] = [a - left[j][k] * b for a, b in zip(left[j], left[k], strict=True)]
    return tuple(tuple(row[size:]) for row in left)
