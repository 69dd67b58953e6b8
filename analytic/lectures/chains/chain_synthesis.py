"""Number and type synthesis: all distinct chains of so many links with a wanted mobility, and the
choices of sliders among their joints.

A chain without a link whose loss would part it is a loop, to which open chains of links are added,
each between two of its links (the ear decomposition of H. Whitney, 1932). A chain with a rigid part
can not lose it by an addition, and is dropped at once; one of each isomorphic set is kept.

Published counts: 1, 2, 16, 230 chains of 4, 6, 8, 10 links with one freedom.

A slider holds the angle of its two links, a pin some of their place. A choice is a mechanism if the
constraints are independent with its joints anywhere, and every joint moves: a loop with one pin is
none, as its three sliders hold the angle at the pin.
"""

import itertools
from collections.abc import Iterable, Iterator
from functools import cache

import numpy as np

from analytic.lectures.chains.chain import (
    Chain,
    Joint,
    assortments,
    has_rigid_part,
    joints_for,
    mobility_by_count,
)
from models.array import Array
from models.errors import CrankcheckError

FEWEST, MOST = 3, 10
"""Fewest and most links of enumerated chains."""
MOST_MOBILITY = 7
WATT, STEPHENSON = "Watt", "Stephenson"


@cache
def chains(links: int, mobility: int = 1) -> tuple[Chain, ...]:
    """Return all distinct chains with pins of two links each, without a rigid part and without a
    link whose loss would part them, by assortment. Raises CrankcheckError where no count of joints
    gives the mobility, and for more links than are enumerated."""
    joints = _joints_that_give(links, mobility)
    level = {Chain.of(n, _ring(n)).relabelled() for n in range(3, links + 1)}
    for loop in range(1, joints - links + 2):
        last = loop == joints - links + 1
        kept = (one for one in level if (one.links == links if last else True))
        level = {one for one in kept if not has_rigid_part(one) and _may_be(one, links, mobility)}
        if not last:
            level = {more.relabelled() for one in level for more in _with_an_ear(one, links)}
    return tuple(sorted(level, key=_rank))


def _joints_that_give(links: int, mobility: int) -> int:
    """Return the number of joints. Raises CrankcheckError where no chain exists."""
    if not FEWEST <= links <= MOST:
        raise CrankcheckError(
            f"{links} links: chains of {FEWEST} to {MOST} links are enumerated; use such a number"
        )
    if not 0 <= mobility <= MOST_MOBILITY:
        raise CrankcheckError(
            f"mobility {mobility}: chains of mobility 0 to {MOST_MOBILITY} are enumerated"
        )
    joints = joints_for(links, mobility)
    if joints is None or joints < links:
        able = [n for n in range(FEWEST, MOST + 1) if assortments(n, mobility)]
        raise CrankcheckError(
            f"no closed chain of {links} links has mobility {mobility}: W = 3 (n - 1) - 2 p "
            f"requires {(3 * (links - 1) - mobility) / 2:g} joints; with this mobility there "
            f"are chains of {', '.join(map(str, able))} links"
        )
    return joints


def _ring(links: int) -> list[tuple[int, int]]:
    return [(k, (k + 1) % links) for k in range(links)]


def _with_an_ear(chain: Chain, most: int) -> Iterator[Chain]:
    """Yield the chain with an open chain of new links, or a joint, between any two links."""
    for a, b in itertools.combinations(range(chain.links), 2):
        for new in range(most - chain.links + 1):
            if new == 0 and b in chain.neighbours[a]:
                continue
            through = [a, *range(chain.links, chain.links + new), b]
            yield Chain.of(chain.links + new, [*chain.joints, *itertools.pairwise(through)])


def _may_be(chain: Chain, links: int, mobility: int) -> bool:
    """True if a chain may be the whole, or a part of a larger one."""
    own = mobility_by_count(chain.links, len(chain.joints))
    return own == mobility if chain.links == links else own >= 1


def _rank(chain: Chain) -> tuple[object, ...]:
    """Rank chains with fewer joints in a link first; Watt's before Stephenson's."""
    large = [k for k, degree in enumerate(chain.degrees) if degree > 2]
    joined = sum(b in chain.neighbours[a] for a, b in itertools.combinations(large, 2))
    return len(chain.assortment), chain.assortment[::-1], -joined, chain.joints


