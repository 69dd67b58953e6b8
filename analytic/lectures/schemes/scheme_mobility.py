"""Mobility of a scheme: by count, by rank in the drawn position and next to it, with names for the
causes of the difference.

W by count is that of Kutzbach and Gruebler (Artobolevskii's and Chebyshev's form, with classes of
joints). The real mobility is the number of motions that the loops leave next to the drawn position,
except those of first order alone. Real less count are the passive constraints; idle freedoms are in
both.

A roller turns about its pin, a rod between two ball joints about the line of these: the count has
such a freedom, and no other link feels it. A link at the end of an arm, and a shaft in its bearings
alone, move others or are the output; so idle links are between two other bodies.

The named ones are a choice, as passive constraints come in sets of which any few may be left out:
first whole links (the last listed first), then whole joints, then single constraints, each named by
the motion that the joint might leave as well. Without all of them the mechanism moves the same, and
the remaining equations are independent. All is at a position next to the drawn one, so that no
momentary one is named.
"""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from analytic.lectures.schemes import screws
from analytic.lectures.schemes.scheme_loops import (
    IN_PLANE,
    DrawingFrame,
    Loops,
    Neighbourhood,
    neighbourhood,
)
from models.array import Array
from models.lectures.scheme import Scheme, SchemeJoint


@dataclass(frozen=True)
class Idle:
    """Freedom that only ``links`` have, and its motion in the drawn position."""

    links: tuple[str, ...]
    freedoms: int
    motion: str

    def __str__(self) -> str:
        return f"{' with '.join(self.links)}: {self.motion}"


def idle_freedoms(loops: Loops, q: Array) -> list[Idle]:
    """Find the idle freedoms of a scheme next to its drawn position, at ``q`` (f,)."""
    scheme = loops.scheme
    next_to = loops.joint_twists(q)
    drawn = loops.joint_twists(np.zeros(loops.freedoms))
    found: list[Idle] = []
    for links in _rows(scheme):
        if any(set(links) & set(idle.links) for idle in found):
            continue
        outer = _outer(scheme, links)
        if len({_far(joint, links) for joint in outer}) < 2:
            continue
        own = _common(next_to, outer)
        if own.shape[1]:
            words = _words(_common(drawn, outer), own.shape[1], outer, loops.frame)
            found.append(Idle(links, own.shape[1], words))
    return found


def _rows(scheme: Scheme) -> Iterator[tuple[str, ...]]:
    """Yield single links, then joined pairs of links of two joints: both may turn together."""
    yield from ((link,) for link in scheme.links)
    binary = {link for link in scheme.links if len(list(scheme.joints_of(link))) == 2}
    for joint in scheme.joints:
        if binary.issuperset(joint.between):
            yield joint.between


def _outer(scheme: Scheme, links: tuple[str, ...]) -> list[SchemeJoint]:
    return [joint for joint in scheme.joints if len(set(joint.between) & set(links)) == 1]


def _far(joint: SchemeJoint, links: tuple[str, ...]) -> str:
    first, second = joint.between
    return second if first in links else first


def _common(twists: Mapping[str, Array], joints: list[SchemeJoint]) -> Array:
    """Return the motions (6, d) that all of some joints leave."""
    return screws.kernel(np.vstack([screws.reciprocal(twists[joint.name]) for joint in joints]))


def _words(motions: Array, freedoms: int, outer: list[SchemeJoint], frame: DrawingFrame) -> str:
    """Return the motion in words, by the joints' names where its axis goes through both."""
    if freedoms > 1 or motions.shape[1] != 1:
        return f"{freedoms} freedoms of its own"
    twist = motions[:, 0]
    places = [frame.at(joint.at) for joint in outer]
    omega, v = twist[:3], twist[3:]
    stays = [np.abs(v + np.cross(omega, place)).max() < screws.DEPENDENT for place in places]
    names = [joint.name for joint in outer]
    if len(outer) == 2 and all(stays) and np.ptp(places, axis=0).max() > screws.DEPENDENT:
        return f"turns about the line through {names[0]} and {names[1]}"
    if np.abs(omega[:2]).max() < screws.DEPENDENT and any(stays):
        return f"turns about {names[stays.index(True)]}"
    return screws.axis_in_words(frame.in_drawing(twist))


@dataclass(frozen=True)
class Passive:
    """Parts that may be left out: links with their joints, joints, and other single constraints.
    ``also`` are links that might each be left out instead of one of ``links``."""

    links: tuple[str, ...] = ()
    also: tuple[str, ...] = ()
    joints: tuple[str, ...] = ()
    single: tuple[tuple[str, str], ...] = ()

    def __str__(self) -> str:
        parts = []
        if self.links:
            text = f"{_plural('link', self.links)} may be left out with all joints"
            parts.append(text + (f" (or {' or '.join(self.also)})" if self.also else ""))
        if self.joints:
            parts.append(f"{_plural('joint', self.joints)} may be left out")
        by_joint: dict[str, list[str]] = {}
        for joint, motion in self.single:
            by_joint.setdefault(joint, []).append(motion)
        parts += [
            f"joint {name} may leave {', '.join(each)} too" for name, each in by_joint.items()
        ]
        if by_joint:
            parts[-1] += (
                " (Q turn, T displacement along an axis of the drawing; one choice of several)"
            )
        return "; ".join(parts)


