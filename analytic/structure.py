"""Structure of a mechanism: mobility, and its driver and Assur groups in solving order.

Mobility by Kutzbach-Gruebler, W = 3 n - 2 p5 - p4, with n moving bodies (links and slider blocks),
p5 pairs of one freedom (pins, prismatic pairs) and p4 pairs of two (none: a point on a line is a
block with a pin and a prismatic pair). Source: I. I. Artobolevskii, Theory of Mechanisms; the
class II groups are those with two links and three pairs.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from models.errors import StructureError
from models.joints import block_name
from models.scene import GROUND, Scene, Slider


@dataclass(frozen=True)
class Group:
    """A class II Assur group.

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
        """The pin or slider that ``Scene.branch`` names the assembly by."""
        return self.outer2 if self.kind == "RRP" else self.inner

    @property
    def assemblies(self) -> int:
        return 1 if self.kind in ("PRP", "RPP") else 2


@dataclass(frozen=True)
class Structure:
    """Bodies, pairs, mobility and groups of a scene."""

    bodies: tuple[str, ...]
    pins: Mapping[str, tuple[str, ...]]
    prismatics: Mapping[str, tuple[str, str]]
    mobility: int
    groups: tuple[Group, ...]

    @property
    def pairs(self) -> int:
        """p5: the number of pairs of one freedom."""
        return _count_pairs(self.pins, self.prismatics)


def sliding_body(slider: Slider) -> str:
    """The body that a slider is: its link, or a block of its own, with mass or without."""
    return slider.link or block_name(slider)


def analyse(scene: Scene) -> Structure:
    """Mobility and Assur groups of a scene, in solving order.

    Raises
    ------
    StructureError
        Mobility other than 1; links that hang on nothing; a group that is not a dyad (the message
        names its links); a branch for something that has one assembly only.
    """
    blocks = [block_name(s) for s in scene.sliders.values() if s.link is None]
    bodies = (*scene.links, *blocks)
    pins = _pins(scene)
    prismatics = {s.name: (sliding_body(s), s.on) for s in scene.sliders.values()}
    n, p5 = len(bodies), _count_pairs(pins, prismatics)
    mobility = 3 * n - 2 * p5
    if mobility != 1:
        raise StructureError(
            f"{scene.name}: mobility W = 3 n - 2 p5 - p4 = 3*{n} - 2*{p5} - 0 = {mobility}; one "
            f"driver needs mobility 1. {_what_to_do(mobility)}"
        )
    groups = tuple(_decompose(scene, bodies, pins, prismatics))
    _check_branches(scene, groups)
    return Structure(bodies, pins, prismatics, mobility, groups)


def _what_to_do(mobility: int) -> str:
    if mobility > 1:
        return "Pin a loose link, or remove one; bodies are pinned where they name the same point."
    return "Remove a link or a pin that holds the mechanism rigid."


def _pins(scene: Scene) -> dict[str, tuple[str, ...]]:
    """The points that join at least two bodies, slider blocks included."""
    bodies = {point: list(names) for point, names in scene.pins.items()}
    for slider in scene.sliders.values():
        if slider.link is None:
            bodies.setdefault(slider.point, []).append(block_name(slider))
    return {point: tuple(names) for point, names in bodies.items() if len(names) > 1}


def _count_pairs(
    pins: Mapping[str, tuple[str, ...]], prismatics: Mapping[str, tuple[str, str]]
) -> int:
    """A pin that joins k bodies is k - 1 pairs."""
    return sum(len(names) - 1 for names in pins.values()) + len(prismatics)


def _decompose(
    scene: Scene,
    bodies: tuple[str, ...],
    pins: Mapping[str, tuple[str, ...]],
    prismatics: Mapping[str, tuple[str, str]],
) -> Iterator[Group]:
    """The dyads in an order in which each hangs on bodies that are known before it."""
    known = {GROUND, scene.driver.link}
    left = [body for body in bodies if body not in known]
    while left:
        outer = {body: _pairs_to(known, body, pins, prismatics) for body in left}
        pairs = itertools.combinations(left, 2)
        found = (_dyad(a, b, outer, known, pins, prismatics) for a, b in pairs)
        group = next((g for g in found if g is not None), None)
        if group is None:
            raise StructureError(f"{scene.name}: {_no_closed_form(left, outer, pins, prismatics)}")
        yield group
        known |= {group.first, group.second}
        left = [body for body in left if body not in known]


