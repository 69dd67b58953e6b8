"""Inversions, types and classes of chains."""

from __future__ import annotations

import pytest

from analytic.chains.chain import Chain
from analytic.chains.inversions import Mechanism, assur_groups, inversions
from analytic.chains.number_synthesis import chain_names, chains
from analytic.chains.type_synthesis import every_joint_moves, type_in_letters, types


def mechanisms(links: int) -> list[Mechanism]:
    every = chains(links)
    return [
        mechanism
        for name, chain in zip(chain_names(every), every, strict=True)
        for mechanism in inversions(chain, name)
    ]


@pytest.mark.parametrize(("links", "many"), [(4, 1), (6, 5), (8, 71)])
def test_as_many_mechanisms_are_found_as_are_published(links: int, many: int) -> None:
    assert len(mechanisms(links)) == many


def test_six_bars_have_the_classes_of_the_textbooks() -> None:
    classes = {one.name: sorted(one.classes().values()) for one in mechanisms(6)}
    assert classes == {
        "Watt I": [2, 2],
        "Watt II": [2, 2],
        "Stephenson I": [2],
        "Stephenson II": [3, 4],
        "Stephenson III": [2, 3],
    }


def test_stephenson_three_has_the_ternary_link_at_the_ground() -> None:
    third = next(one for one in mechanisms(6) if one.name == "Stephenson III")
    assert third.chain.degrees[third.ground] == 3


def test_class_and_order_of_the_groups_of_a_six_bar() -> None:
    second = next(one for one in mechanisms(6) if one.name == "Stephenson II")
    found = {
        (group.class_number, group.order)
        for driver in second.drivers()
        for group in assur_groups(second.chain, second.ground, driver)
    }
    assert found == {(3, 3), (4, 2)}


def test_groups_of_all_eight_bars_have_no_freedom() -> None:
    for one in mechanisms(8):
        for driver in one.drivers():
            groups = assur_groups(one.chain, one.ground, driver)
            assert sum(len(group.links) for group in groups) == 6
            for group in groups:
                assert 3 * len(group.links) == 2 * (len(group.inner) + group.order)


def test_four_bars_with_sliders() -> None:
    found = {type_in_letters(one): len(inversions(one, "")) for one in types(chains(4)[0], 4)}
    assert found == {"RRRR": 1, "RRRP": 2, "RRPP": 3, "RPRP": 1}


def test_a_pin_among_three_sliders_does_not_turn() -> None:
    ring = [(0, 1), (1, 2), (2, 3), (0, 3)]
    assert every_joint_moves(Chain.of(4, ring, ring[:2]))
    assert not every_joint_moves(Chain.of(4, ring, ring[:3]))
