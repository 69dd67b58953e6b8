"""Chains, counted as published and against graphs drawn without any theory; their inversions."""

import itertools

import numpy as np
import pytest

from analytic.lectures.chains.assur_groups import Mechanism, assur_groups, inversions
from analytic.lectures.chains.chain import Chain, assortments
from analytic.lectures.chains.chain_synthesis import (
    chain_names,
    chains,
    every_joint_moves,
    type_in_letters,
    types,
)
from analytic.lectures.chains.layout import layout
from models.errors import CrankcheckError
from tests.worlds.tiers import few

PUBLISHED = {
    (4, 1): 1, (6, 1): 2, (8, 1): 16, (10, 1): 230,
    # of two freedoms those that no link parts
    (5, 2): 1, (7, 2): 3, (9, 2): 35,
    # trusses of G. G. Baranov, from each of which Assur groups come
    (3, 0): 1, (5, 0): 1, (7, 0): 3, (9, 0): 28,
}  # fmt: skip


@pytest.mark.parametrize("sizes", few(PUBLISHED, {*PUBLISHED} - {(10, 1)}, "long to draw"), ids=str)
def test_as_many_chains_are_found_as_are_published(sizes: tuple[int, int]) -> None:
    """By links and mobility."""
    every = chains(*sizes)
    assert len(every) == PUBLISHED[sizes]
    assert {chain.mobility for chain in every} == {sizes[1]}


def test_chains_of_eight_links_are_the_same_in_any_order_and_of_three_assortments() -> None:
    draw = np.random.default_rng(3)
    for chain in chains(8):
        order = draw.permutation(8)
        other = Chain.of(8, [(int(order[a]), int(order[b])) for a, b in chain.joints])
        assert other.relabelled() == chain
    assert assortments(8, 1) == [(4, 4), (5, 2, 1), (6, 0, 2)]
    many = [sum(chain.assortment == one for chain in chains(8)) for one in assortments(8, 1)]
    assert many == [9, 5, 2]


@pytest.mark.parametrize(("links", "mobility", "says"), [
    (7, 1, "4, 6, 8, 10 links"), (12, 1, "3 to 10"), (6, -1, "0 to 7"),
])  # fmt: skip
def test_what_has_no_chain_is_refused(links: int, mobility: int, says: str) -> None:
    with pytest.raises(CrankcheckError, match=says):
        chains(links, mobility)


def mechanisms(links: int) -> list[Mechanism]:
    every = chains(links)
    pairs = zip(every, chain_names(every), strict=True)
    return [one for chain, name in pairs for one in inversions(chain, name)]


def test_six_bars_have_the_classes_of_the_textbooks() -> None:
    six = {one.name: one for one in mechanisms(6)}
    assert {name: sorted(one.classes().values()) for name, one in six.items()} == {
        "Watt I": [2, 2],
        "Watt II": [2, 2],
        "Stephenson I": [2],
        "Stephenson II": [3, 4],
        "Stephenson III": [2, 3],
    }
    third = six["Stephenson III"]
    assert third.chain.degrees[third.ground] == 3
    second = six["Stephenson II"]
    groups = [assur_groups(second.chain, second.ground, driver) for driver in second.drivers()]
    assert {(one.class_number, one.order) for each in groups for one in each} == {(3, 3), (4, 2)}


def test_all_eight_bars_are_found_and_their_groups_have_no_freedom() -> None:
    every = mechanisms(8)
    assert len(every) == 71  # as published
    for one in every:
        for driver in one.drivers():
            groups = assur_groups(one.chain, one.ground, driver)
            assert sum(len(group.links) for group in groups) == 6
            for group in groups:
                assert 3 * len(group.links) == 2 * (len(group.inner) + group.order)


def test_four_bars_with_sliders_and_which_of_their_pins_turn() -> None:
    found = {type_in_letters(one): len(inversions(one, "")) for one in types(chains(4)[0], 4)}
    assert found == {"RRRR": 1, "RRRP": 2, "RRPP": 3, "RPRP": 1}
    # A pin among three sliders does not turn.
    assert all(every_joint_moves(chain) for chain in chains(8))
    ring = [(0, 1), (1, 2), (2, 3), (0, 3)]
    assert every_joint_moves(Chain.of(4, ring, ring[:2]))
    assert not every_joint_moves(Chain.of(4, ring, ring[:3]))


DRAWN = [*chains(4), *chains(6), *chains(8)]


@pytest.mark.parametrize("chain", few(DRAWN, DRAWN[2:4], "seventeen more, drawn as the few are"))
def test_no_bar_crosses_another(chain: Chain) -> None:
    drawn = layout(chain)
    assert drawn.crossings == 0
    apart = [np.hypot(*(a - b)) for a, b in itertools.combinations(drawn.at, 2)]
    assert min(apart) > 0.25