def chain_names(every: Iterable[Chain]) -> list[str]:
    """Return the names of chains in the literature, or their numbers."""
    return [_known_name(chain) or f"{k}" for k, chain in enumerate(every, 1)]


def _known_name(chain: Chain) -> str:
    if chain.links == len(chain.joints):
        return {3: "triangle", 4: "four-bar", 5: "five-bar"}.get(chain.links, "")
    if chain.links == 6 and chain.mobility == 1:
        ternary = [k for k, degree in enumerate(chain.degrees) if degree == 3]
        return WATT if ternary[1] in chain.neighbours[ternary[0]] else STEPHENSON
    return ""


SEED = 18
RANK = 1e-9
"""Share of the largest singular value below which others are rounding."""


@cache
def types(chain: Chain, most_sliders: int) -> tuple[Chain, ...]:
    """Return all distinct chains with up to so many sliders among the joints, the fewest first."""
    kept: list[Chain] = []
    for count in range(min(most_sliders, len(chain.joints)) + 1):
        seen = set()
        for sliders in itertools.combinations(chain.joints, count):
            one = Chain.of(chain.links, chain.joints, sliders)
            form = one.labelled().form
            if form not in seen and every_joint_moves(one):
                kept.append(one)
            seen.add(form)
    return tuple(kept)


def every_joint_moves(chain: Chain) -> bool:
    """True if a chain has the mobility of the count, and every joint moves, with its joints
    anywhere: by the rank of its velocity equations at a random position."""
    draw = np.random.default_rng(SEED)
    rows = [_rows(chain, joint, draw) for joint in chain.joints]
    held = np.vstack([constraint for constraint, _ in rows])
    still = np.zeros((3, 3 * chain.links))
    still[:, :3] = np.eye(3)  # the first link is the ground
    _, values, ways = np.linalg.svd(np.vstack([still, held]))
    rank = int((values > RANK * values[0]).sum())
    motions = ways[rank:]
    if len(motions) != chain.mobility:
        return False
    return all(float(np.abs(motions @ freedom).max()) > RANK for _, freedom in rows)


def _rows(chain: Chain, joint: Joint, draw: np.random.Generator) -> tuple[Array, Array]:
    """Return the two constraints on (vx, vy, omega) of all links, (2, 3 n), and the row of the
    joint's freedom, (3 n,)."""
    a, b = (slice(3 * link, 3 * link + 3) for link in joint)
    (x, y), angle = draw.uniform(-1.0, 1.0, 2), draw.uniform(0.0, np.pi)
    places = np.array([[1.0, 0.0, -y], [0.0, 1.0, x]])  # velocity there of such a motion
    turn = np.array([0.0, 0.0, 1.0])
    along = np.array([np.cos(angle), np.sin(angle)])
    across = np.array([-np.sin(angle), np.cos(angle)])
    held = [across @ places, turn] if joint in chain.sliders else list(places)
    free = along @ places if joint in chain.sliders else turn
    constraints, freedom = np.zeros((2, 3 * chain.links)), np.zeros(3 * chain.links)
    constraints[:, a], constraints[:, b] = -np.array(held), np.array(held)
    freedom[a], freedom[b] = -free, free
    return constraints, freedom


def type_in_letters(chain: Chain) -> str:
    """Return RRRP: the joints of a loop in order, sliders last; for other chains their numbers."""
    if len(chain.joints) != chain.links:
        pins = len(chain.joints) - len(chain.sliders)
        return f"{pins}R" + (f"{len(chain.sliders)}P" if chain.sliders else "")
    ring = _around(chain)
    letters = "".join("P" if joint in chain.sliders else "R" for joint in ring)
    turned = [letters[k:] + letters[:k] for k in range(len(letters))]
    return max(turned + [one[::-1] for one in turned])


def _around(chain: Chain) -> list[Joint]:
    """Return the joints of a chain of one loop, in order."""
    order, link = [chain.joints[0]], chain.joints[0][1]
    while len(order) < len(chain.joints):
        joint = next(one for one in chain.joints_of(link) if one != order[-1])
        order.append(joint)
        link = joint[0] if joint[1] == link else joint[1]
    return order
