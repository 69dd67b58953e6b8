"""Speeds of a gear train by Willis's formula, from one elementary train to the next.

An elementary train is the gears that mesh with each other on one carrier. Seen from the carrier its
centres stand still, and gear a over gear b turns by the product of teeth along the way between
them, each external mesh reversing it:

    (omega_a - omega_c)/(omega_b - omega_c) = i,    i = prod (-+ z/z')

Two speeds of an elementary train give all others. Source: Shigley, Mechanical Engineering Design,
13-13 (train value e).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction

from models.errors import CrankcheckError, few
from models.scene import GROUND
from models.scene.pairs import Gear


@dataclass(frozen=True)
class ElementaryTrain:
    """Gears that mesh on one ``carrier``; ``values``, by gear, are their speeds against it over
    that of the first, and ``gears`` the names of the pairs."""

    carrier: str
    values: Mapping[str, Fraction]
    gears: tuple[str, ...]

    def value(self, body: str, other: str) -> Fraction:
        """Return the basic ratio of two of its gears: i above, the carrier at rest."""
        return self.values[body] / self.values[other]

    def complete(self, speeds: Mapping[str, Fraction]) -> Mapping[str, Fraction]:
        """Return the speeds of all its bodies from two or more known ones; none from fewer."""
        v = {self.carrier: Fraction(0), **self.values}
        known = [body for body in v if body in speeds]
        pairs = ((a, b) for n, a in enumerate(known) for b in known[n + 1 :] if v[a] != v[b])
        for a, b in pairs:
            # Willis: omega = omega_c + v u, where u is the first gear's speed against the carrier.
            u = (speeds[a] - speeds[b]) / (v[a] - v[b])
            return {body: speeds[a] + (v[body] - v[a]) * u for body in v}
        return {}


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


def speeds(gears: Sequence[Gear], inputs: Mapping[str, Fraction]) -> dict[str, Fraction]:
    """Return the speeds of all bodies of simple, compound and planetary trains, one elementary
    train after the other [as the inputs].

    Raises CrankcheckError where no elementary train has two known speeds: coupled planetary trains,
    whose formulas have to be solved together (`analytic.gears.trains` does), or too few inputs.
    """
    known = {GROUND: Fraction(0), **inputs}
    left = elementary_trains(gears)
    while left:
        for train in left:
            if more := train.complete(known):
                known |= more
                left.remove(train)
                break
        else:
            missing = {body for train in left for body in train.values} - known.keys()
            raise CrankcheckError(
                f"Willis's formula, one train after the other: no elementary train with two known "
                f"speeds is left, and {few(sorted(missing), 12)} are open; coupled trains have "
                "their relations solved together"
            )
    return known
