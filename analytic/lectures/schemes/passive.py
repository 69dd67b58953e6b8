"""Passive constraints by name: links, joints and single constraints that take no motion away.

What is named is a choice, as passive constraints come in sets of which some may be left out, no
matter which: first whole links (the last listed first), then whole joints, then single constraints,
each named by the motion that the joint might leave as well. With all of them left out the mechanism
moves the same, and the equations that are left are independent. All of it at a position next to the
drawn one, so that no momentary one is named.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from analytic.lectures.schemes.freedom_names import named_twists
from analytic.lectures.schemes.idle import Idle
from analytic.lectures.schemes.scheme_loops import IN_PLANE, Loops
from analytic.lectures.schemes.screws import rank
from models.array import Array
from models.lectures.scheme import Scheme, SchemeJoint


@dataclass(frozen=True)
class Passive:
    """What may be left out: links with their joints, joints, and of others single constraints.

    ``also`` are links each of which might be left out in place of one of ``links``.
    """

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
    """The scheme without a link, where the others move the same and passive constraints go.

    Where no loop is left the link was no spare one, but half of the mechanism."""
    scheme = loops.scheme.without_links(link)
    if len(scheme.joints) <= len(scheme.links) or scheme.loose():
        return None
    return _same_moves(loops, q, scheme, idle)


def _same_moves(loops: Loops, q: Array, fewer: Scheme, idle: int) -> tuple[Loops, Array] | None:
    """The scheme with fewer joints, where it has the same motions, without those idle ones."""
    part, at = loops.part(fewer, q)
    own, others = loops.moves(q).shape[1] - idle, part.moves(at).shape[1]
    gone = (loops.moves(q).shape[1] - loops.scheme.count) - (others - fewer.count)
    return (part, at) if own == others and gone > 0 else None


def _singles(loops: Loops, q: Array) -> Iterable[tuple[str, str]]:
    """Single constraints of joints, each named by the motion that it takes.

    A motion more in a joint is a column more: where it is none of what the others span, the loops
    still leave no motion more, so the constraint is passive.
    """
    slope = loops.closure(q)[1]
    links = loops.placed(q)
    planar = loops.scheme.dimension == 3
    rows = IN_PLANE if planar else list(range(6))
    used = 0
    spare = slope.shape[0] - rank(slope)
    for joint in loops.scheme.joints:
        if used == spare:
            return
        effect = effect_of(loops, joint)
        at = links[joint.between[0]].pose @ np.r_[loops.frame.at(joint.at), 1.0]
        for name, twist in named_twists(at[:3], planar).items():
            column = (effect @ twist[rows])[:, None]
            wider = np.hstack([slope, column])
            if used < spare and rank(wider) > rank(slope):
                slope, used = wider, used + 1
                yield joint.name, name


def effect_of(loops: Loops, joint: SchemeJoint) -> Array:
    """How a twist in a joint (the second link against the first) opens the loops: (k, 3 or 6)."""
    size = loops.scheme.dimension
    blocks = [np.zeros((0, size))]
    for closing in loops.closing:
        sign = (
            1
            if closing is joint
            else _passes(loops, joint, closing.between[0])
            - _passes(loops, joint, closing.between[1])
        )
        blocks.append(sign * np.eye(size))
    return np.vstack(blocks)


def _passes(loops: Loops, joint: SchemeJoint, link: str) -> int:
    """Whether the tree's way to a link goes through a joint: 1 forward, -1 backward, 0 not."""
    above = {placed: (by, known) for by, known, placed in loops.tree}
    while link in above:
        by, known = above[link]
        if by is joint:
            return 1 if known == by.between[0] else -1
        link = known
    return 0


def _plural(what: str, names: tuple[str, ...]) -> str:
    return f"{what}{'s' * (len(names) > 1)} {' and '.join(names)}"