def _pairs_to(
    known: set[str],
    body: str,
    pins: Mapping[str, tuple[str, ...]],
    prismatics: Mapping[str, tuple[str, str]],
) -> list[tuple[str, str]]:
    """The pairs, as (R or P, name), between a body and the known bodies."""
    found = [("R", p) for p, names in pins.items() if body in names and known & set(names)]
    for name, (a, b) in prismatics.items():
        if (a == body and b in known) or (b == body and a in known):
            found.append(("P", name))
    return found


def _dyad(
    a: str,
    b: str,
    outer: Mapping[str, list[tuple[str, str]]],
    known: set[str],
    pins: Mapping[str, tuple[str, ...]],
    prismatics: Mapping[str, tuple[str, str]],
) -> Group | None:
    """The class II group that bodies a and b form, if they do."""
    both = {a, b}
    inner = [("R", p) for p, n in pins.items() if both <= set(n) and not known & set(n)]
    inner += [("P", name) for name, ends in prismatics.items() if set(ends) == both]
    if len(outer[a]) != 1 or len(outer[b]) != 1 or len(inner) != 1:
        return None
    (ka, na), (ki, ni), (kb, nb) = outer[a][0], inner[0], outer[b][0]
    kind = ka + ki + kb
    if kind == "PPP":
        return None  # three sliders leave the angle free: not an Assur group
    if kind in ("PRR", "PPR"):
        return Group(kind[::-1], b, a, nb, ni, na)
    return Group(kind, a, b, na, ni, nb)


def _no_closed_form(
    left: list[str],
    outer: Mapping[str, list[tuple[str, str]]],
    pins: Mapping[str, tuple[str, ...]],
    prismatics: Mapping[str, tuple[str, str]],
) -> str:
    """Which links are in the way, and why."""
    for body in left:
        if len(outer[body]) > 1:
            names = ", ".join(name for _, name in outer[body])
            return (
                f"{body} is held by {len(outer[body])} pairs ({names}) to bodies that are placed "
                "before it, so it is rigid and another link is loose: mobility 1 is only a count"
            )
    for size in range(4, len(left) + 1, 2):
        for group in itertools.combinations(left, size):
            inside, outside = _pairs_of(set(group), left, pins, prismatics)
            if 3 * size == 2 * (inside + sum(len(outer[body]) for body in group)) and not outside:
                return (
                    f"links {', '.join(group)} form an Assur group of {size} links and "
                    f"{3 * size // 2} pairs (class III or higher), which has no closed form here; "
                    "dyads (RRR, RRP, RPR, PRP, RPP) have"
                )
    return f"{', '.join(left)} do not hang on the driver and the ground by dyads; check their pins"


def _pairs_of(
    group: set[str],
    left: list[str],
    pins: Mapping[str, tuple[str, ...]],
    prismatics: Mapping[str, tuple[str, str]],
) -> tuple[int, int]:
    """The pairs between members of the group, and whether it hangs on others that are left."""
    others = set(left) - group
    inside = outside = 0
    for names in pins.values():
        unknown = [name for name in names if name in group]
        if unknown and set(names) <= group | others:
            inside += len(unknown) - 1
    for a, b in prismatics.values():
        inside += {a, b} <= group
        outside += len({a, b} & group) == 1 and len({a, b} & others) == 1
    return inside, outside


def _check_branches(scene: Scene, groups: tuple[Group, ...]) -> None:
    """Refuse a branch that chooses nothing."""
    choices = [group.branch_key for group in groups if group.assemblies == 2]
    for key in scene.branch:
        if key not in choices:
            have = f"it has {', '.join(choices)}" if choices else "this scene has none"
            raise StructureError(
                f"{scene.name}: branch.{key} chooses between no two assemblies; {have}"
            )
