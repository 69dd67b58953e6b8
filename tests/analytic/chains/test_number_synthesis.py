"""Chains, counted as published, and against graphs drawn without any theory."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from analytic.chains.chain import Chain, assortments, has_rigid_part
from analytic.chains.number_synthesis import chain_names, chains
from analytic.chains.type_synthesis import every_joint_moves
from models.errors import CrankcheckError
from tests.worlds.tiers import slow

PUBLISHED = {
    (4, 1): 1, (6, 1): 2, (8, 1): 16,
    # of two freedoms those that no link parts
    (5, 2): 1, (7, 2): 3, (9, 2): 35,
    # trusses of G. G. Baranov, from each of which Assur groups come
    (3, 0): 1, (5, 0): 1, (7, 0): 3, (9, 0): 28,
}  # fmt: skip


@pytest.mark.parametrize(("links", "mobility"), PUBLISHED)
def test_as_many_chains_are_found_as_are_published(links: int, mobility: int) -> None:
    every = chains(links, mobility)
    assert len(every) == PUBLISHED[links, mobility]
    assert {chain.mobility for chain in every} == {mobility}


@slow("long to draw: the number that is published of ten links")
def test_there_are_230_chains_of_ten_links() -> None:
    assert len(chains(10)) == 230


def test_chains_of_six_links_are_those_of_all_graphs() -> None:
    """Each graph of seven joints is looked at; isomorphic ones are told by trying every order."""
    pairs = list(itertools.combinations(range(6), 2))
    orders = [np.array(order) for order in itertools.permutations(range(6))]
    seen: set[bytes] = set()
    many = 0
    for joints in itertools.combinations(pairs, 7):
        chain = Chain.of(6, joints)
        table = _table(chain)
        if min(chain.degrees) < 2 or table.tobytes() in seen or has_rigid_part(chain):
            continue
        if _is_one(chain):  # and in every order of its links
            seen |= {table[np.ix_(order, order)].tobytes() for order in orders}
            many += 1
    assert many == len(chains(6)) == 2


def _table(chain: Chain) -> np.ndarray:
    table = np.zeros((chain.links, chain.links), dtype=np.uint8)
    for a, b in chain.joints:
        table[a, b] = table[b, a] = 1
    return table


def _is_one(chain: Chain) -> bool:
    ways = np.linalg.matrix_power(_table(chain).astype(int) + np.eye(6, dtype=int), 6)
    return bool((ways > 0).all())


def test_no_joint_of_a_chain_stands_still() -> None:
    assert all(every_joint_moves(chain) for chain in chains(8))


def test_chains_in_any_order_of_their_links_are_the_same() -> None:
    draw = np.random.default_rng(3)
    for chain in chains(8):
        order = draw.permutation(8)
        other = Chain.of(8, [(int(order[a]), int(order[b])) for a, b in chain.joints])
        assert other.relabelled() == chain


def test_a_rigid_part_is_seen() -> None:
    # a triangle, on a loop of four
    joints = [(0, 1), (1, 2), (0, 2), (2, 3), (3, 4), (4, 5), (5, 0)]
    assert has_rigid_part(Chain.of(6, joints))


def test_assortments_of_eight_links() -> None:
    assert assortments(8, 1) == [(4, 4), (5, 2, 1), (6, 0, 2)]
    many = [sum(chain.assortment == one for chain in chains(8)) for one in assortments(8, 1)]
    assert many == [9, 5, 2]


def test_six_bars_have_names() -> None:
    assert chain_names(chains(6)) == ["Watt", "Stephenson"]


@pytest.mark.parametrize(
    ("links", "mobility", "message"),
    [(7, 1, "4, 6, 8, 10 links"), (12, 1, "3 to 10"), (6, -1, "0 to 7")],
)
def test_what_has_no_chain_is_refused(links: int, mobility: int, message: str) -> None:
    with pytest.raises(CrankcheckError, match=message):
        chains(links, mobility)
