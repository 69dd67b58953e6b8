r"""Assur groups and redundant links of a mechanism, in solving order.

::

      class II, order 2              class III, order 3 (a triad)

            o                            o---[leg]---o=======o---[leg]---o
        link  link                                   |central|
       o          o                                  \===o===//
                                                         [leg]
                                                           o
    two links, three pairs            four links, six pairs
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from analytic.structure.gear_groups import GearGroup, Hanging, gear_group
from models.scene import Scene
from models.scene.pairs import CamPair, Gear

JointKey = tuple[str, str]
"""Letter R or P, and the name of the pin or the slider."""


@dataclass(frozen=True)
class Group:
    """Class II Assur group.

    ``kind`` reads outer, inner, outer pair; ``first`` and ``second`` are its bodies in that order;
    ``outer1``, ``inner``, ``outer2`` name the pins (points) and prismatic pairs (sliders).
    ``assemblies`` is 2 where the branch has to be chosen, by the name ``branch_key``.
    """

    kind: str
    first: str
    second: str
    outer1: str
    inner: str
    outer2: str

    @property
    def branch_key(self) -> str:
        """Pin or slider that names the assembly in ``Scene.branch``."""
        return self.outer2 if self.kind == "RRP" else self.inner

    @property
    def assemblies(self) -> int:
        return 1 if self.kind in ("PRP", "RPP") else 2

    @property
    def bodies(self) -> tuple[str, ...]:
        """Bodies placed with it."""
        return self.first, self.second


@dataclass(frozen=True)
class Leg:
    """Link of a triad: pair ``outer`` is with a known body, ``inner`` with the central link."""

    body: str
    outer: JointKey
    inner: JointKey

    @property
    def kind(self) -> str:
        """Outer, inner pair: RR, PR (it slides on a known body), RP (on the central link), PP."""
        return self.outer[0] + self.inner[0]


@dataclass(frozen=True)
class Triad:
    """Class III Assur group of order 3: a ``central`` link on three legs."""

    central: str
    legs: tuple[Leg, Leg, Leg]

    @property
    def kind(self) -> str:
        return "-".join(leg.kind for leg in self.legs)

    @property
    def branch_key(self) -> str:
        """Link that names the assembly in ``Scene.branch``."""
        return self.central

    @property
    def bodies(self) -> tuple[str, ...]:
        """Bodies placed with it."""
        return self.central, *(leg.body for leg in self.legs)


@dataclass(frozen=True)
class Bridge:
    """Redundant link: two or more of its ``pins`` lie on bodies that are placed without it."""

    link: str
    pins: tuple[str, ...]

    @property
    def excess(self) -> int:
        """Constraints beyond those that place a rigid link."""
        return 2 * len(self.pins) - 3

    @property
    def bodies(self) -> tuple[str, ...]:
        """Bodies placed with it."""
        return (self.link,)


@dataclass(frozen=True)
class Following:
    """Follower of a cam, ``body``, on the ``joint`` to its carrier."""

    body: str
    joint: JointKey
    pair: CamPair

    kind = "follower"

    @property
    def bodies(self) -> tuple[str, ...]:
        """Bodies placed with it."""
        return (self.body,)


Part = Group | Triad | Bridge | GearGroup | Following


class Pairs:
    """Pins and prismatic pairs of a mechanism, by name and by body."""

    def __init__(
        self, pins: Mapping[str, tuple[str, ...]], prismatics: Mapping[str, tuple[str, str]]
    ) -> None:
        self._ends: dict[JointKey, tuple[str, ...]] = {("R", p): names for p, names in pins.items()}
        self._ends |= {("P", name): ends for name, ends in prismatics.items()}
        self._of: dict[str, list[JointKey]] = {}
        for pair, ends in self._ends.items():
            for body in dict.fromkeys(ends):
                self._of.setdefault(body, []).append(pair)

    def outer(self, body: str, known: set[str]) -> list[JointKey]:
        """Return the pairs between a body and the known ones."""
        return [pair for pair in self._of.get(body, ()) if not known.isdisjoint(self._ends[pair])]

    def inner(self, a: str, b: str, known: set[str]) -> list[JointKey]:
        """Return the pairs between two bodies, except pairs to known ones."""
        shared = (pair for pair in self._of[a] if b in self._ends[pair])
        return [pair for pair in shared if known.isdisjoint(self._ends[pair])]

    def partners(self, body: str, known: set[str]) -> set[str]:
        """Return the bodies that share a pair with a body, except pairs to known ones."""
        free = (self._ends[pair] for pair in self._of.get(body, ()))
        return {name for ends in free if known.isdisjoint(ends) for name in ends} - {body}

    def hanging(self, bodies: Iterable[str]) -> Hanging:
        """Return the pairs of bodies, each with all bodies that share it."""
        return {
            body: [(name if kind == "R" else "", self._ends[kind, name]) for kind, name in pairs]
            for body in bodies
            if (pairs := self._of.get(body)) is not None
        }

    def neighbours(self, body: str) -> set[str]:
        """Return the bodies that share a pair with a body."""
        return {name for pair in self._of[body] for name in self._ends[pair]} - {body}


def decompose(
    bodies: tuple[str, ...],
    known: frozenset[str],
    pairs: Pairs,
    gears: Sequence[Gear] = (),
    cams: Sequence[CamPair] = (),
) -> tuple[tuple[Part, ...], list[str]]:
    """Return the groups and redundant links, each after its supports, and the unplaced bodies.

    Trains of ``gears`` and followers of ``cams`` come first, then the smallest groups; a link
    counts as redundant only where no further group can be placed. ``known`` are the bodies placed
    by the driver and the ground.
    """
    placed = set(known)
    outer = {body: pairs.outer(body, placed) for body in bodies if body not in placed}
    order: list[Part] = []
    while (
        part := (gear_group(gears, pairs.hanging(outer)) if gears else None)
        or next(_followers(cams, outer, placed), None)
        or next(_dyads(outer, placed, pairs), None)
        or next(_triads(outer, placed, pairs), None)
        or next(_bridges(outer), None)
    ):
        order.append(part)
        placed.update(part.bodies)
        for body in part.bodies:
            del outer[body]
        for body in outer.keys() & {b for one in part.bodies for b in pairs.neighbours(one)}:
            outer[body] = pairs.outer(body, placed)
    return tuple(order), list(outer)


def _followers(
    cams: Sequence[CamPair], outer: Mapping[str, list[JointKey]], known: set[str]
) -> Iterator[Following]:
    """Yield the followers that can be placed next."""
    for pair in cams:
        body = pair.follower
        if body in outer and {pair.cam, pair.carrier} <= known and len(outer[body]) == 1:
            yield Following(body, outer[body][0], pair)


def _dyads(outer: Mapping[str, list[JointKey]], known: set[str], pairs: Pairs) -> Iterator[Group]:
    """Yield the class II groups that can be placed next, in the order of the bodies."""
    ready = {body: place for place, (body, ends) in enumerate(outer.items()) if len(ends) == 1}
    for a in ready:
        later = [b for b in pairs.partners(a, known) & ready.keys() if ready[b] > ready[a]]
        for b in sorted(later, key=ready.__getitem__):
            inner = pairs.inner(a, b, known)
            group = _dyad(a, b, outer[a][0], inner[0], outer[b][0]) if len(inner) == 1 else None
            if group is not None:
                yield group


def _dyad(a: str, b: str, outer1: JointKey, inner: JointKey, outer2: JointKey) -> Group | None:
    (ka, na), (ki, ni), (kb, nb) = outer1, inner, outer2
    kind = ka + ki + kb
    if kind == "PPP":
        return None  # three sliders leave the angle free: not an Assur group
    if kind in ("PRR", "PPR"):
        return Group(kind[::-1], b, a, nb, ni, na)
    return Group(kind, a, b, na, ni, nb)


def _triads(outer: Mapping[str, list[JointKey]], known: set[str], pairs: Pairs) -> Iterator[Triad]:
    """Yield the triads that can be placed next, in the order of their central links."""
    ready = {body: place for place, (body, ends) in enumerate(outer.items()) if len(ends) == 1}
    for central, held in outer.items():
        if held:
            continue
        # Other neighbours belong to later groups.
        beside = sorted(pairs.partners(central, known) & ready.keys(), key=ready.__getitem__)
        inner = {body: pairs.inner(central, body, known) for body in beside}
        legs = [Leg(b, outer[b][0], inner[b][0]) for b in beside if len(inner[b]) == 1]
        if len(legs) == 3 and sum(leg.kind == "PP" for leg in legs) < 2:
            yield Triad(central, (legs[0], legs[1], legs[2]))


def _bridges(outer: Mapping[str, list[JointKey]]) -> Iterator[Bridge]:
    """Yield the links that known bodies hold at two pins or more."""
    for body, held in outer.items():
        if len(held) > 1 and all(kind == "R" for kind, _ in held):
            yield Bridge(body, tuple(name for _, name in held))


@dataclass(frozen=True)
class Compound:
    """Bodies ``base`` and ``link`` as one unit ``name``; ``pin`` or ``slider`` is the driven pair
    between them.

    With the driven pair held still the two are one rigid link, and the rest falls into Assur groups
    as in any mechanism: the class depends on the pair that drives.
    """

    name: str
    base: str
    link: str
    pin: str | None
    slider: str | None

    def unit(self, body: str) -> str:
        """Return the unit of a body."""
        return self.name if body in (self.base, self.link) else body

    def units(self, bodies: tuple[str, ...]) -> tuple[str, ...]:
        """Return the units of the bodies, each once."""
        return tuple(dict.fromkeys(self.unit(body) for body in bodies))

    def joined(self, pins: Mapping[str, tuple[str, ...]]) -> dict[str, tuple[str, ...]]:
        """Return the pins between units."""
        units = {pin: tuple(dict.fromkeys(map(self.unit, on))) for pin, on in pins.items()}
        return {pin: names for pin, names in units.items() if len(names) > 1}

    def sliding(self, prismatics: Mapping[str, tuple[str, str]]) -> dict[str, tuple[str, str]]:
        """Return the prismatic pairs between units."""
        units = {n: (self.unit(a), self.unit(b)) for n, (a, b) in prismatics.items()}
        return {name: ends for name, ends in units.items() if ends[0] != ends[1]}

    def pairs(
        self, pins: Mapping[str, tuple[str, ...]], prismatics: Mapping[str, tuple[str, str]]
    ) -> Pairs:
        """Return all pairs between units."""
        return Pairs(self.joined(pins), self.sliding(prismatics))


def compound_of(scene: Scene) -> Compound | None:
    """Return the compound of a scene; None where the driver moves a body against the ground."""
    driver = scene.driver
    if not driver.is_inner:
        return None
    name = f"{driver.base} + {driver.link}"  # no body has such a name
    return Compound(name, driver.base, driver.link, driver.pin, driver.slider)


def as_triad(
    group: Triad | Group, compound: Compound | None
) -> tuple[str, tuple[Leg, ...], JointKey | None]:
    """Return the central link of a group, its legs, and its own joint to a known body: none for a
    triad; one joint and one leg for a dyad with a compound."""
    if isinstance(group, Triad):
        return group.central, group.legs, None
    assert compound is not None
    inner = (group.kind[1], group.inner)
    outer1, outer2 = (group.kind[0], group.outer1), (group.kind[2], group.outer2)
    if group.first == compound.name:
        return compound.name, (Leg(group.second, outer2, inner),), outer1
    return compound.name, (Leg(group.first, outer1, inner),), outer2
