"""Elastic links: tables `[elastic.LINK]`, and beams of an engine's own."""

import math
from dataclasses import replace

import numpy as np
import pytest

from analytic.elastic.discretisation import Modes, Polynomials, flexible_links
from models.errors import CrankcheckError
from models.files.reading import load_scene, parse_scene
from models.motion import LinkMotion, Motion, PointMotion
from models.scene import Scene
from models.scene.cut_links import line_of
from models.scene.cut_scenes import HARDLY, BeamedScene

GOOD = """
name = "good"
source = "a test"
[ground]
points = { A = [0.0, 0.0], D = [1.0, 0.0] }
[links]
crank = { bar = ["A", "B"], length_m = 0.15 }
coupler = { bar = ["B", "C"], length_m = 0.75 }
rocker = { bar = ["D", "C"], length_m = 0.75 }
[driver]
link = "crank"
speed_rad_s = 7.37
start_deg = 90.0
"""
SECTION = "[elastic.coupler]\nmodulus_pa = 70e9\nwidth_m = 0.03\nheight_m = 0.003\n"


def test_a_section_says_stiffness_and_mass() -> None:
    scene = parse_scene(GOOD + SECTION + "density_kg_m3 = 2700.0\nstretches = true\n", "test")
    own, link = scene.elastic["coupler"], scene.links["coupler"]
    assert own.flexural_n_m2 == pytest.approx(4.725)
    assert own.axial_n == pytest.approx(6.3e6)
    assert link.mass_kg == pytest.approx(0.18225)
    line = line_of(scene, "coupler")
    assert own.bending_rad_s(line.length_m, line.density_kg_m) == pytest.approx(77.37, abs=0.01)
    other = parse_scene(GOOD + "[elastic.coupler]\nflexural_n_m2 = 4.725\n", "test")
    assert other.elastic["coupler"].axial_n == math.inf


def test_modes_whose_half_waves_are_short_are_refused() -> None:
    scene = parse_scene(GOOD + SECTION, "test")
    flexible_links(scene, Modes(25))
    with pytest.raises(CrankcheckError, match="use 25 or fewer"):
        flexible_links(scene, Modes(26))
    for nothing in (Modes(0, 0), Polynomials(0, 0)):
        with pytest.raises(CrankcheckError, match=r"not describe elastic\.coupler"):
            flexible_links(scene, nothing)
    flexible_links(scene, Modes(3, 0))


@pytest.fixture(scope="module")
def scene() -> Scene:
    return load_scene("fourbar-elastic")


def test_a_link_becomes_nodes_that_have_its_mass_and_carry_its_points(scene: Scene) -> None:
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
    coupler = scene.links["coupler"]
    points = {**coupler.points, "M": (0.375, 0.02)}
    marked = replace(scene, links={**scene.links, "coupler": replace(coupler, points=points)})
    carried = BeamedScene(marked, 4).given.links["coupler-node-2"].points
    assert carried["M"] == pytest.approx((0.0, 0.02))
    with pytest.raises(CrankcheckError, match=r"a point 0\.375 m .* no node of 3 elements"):
        assert BeamedScene(marked, 3).given


def test_what_does_not_stretch_hardly_does_and_a_beam_has_to_bend(scene: Scene) -> None:
    own = scene.elastic["coupler"]
    beam = BeamedScene(scene, 4).given.beams["coupler"]
    assert beam.axial_n == pytest.approx(HARDLY * own.flexural_n_m2 / 0.75**2)
    pulled = replace(scene, elastic={"coupler": replace(own, axial_n=5e4)})
    assert BeamedScene(pulled, 4).given.beams["coupler"].axial_n == 5e4
    alone = replace(own, flexural_n_m2=math.inf, axial_n=1e5)
    with pytest.raises(CrankcheckError, match="stretches and does not bend"):
        BeamedScene(replace(scene, elastic={"coupler": alone}), 4)


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
