"""Two moving bodies that the driver moves against each other: one link of changing shape.

With the driven pair held still the two are one rigid link, and what is left falls into Assur groups
as it does of any mechanism: the class depends on the pair that drives.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from analytic.structure.groups import Group, JointKey, Leg, Pairs, Triad
from models.scene import Scene


@dataclass(frozen=True)
class Compound:
    """The bodies ``base`` and ``link``, as the ``name`` of one unit; ``pin`` or ``slider`` is the
    driven pair between them."""

    name: str
    base: str
    link: str
    pin: str | None
    slider: str | None

    def unit(self, body: str) -> str:
        """What stands for a body."""
        return self.name if body in (self.base, self.link) else body

    def units(self, bodies: tuple[str, ...]) -> tuple[str, ...]:
        """What stands for the bodies, each once."""
        return tuple(dict.fromkeys(self.unit(body) for body in bodies))

    def joined(self, pins: Mapping[str, tuple[str, ...]]) -> dict[str, tuple[str, ...]]:
        """The pins that are left between units."""
        units = {pin: tuple(dict.fromkeys(map(self.unit, on))) for pin, on in pins.items()}
        return {pin: names for pin, names in units.items() if len(names) > 1}

    def sliding(self, prismatics: Mapping[str, tuple[str, str]]) -> dict[str, tuple[str, str]]:
        """The prismatic pairs that are left between units."""
        units = {n: (self.unit(a), self.unit(b)) for n, (a, b) in prismatics.items()}
        return {name: ends for name, ends in units.items() if ends[0] != ends[1]}

    def pairs(
        self, pins: Mapping[str, tuple[str, ...]], prismatics: Mapping[str, tuple[str, str]]
    ) -> Pairs:
        """All that are left between units."""
        return Pairs(self.joined(pins), self.sliding(prismatics))


def compound_of(scene: Scene) -> Compound | None:
    """The compound of a scene; None where the driver moves a body against the ground."""
    driver = scene.driver
    if not driver.is_inner:
        return None
    name = f"{driver.base} + {driver.link}"  # no body has such a name
    return Compound(name, driver.base, driver.link, driver.pin, driver.slider)


def as_triad(
    group: Triad | Group, compound: Compound | None
) -> tuple[str, tuple[Leg, ...], JointKey | None]:
    """The central link of a group, its legs, and the joint by which it hangs on a known body
    itself: of a triad none, of a dyad with a compound one, and one leg."""
    if isinstance(group, Triad):
        return group.central, group.legs, None
    assert compound is not None
    inner = (group.kind[1], group.inner)
    outer1, outer2 = (group.kind[0], group.outer1), (group.kind[2], group.outer2)
    if group.first == compound.name:
        return compound.name, (Leg(group.second, outer2, inner),), outer1
    return compound.name, (Leg(group.first, outer1, inner),), outer2