def passive_constraints(loops: Loops, q: Array, idle: Iterable[Idle]) -> Passive:
    """Name the passive constraints of a scheme next to its drawn position, at ``q`` (f,)."""
    whole, place = loops, q
    own = {link: each.freedoms for each in idle for link in each.links}
    links: list[str] = []
    for link in reversed(whole.scheme.links):
        without = _without_link(loops, q, link, own.get(link, 0))
        if without is not None:
            links.append(link)
            loops, q = without
    also = [
        link
        for link in whole.scheme.links
        if link not in links
        and any(whole.scheme.neighbours(link) == whole.scheme.neighbours(each) for each in links)
        and _without_link(whole, place, link, own.get(link, 0))
    ]
    joints: list[str] = []
    for joint in reversed(loops.scheme.joints):
        fewer = loops.scheme.without_joints(joint.name)
        without = None if fewer.loose() else _same_moves(loops, q, fewer, 0)
        if without is not None:
            joints.append(joint.name)
            loops, q = without
    return Passive(tuple(links), tuple(also), tuple(joints), tuple(_singles(loops, q)))


def _without_link(loops: Loops, q: Array, link: str, idle: int) -> tuple[Loops, Array] | None:
    """Return the scheme without a link, where the others move the same and passive constraints go.
    Without any loop left the link was no spare one, but half of the mechanism."""
    scheme = loops.scheme.without_links(link)
    if len(scheme.joints) <= len(scheme.links) or scheme.loose():
        return None
    return _same_moves(loops, q, scheme, idle)


def _same_moves(loops: Loops, q: Array, fewer: Scheme, idle: int) -> tuple[Loops, Array] | None:
    """Return the scheme with fewer joints, if it has the same motions, except idle ones."""
    part, at = loops.part(fewer, q)
    own, others = loops.moves(q).shape[1] - idle, part.moves(at).shape[1]
    gone = (loops.moves(q).shape[1] - loops.scheme.count) - (others - fewer.count)
    return (part, at) if own == others and gone > 0 else None


def _singles(loops: Loops, q: Array) -> Iterable[tuple[str, str]]:
    """Yield single constraints of joints, each named by the motion that it takes. A motion more in
    a joint is a column more: if it is outside the span of the others, the loops still leave no
    motion more, so the constraint is passive."""
    slope = loops.closure(q)[1]
    links = loops.placed(q)
    planar = loops.scheme.dimension == 3
    rows = IN_PLANE if planar else list(range(6))
    used = 0
    spare = slope.shape[0] - screws.rank(slope)
    for joint in loops.scheme.joints:
        if used == spare:
            return
        effect = effect_of(loops, joint)
        at = links[joint.between[0]].pose @ np.r_[loops.frame.at(joint.at), 1.0]
        for name, twist in screws.named_twists(at[:3], planar).items():
            column = (effect @ twist[rows])[:, None]
            wider = np.hstack([slope, column])
            if used < spare and screws.rank(wider) > screws.rank(slope):
                slope, used = wider, used + 1
                yield joint.name, name


def effect_of(loops: Loops, joint: SchemeJoint) -> Array:
    """Return the loops' opening by a joint's twist (second link against first): (k, 3 or 6)."""
    size = loops.scheme.dimension
    blocks = [np.zeros((0, size))]
    for closing in loops.closing:
        first, second = (_passes(loops, joint, link) for link in closing.between)
        blocks.append((1 if closing is joint else first - second) * np.eye(size))
    return np.vstack(blocks)


def _passes(loops: Loops, joint: SchemeJoint, link: str) -> int:
    """Return 1 if the tree's way to a link goes forward through a joint, -1 backward, else 0."""
    above = {placed: (by, known) for by, known, placed in loops.tree}
    while link in above:
        by, known = above[link]
        if by is joint:
            return 1 if known == by.between[0] else -1
        link = known
    return 0


def _plural(what: str, names: tuple[str, ...]) -> str:
    return f"{what}{'s' * (len(names) > 1)} {' and '.join(names)}"


NEARLY = 1e-3
"""Share of the largest restraint: a file's numbers are often given to three or four digits."""


@dataclass(frozen=True)
class SchemeMobility:
    """Number of motions of a scheme, and the reasons for its difference from the count."""

    scheme: Scheme
    near: Neighbourhood
    passive: Passive
    idle: tuple[Idle, ...]

    @property
    def real(self) -> int:
        """Number of real motions of the scheme."""
        return self.near.finite

    @property
    def rank(self) -> int:
        """Number of independent constraints next to the drawn position."""
        return self.scheme.constraints - int(self.near.moves.shape[1]) + self.scheme.count

    @property
    def spare(self) -> int:
        """Number of passive constraints, which take no motion away."""
        return self.real - self.scheme.count

    @property
    def yielding(self) -> int:
        """Number of motions of first order alone: the scheme shakes, and does not move."""
        return int(self.near.moves.shape[1]) - self.near.finite

    @property
    def margin_is_small(self) -> bool:
        """True if a motion is held by so little that rounded numbers of a file may be the cause."""
        return self.near.margin < NEARLY

    @property
    def idle_count(self) -> int:
        """Number of idle freedoms."""
        return sum(each.freedoms for each in self.idle)

    @property
    def useful(self) -> int:
        """Number of motions of other links than the idle ones."""
        return self.real - self.idle_count


def scheme_mobility(scheme: Scheme) -> SchemeMobility:
    """Count the motions of a scheme. Raises StructureError for an unconnected link."""
    loops = Loops.of(scheme)
    near = neighbourhood(loops)
    idle = tuple(idle_freedoms(loops, near.at))
    regular = near.finite == near.moves.shape[1]
    spare = regular and near.finite > scheme.count
    passive = passive_constraints(loops, near.at, idle) if spare else Passive()
    return SchemeMobility(scheme, near, passive, idle)
