"""Number synthesis: all distinct chains of so many links with a wanted mobility.

A chain without a link whose loss would part it is a loop, to which open chains of links are added,
each between two of its links (the ear decomposition of H. Whitney, 1932). What has a rigid part can
not lose it by an addition, and is dropped at once; of isomorphic ones one is kept.

Published counts: 1, 2, 16, 230 chains of 4, 6, 8, 10 links with one freedom.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator
from functools import cache

from analytic.lectures.chains.chain import (
    Chain,
    assortments,
    has_rigid_part,
    joints_for,
    mobility_by_count,
)
from models.errors import CrankcheckError

FEWEST, MOST = 3, 10
"""Links of chains that are enumerated."""
MOST_MOBILITY = 7
WATT, STEPHENSON = "Watt", "Stephenson"


@cache
def chains(links: int, mobility: int = 1) -> tuple[Chain, ...]:
    """All distinct chains with pins of two links each, which no link parts and of which no part is
    rigid, by assortment.

    Raises CrankcheckError where no count of joints gives the mobility, and for more links than are
    enumerated.
    """
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
    """The count of joints. Raises CrankcheckError for what has no chain."""
    if not FEWEST <= links <= MOST:
        raise CrankcheckError(
            f"{links} links: chains are enumerated of {FEWEST} to {MOST} links; take so many"
        )
    if not 0 <= mobility <= MOST_MOBILITY:
        raise CrankcheckError(
            f"mobility {mobility}: chains are enumerated of mobility 0 to {MOST_MOBILITY}"
        )
    joints = joints_for(links, mobility)
    if joints is None or joints < links:
        able = [n for n in range(FEWEST, MOST + 1) if assortments(n, mobility)]
        raise CrankcheckError(
            f"no closed chain of {links} links has mobility {mobility}: W = 3 (n - 1) - 2 p asks "
            f"for {(3 * (links - 1) - mobility) / 2:g} joints; with this mobility there are chains "
            f"of {', '.join(map(str, able))} links"
        )
    return joints


def _ring(links: int) -> list[tuple[int, int]]:
    return [(k, (k + 1) % links) for k in range(links)]


def _with_an_ear(chain: Chain, most: int) -> Iterator[Chain]:
    """The chain with an open chain of new links, or one joint, between any two of its links."""
    for a, b in itertools.combinations(range(chain.links), 2):
        for new in range(most - chain.links + 1):
            if new == 0 and b in chain.neighbours[a]:
                continue
            through = [a, *range(chain.links, chain.links + new), b]
            yield Chain.of(chain.links + new, [*chain.joints, *itertools.pairwise(through)])


def _may_be(chain: Chain, links: int, mobility: int) -> bool:
    """Whether a chain may be the whole, or a part of one that is larger."""
    own = mobility_by_count(chain.links, len(chain.joints))
    return own == mobility if chain.links == links else own >= 1


def _rank(chain: Chain) -> tuple[object, ...]:
    """Chains with fewer joints in a link first; Watt's before Stephenson's."""
    large = [k for k, degree in enumerate(chain.degrees) if degree > 2]
    joined = sum(b in chain.neighbours[a] for a, b in itertools.combinations(large, 2))
    return len(chain.assortment), chain.assortment[::-1], -joined, chain.joints


def chain_names(every: Iterable[Chain]) -> list[str]:
    """What the field calls them, or their numbers."""
    return [_known_name(chain) or f"{k}" for k, chain in enumerate(every, 1)]


def _known_name(chain: Chain) -> str:
    if chain.links == len(chain.joints):
        return {3: "triangle", 4: "four-bar", 5: "five-bar"}.get(chain.links, "")
    if chain.links == 6 and chain.mobility == 1:
        ternary = [k for k, degree in enumerate(chain.degrees) if degree == 3]
        return WATT if ternary[1] in chain.neighbours[ternary[0]] else STEPHENSON
    return ""
