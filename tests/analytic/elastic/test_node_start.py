"""The state that beams of an engine's own start from is that of the beam's theory."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from analytic.elastic.discretisation import REFERENCE
from analytic.elastic.elastic_motion import DrivenElasticMotion
from analytic.elastic.node_start import node_start
from models.beamed import BeamedScene
from models.motion import State
from models.scene import Scene
from tests.analytic.elastic.driven import fourbar

COUNT = 16


@pytest.fixture(scope="module")
def state() -> State:
    return node_start(BeamedScene(fourbar(), COUNT), "periodic")


def nodes(state: State, of: str) -> np.ndarray:
    own = BeamedScene(fourbar(), COUNT)
    return np.array([getattr(state, of)[name] for name in own.nodes("coupler")])


def at_nodes(state: State, of: str) -> np.ndarray:
    own = BeamedScene(fourbar(), COUNT)
    return np.array([getattr(state, of)[name] for name in own.bodies("coupler")])


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
    own = BeamedScene(fourbar(), COUNT)
    beam = own.given.beams["coupler"]
    force = beam.axial_n * at_nodes(state, "strain")
    theta = at_nodes(state, "theta")
    along = np.stack([np.cos(theta), np.sin(theta)], axis=1)
    push = (nodes(state, "acceleration") * along).sum(axis=1) * beam.density_kg_m
    inner = slice(1, -1)
    slope = np.gradient(force, beam.element_m)[inner]
    assert slope == pytest.approx(push[inner], abs=0.05 * np.abs(push).max())


def test_a_straight_beam_starts_without_any(state: State) -> None:
    straight = node_start(BeamedScene(fourbar(), COUNT), "straight")
    assert max(map(abs, straight.strain.values())) < 1e-15
    assert np.ptp(at_nodes(straight, "theta")) == 0.0
    assert np.ptp(at_nodes(state, "theta")) > 1e-4


def test_it_follows_where_the_frame_of_the_link_lies() -> None:
    scene = fourbar()
    coupler = scene.links["coupler"]
    c, s = np.cos(0.9), np.sin(0.9)
    points = {"B": (0.4, -0.3), "C": (0.4 + 0.75 * c, -0.3 + 0.75 * s)}
    centre = (0.4 + 0.375 * c, -0.3 + 0.375 * s)
    turned: Scene = replace(
        scene, links={**scene.links, "coupler": replace(coupler, points=points, centre_m=centre)}
    )
    here, there = (node_start(BeamedScene(own, 4), "quasi-static") for own in (scene, turned))
    assert set(here.theta) == set(there.theta)
    for name, angle in here.theta.items():
        assert np.remainder(there.theta[name] - angle + np.pi, 2 * np.pi) == pytest.approx(np.pi)
    assert there.position["coupler-2-3"] == pytest.approx(here.position["coupler-2-3"], abs=1e-12)
