"""Type synthesis: the chains that a chain of pins gives with sliders in place of some of them.

A slider holds the angle of its two links, a pin some of their place. A choice is a mechanism where
the constraints are independent with its joints anywhere, and every joint moves: so a loop with one
pin is none, as its three sliders hold the angle at the pin.
"""

from __future__ import annotations

import itertools
from functools import cache

import numpy as np

from analytic.lectures.chains.chain import Chain, Joint
from models.array import Array

SEED = 18
RANK = 1e-9
"""Singular values below this share of the largest are rounding."""


@cache
def types(chain: Chain, most_sliders: int) -> tuple[Chain, ...]:
    """All distinct chains with up to so many of the joints sliders, those with fewer first."""
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
    """Whether a chain has the mobility of the count, and no joint that stands still, where its
    joints are anywhere: by the rank of its velocity equations at a place drawn by lot."""
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
    """The two constraints on (vx, vy, omega) of all links, (2, 3 n), and what its freedom is of
    them, (3 n,)."""
    a, b = (slice(3 * link, 3 * link + 3) for link in joint)
    (x, y), angle = draw.uniform(-1.0, 1.0, 2), draw.uniform(0.0, np.pi)
    places = np.array([[1.0, 0.0, -y], [0.0, 1.0, x]])  # velocity there of what moves so
    turn = np.array([0.0, 0.0, 1.0])
    along, across = (
        np.array([np.cos(angle), np.sin(angle)]),
        np.array([-np.sin(angle), np.cos(angle)]),
    )
    held = [across @ places, turn] if joint in chain.sliders else list(places)
    free = along @ places if joint in chain.sliders else turn
    constraints, freedom = np.zeros((2, 3 * chain.links)), np.zeros(3 * chain.links)
    constraints[:, a], constraints[:, b] = -np.array(held), np.array(held)
    freedom[a], freedom[b] = -free, free
    return constraints, freedom


def type_in_letters(chain: Chain) -> str:
    """RRRP: the joints of a loop in order, the sliders last; of other chains how many there are."""
    if len(chain.joints) != chain.links:
        pins = len(chain.joints) - len(chain.sliders)
        return f"{pins}R" + (f"{len(chain.sliders)}P" if chain.sliders else "")
    ring = _around(chain)
    letters = "".join("P" if joint in chain.sliders else "R" for joint in ring)
    turned = [letters[k:] + letters[:k] for k in range(len(letters))]
    return max(turned + [one[::-1] for one in turned])


def _around(chain: Chain) -> list[Joint]:
    """The joints of a chain that is one loop, in order."""
    order, link = [chain.joints[0]], chain.joints[0][1]
    while len(order) < len(chain.joints):
        joint = next(one for one in chain.joints_of(link) if one != order[-1])
        order.append(joint)
        link = joint[0] if joint[1] == link else joint[1]
    return order
