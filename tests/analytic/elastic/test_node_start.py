"""The state that beams of an engine's own start from is that of the beam's theory; and nodes of
cubic elements on a curve: their strain is that which is asked for."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from analytic.elastic.cubic_nodes import CubicNodes, cubic_nodes, strain_places
from analytic.elastic.discretisation import REFERENCE
from analytic.elastic.elastic_motion import DrivenElasticMotion
from analytic.elastic.node_start import node_start
from models.array import Array
from models.beamed import BeamedScene
from models.motion import State
from tests.analytic.elastic.driven import fourbar

COUNT = 16
BEAMED = BeamedScene(fourbar(), COUNT)


@pytest.fixture(scope="module")
def state() -> State:
    return node_start(BEAMED, "periodic")


def nodes(state: State, of: str) -> Array:
    return np.array([getattr(state, of)[name] for name in BEAMED.nodes("coupler")])


def at_nodes(state: State, of: str) -> Array:
    return np.array([getattr(state, of)[name] for name in BEAMED.bodies("coupler")])


def test_the_middle_is_bent_as_the_theory_has_it(state: State) -> None:
    motion = DrivenElasticMotion(fourbar(), 1.0, REFERENCE, "periodic", stiffened=True)
    way = nodes(state, "position")
    first, last = way[0], way[-1]
    across = np.array([first[1] - last[1], last[0] - first[0]]) / np.hypot(*(last - first))
    exact = float(motion.at(np.zeros(1)).elastic["coupler"].middle[0])
    assert abs(exact) > 1e-5
    # What it stretches by, which moves the rocker.
    assert (way[COUNT // 2] - first) @ across == pytest.approx(exact, rel=1e-4)


def test_tangents_are_those_of_the_curve_and_turn_as_it_does(state: State) -> None:
    way, theta, omega = nodes(state, "position"), at_nodes(state, "theta"), at_nodes(state, "omega")
    chord = way[2:] - way[:-2]
    apart = np.remainder(np.arctan2(chord[:, 1], chord[:, 0]) - theta[1:-1] + np.pi, 2 * np.pi)
    assert np.abs(apart - np.pi).max() < 5e-5  # of slopes of 4e-3: third derivatives
    drift = nodes(state, "velocity")
    gained = drift[2:] - drift[:-2]
    turning = (chord[:, 0] * gained[:, 1] - chord[:, 1] * gained[:, 0]) / (chord**2).sum(axis=1)
    assert turning == pytest.approx(omega[1:-1], abs=2e-3 * np.abs(omega).max())


def test_a_beam_starts_with_the_strain_of_its_axial_force(state: State) -> None:
    """By Newton's law: what the force grows by along the link moves its mass."""
    beam, theta = BEAMED.given.beams["coupler"], at_nodes(state, "theta")
    force = beam.axial_n * at_nodes(state, "strain")
    along = np.stack([np.cos(theta), np.sin(theta)], axis=1)
    push = (nodes(state, "acceleration") * along).sum(axis=1) * beam.density_kg_m
    slope = np.gradient(force, beam.element_m)
    assert slope[1:-1] == pytest.approx(push[1:-1], abs=0.05 * np.abs(push).max())


def test_a_straight_beam_starts_without_any(state: State) -> None:
    straight = node_start(BEAMED, "straight")
    assert max(map(abs, straight.strain.values())) < 1e-15
    assert np.ptp(at_nodes(straight, "theta")) == 0.0
    assert np.ptp(at_nodes(state, "theta")) > 1e-4


def test_it_follows_where_the_frame_of_the_link_lies() -> None:
    scene, (c, s) = fourbar(), 0.375 * np.array([np.cos(0.9), np.sin(0.9)])
    points = {"B": (0.4, -0.3), "C": (0.4 + 2.0 * c, -0.3 + 2.0 * s)}
    coupler = replace(scene.links["coupler"], points=points, centre_m=(0.4 + c, -0.3 + s))
    turned = replace(scene, links={**scene.links, "coupler": coupler})
    here, there = (node_start(BeamedScene(own, 4), "quasi-static") for own in (scene, turned))
    assert set(here.theta) == set(there.theta)
    for name, angle in here.theta.items():
        assert np.remainder(there.theta[name] - angle + np.pi, 2 * np.pi) == pytest.approx(np.pi)
    assert there.position["coupler-2-3"] == pytest.approx(here.position["coupler-2-3"], abs=1e-12)


LENGTH_M, ELEMENTS = 0.75, 8
ELEMENT_M = LENGTH_M / ELEMENTS


def on_a_spiral(strain: float = 0.0, rate: float = 0.0) -> CubicNodes:
    """On a curve whose angle grows with the square of its length, which turns as a whole and is
    longer by a strain."""
    fine = np.linspace(0.0, LENGTH_M, 80 * ELEMENTS + 1)
    steps, middle = (1.0 + strain) * np.diff(fine)[:, None], 0.5 * (fine[1:] + fine[:-1])
    turned = 0.1 * (middle / LENGTH_M) ** 2
    way = np.cumsum(steps * np.stack([np.cos(turned), np.sin(turned)], axis=1), axis=0)
    at = np.concatenate([np.zeros((1, 2)), way])[::80]
    place = np.column_stack([at, 0.1 * (fine[::80] / LENGTH_M) ** 2])
    drift = np.column_stack([-at[:, 1], at[:, 0], np.ones(len(at))])
    drift[:, :2] += rate * at / (1.0 + strain)
    wanted = np.full(strain_places(ELEMENT_M, ELEMENTS).shape, strain)
    return cubic_nodes(place, drift, wanted, np.full(wanted.shape, rate), ELEMENT_M)


def strains(places: Array, theta: Array, long: Array) -> Array:
    """Of the cubics through places and tangents, closely sampled, in each element."""
    share = np.linspace(0.0, 1.0, 101)[:, None]
    tangent = long[:, None] * np.stack([np.cos(theta), np.sin(theta)], axis=1)
    found = []
    for i in range(ELEMENTS):
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
    unit = strains(nodes.place[:, :2], nodes.place[:, 2], np.full(ELEMENTS + 1, 1.0 + strain))
    own = strains(nodes.place[:, :2], nodes.place[:, 2], 1.0 + nodes.strain)
    lean = np.linspace(-1.0, 1.0, 101)

    def pushed(each: Array) -> float:
        return abs(float((each[-1] - strain) @ lean)) / 101.0

    assert pushed(unit) > 5e-7
    assert pushed(own) < 0.4 * pushed(unit)
    assert own.mean() == pytest.approx(strain, abs=5e-9)


def test_nodes_on_a_curve_stay_with_the_rate_of_strain_that_is_wanted() -> None:
    """Which is none where all turns as a whole."""
    nodes = on_a_spiral()
    assert nodes.place[0, :2] == pytest.approx((0.0, 0.0), abs=0.0)
    assert np.abs(nodes.strain).max() < 1e-4
    assert nodes.strain_rate == pytest.approx(0.0, abs=1e-4)
    assert on_a_spiral(rate=0.3).strain_rate == pytest.approx(0.3, abs=1e-3)
