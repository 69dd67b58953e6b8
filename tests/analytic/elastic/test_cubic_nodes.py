"""Nodes of cubic elements on a curve: their strain is that which is asked for."""

from __future__ import annotations

import numpy as np
import pytest

from analytic.elastic.cubic_nodes import CubicNodes, cubic_nodes, strain_places
from models.array import Array

LENGTH_M, COUNT = 0.75, 8
ELEMENT_M = LENGTH_M / COUNT


def on_a_spiral(strain: float = 0.0, rate: float = 0.0) -> CubicNodes:
    """On a curve whose angle grows with the square of its length, which turns as a whole and is
    longer by a strain."""
    fine = np.linspace(0.0, LENGTH_M, 80 * COUNT + 1)
    angle = 0.1 * (fine / LENGTH_M) ** 2
    steps = (1.0 + strain) * np.diff(fine)[:, None]
    middle = 0.5 * (fine[1:] + fine[:-1])
    turned = 0.1 * (middle / LENGTH_M) ** 2
    way = np.cumsum(steps * np.stack([np.cos(turned), np.sin(turned)], axis=1), axis=0)
    at = np.concatenate([np.zeros((1, 2)), way])[::80]
    place = np.column_stack([at, angle[::80]])
    drift = np.column_stack([-at[:, 1], at[:, 0], np.ones(len(at))])
    drift[:, :2] += rate * at / (1.0 + strain)
    wanted = np.full(strain_places(ELEMENT_M, COUNT).shape, strain)
    return cubic_nodes(place, drift, wanted, np.full(wanted.shape, rate), ELEMENT_M)


def strains(places: Array, theta: Array, long: Array) -> Array:
    """Of the cubics through places and tangents, closely sampled, in each element."""
    share = np.linspace(0.0, 1.0, 101)[:, None]
    tangent = long[:, None] * np.stack([np.cos(theta), np.sin(theta)], axis=1)
    found = []
    for i in range(COUNT):
        chord = (places[i + 1] - places[i]) / ELEMENT_M
        slope = 6.0 * share * (1.0 - share) * chord
        slope = slope + (1.0 - share) * (1.0 - 3.0 * share) * tangent[i]
        slope = slope + share * (3.0 * share - 2.0) * tangent[i + 1]
        found.append(np.hypot(*slope.T) - 1.0)
    return np.array(found)


@pytest.mark.parametrize("strain", [0.0, 1e-3])
def test_the_last_element_pushes_its_pin_less(strain: float) -> None:
    """The last one, whose end no other element holds; those within push against each other."""
    nodes = on_a_spiral(strain)
    unit = strains(nodes.place[:, :2], nodes.place[:, 2], np.full(COUNT + 1, 1.0 + strain))
    own = strains(nodes.place[:, :2], nodes.place[:, 2], 1.0 + nodes.strain)
    lean = np.linspace(-1.0, 1.0, 101)

    def pushed(each: Array) -> float:
        return abs(float((each[-1] - strain) @ lean)) / 101.0

    assert pushed(unit) > 5e-7
    assert pushed(own) < 0.4 * pushed(unit)
    assert own.mean() == pytest.approx(strain, abs=5e-9)


def test_the_pins_stay_and_nodes_hardly_move() -> None:
    nodes = on_a_spiral()
    assert nodes.place[0, :2] == pytest.approx((0.0, 0.0), abs=0.0)
    assert np.abs(nodes.strain).max() < 1e-4


def test_what_turns_as_a_whole_has_no_rate_of_strain() -> None:
    assert on_a_spiral().strain_rate == pytest.approx(0.0, abs=1e-4)


def test_a_rate_of_strain_that_is_wanted_is_there() -> None:
    assert on_a_spiral(rate=0.3).strain_rate == pytest.approx(0.3, abs=1e-3)
