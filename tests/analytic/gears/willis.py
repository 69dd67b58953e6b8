"""Speeds of a gear train by Willis's formula, one elementary train after the other."""

from collections.abc import Mapping, Sequence
from fractions import Fraction

from analytic.gears.trains import ElementaryTrain, elementary_trains
from models.errors import CrankcheckError, few
from models.scene import GROUND
from models.scene.pairs import Gear


def complete(train: ElementaryTrain, speeds: Mapping[str, Fraction]) -> Mapping[str, Fraction]:
    """Return the speeds of all its bodies from two or more known ones; none from fewer."""
    v = {train.carrier: Fraction(0), **train.values}
    known = [body for body in v if body in speeds]
    pairs = ((a, b) for n, a in enumerate(known) for b in known[n + 1 :] if v[a] != v[b])
    for a, b in pairs:
        # Willis: omega = omega_c + v u, where u is the first gear's speed against the carrier.
        u = (speeds[a] - speeds[b]) / (v[a] - v[b])
        return {body: speeds[a] + (v[body] - v[a]) * u for body in v}
    return {}


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
            if more := complete(train, known):
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
