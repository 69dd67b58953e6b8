"""Scenes whose elastic links are beams of an engine's own: nodes, masses, what is refused."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from models.beamed import HARDLY, BeamedScene
from models.errors import CrankcheckError
from models.files import load_scene
from models.motion import LinkMotion, Motion, PointMotion
from models.scene import Scene


@pytest.fixture(scope="module")
def scene() -> Scene:
    return load_scene("fourbar-elastic")


def test_a_link_becomes_nodes_that_have_its_mass(scene: Scene) -> None:
    given = BeamedScene(scene, 4).given
    beam = given.beams["coupler"]
    assert not given.elastic
    assert list(given.links) == ["crank", *beam.nodes, "rocker"]
    masses = [given.links[node].mass_kg for node in beam.nodes]
    assert sum(masses) == pytest.approx(scene.links["coupler"].mass_kg)
    assert masses[1] == pytest.approx(2.0 * masses[0])
    assert given.pins["B"] == ("crank", "coupler-node-0")
    assert given.pins["C"] == ("coupler-node-4", "rocker")
    assert beam.element_m == pytest.approx(0.75 / 4)


def test_a_link_that_does_not_stretch_hardly_does(scene: Scene) -> None:
    own = scene.elastic["coupler"]
    beam = BeamedScene(scene, 4).given.beams["coupler"]
    assert beam.axial_n == pytest.approx(HARDLY * own.flexural_n_m2 / 0.75**2)
    pulled = replace(scene, elastic={"coupler": replace(own, axial_n=5e4)})
    assert BeamedScene(pulled, 4).given.beams["coupler"].axial_n == 5e4


def test_a_point_has_to_be_at_a_node(scene: Scene) -> None:
    coupler = scene.links["coupler"]
    points = {**coupler.points, "M": (0.375, 0.02)}
    marked = replace(scene, links={**scene.links, "coupler": replace(coupler, points=points)})
    carried = BeamedScene(marked, 4).given.links["coupler-node-2"].points
    assert carried["M"] == pytest.approx((0.0, 0.02))
    with pytest.raises(CrankcheckError, match=r"a point 0\.375 m .* no node of 3 elements"):
        assert BeamedScene(marked, 3).given


def test_a_beam_that_only_stretches_is_refused(scene: Scene) -> None:
    own = replace(scene.elastic["coupler"], flexural_n_m2=math.inf, axial_n=1e5)
    with pytest.raises(CrankcheckError, match="stretches and does not bend"):
        BeamedScene(replace(scene, elastic={"coupler": own}), 4)


def test_the_middle_of_an_odd_number_of_elements_is_that_of_the_curve(scene: Scene) -> None:
    """Nodes on a parabola, which a cubic through places and slopes is exactly."""
    own, high = BeamedScene(scene, 3), 1e-4
    x = np.linspace(0.0, 0.75, 4)
    y, slope = 4.0 * high * x * (0.75 - x) / 0.75**2, 4.0 * high * (0.75 - 2.0 * x) / 0.75**2
    still = np.zeros((1, 2))
    places = dict(zip(own.nodes("coupler"), np.stack([x, y], axis=1), strict=True))
    points = {name: PointMotion(place[None], still, still) for name, place in places.items()}
    points |= {name: PointMotion(still, still, still) for name in "AD"}
    angles = zip(own.bodies("coupler"), np.arctan(slope), strict=True)
    zero = np.zeros(1)
    links = {name: LinkMotion(np.array([angle]), zero, zero) for name, angle in angles}
    links |= dict.fromkeys(("crank", "rocker"), LinkMotion(zero, zero, zero))
    folded = own.folded(Motion(zero, links, points, {}))
    assert folded.elastic["coupler"].middle == pytest.approx(high, rel=1e-6)
    assert folded.elastic["coupler"].extension == pytest.approx(0.0, abs=1e-15)
