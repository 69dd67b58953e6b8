"""Elastic links in scenes with all that scenes have: frames that start elsewhere, named points,
loads, springs, gravity; and the state that segments and beams of an engine's own start from."""

import math
from dataclasses import replace

import numpy as np
import pytest

from analytic.elastic.discretisation import REFERENCE, Discretisation, Polynomials, Segments
from analytic.elastic.elastic_motion import DrivenElasticMotion
from analytic.elastic.engine_start import (
    CubicNodes,
    cubic_nodes,
    node_start,
    segment_start,
    strain_places,
)
from analytic.forces.kinetostatics import forces
from models.array import Array
from models.errors import CrankcheckError
from models.files.reading import parse_scene
from models.motion import Motion, State
from models.scene import Scene
from models.scene.cut_scenes import BeamedScene, SegmentedScene
from models.scene.elastic import Shape
from models.scene.loads import PinSpring
from tests.analytic.elastic.driven import fourbar, largest, with_elastic

BEAM = Polynomials(4, 2)
POINTS = {"B": (0.0, 0.0), "C": (0.75, 0.0), "M": (0.375, 0.0), "N": (0.26, 0.1)}


def rich(turned_rad: float = 0.0, moved: tuple[float, float] = (0.0, 0.0)) -> Scene:
    """The coupler in a frame that is turned and moved against its line; the pin's spring turns that
    frame against the rocker's."""
    c, s, less = math.cos(turned_rad), math.sin(turned_rad), math.degrees(turned_rad)
    points = ", ".join(
        f"{name} = [{c * x - s * y + moved[0]!r}, {s * x + c * y + moved[1]!r}]"
        for name, (x, y) in POINTS.items()
    )
    text = f"""
name = "rich"
source = "synthetic"
gravity_m_s2 = [0.5, -9.81]
ground = {{ points = {{ A = [0.0, 0.0], D = [1.0, 0.0], S = [0.3, 1.4] }} }}
driver = {{ link = "crank", speed_rad_s = 7.3686, start_deg = 90.0 }}
branch = {{ C = 1 }}
[links]
crank = {{ bar = ["A", "B"], length_m = 0.15, mass_kg = 0.03645 }}
rocker = {{ bar = ["D", "C"], length_m = 0.75, mass_kg = 0.18225 }}
coupler = {{ points = {{ {points} }} }}
[elastic]
coupler = {{ modulus_pa = 70e9, width_m = 0.03, height_m = 0.003, density_kg_m3 = 2700.0 }}
[loads]
turn = {{ link = "rocker", torque_n_m = 0.3 }}
[loads.push]
link = "coupler"
point = "N"
direction_deg = {30.0 + less!r}
frame = "body"
force_n = 0.4
[springs]
line = {{ points = ["S", "M"], rate_n_m = 3.0, free_m = 0.5, damping_n_s_m = 0.2 }}
pin = {{ pin = "C", rate_n_m_rad = 0.4, damping_n_m_s = 0.01, free_deg = {30.0 - less!r} }}
"""
    return parse_scene(text, "rich")


ASKEW = rich(0.9, (0.4, -0.3))


def driven(
    scene: Scene, by: Discretisation = BEAM, start: Shape = "periodic", count: int = 25
) -> Motion:
    period = scene.driver.law.period_s
    motion = DrivenElasticMotion(scene, period, by, start, stiffened=True)
    return motion.at(np.linspace(0.0, period, count))


def test_the_frame_of_a_bent_link_changes_nothing_and_its_middle_goes_along() -> None:
    plain, other = driven(rich()), driven(ASKEW)
    for point, own in plain.points.items():
        assert other.points[point].position == pytest.approx(own.position, abs=1e-12)
        assert other.points[point].acceleration == pytest.approx(own.acceleration, abs=1e-8)
    middle = plain.elastic["coupler"].middle
    assert other.elastic["coupler"].middle == pytest.approx(middle, abs=1e-12)
    assert other.forces.torque == pytest.approx(plain.forces.torque, abs=1e-9)
    b, c, m = (plain.points[name].position for name in "BCM")
    way = c - b
    across = np.stack([-way[:, 1], way[:, 0]], axis=1) / np.linalg.norm(way, axis=1)[:, None]
    away = ((m - b) * across).sum(axis=1)
    assert largest(away) > 1e-3
    assert middle == pytest.approx(away, abs=1e-12)


def test_loads_and_springs_act_on_a_chain_as_on_the_beam() -> None:
    """With moments on it a chain comes to the beam with order 1."""
    true, *chains = (
        driven(ASKEW, by).elastic["coupler"].middle for by in (REFERENCE, Segments(4), Segments(8))
    )
    first, second = (largest(chain - true) / largest(true) for chain in chains)
    assert first < 0.12
    assert second < 0.5 * first


def test_a_force_in_the_frame_of_a_bent_link_turns_with_it_where_it_acts() -> None:
    scene = replace(ASKEW, springs={})
    motion = DrivenElasticMotion(scene, 1.0, Polynomials(4), "straight", stiffened=True)
    form, at = motion.form, np.zeros(1)
    z = 1e-2 * np.ones((1, form.size))
    now = form.at(at, z, 0.0 * z, form.near(at)).now
    beam, own = form.assembly.elastic["coupler"]
    force = form.forces.on(at, now)[0, own][:2]  # what it does to the place of the frame
    x = np.array([0.26 - 1e-6, 0.26 + 1e-6])
    slope = float(np.diff(beam.deflections(now.q[:, own], x)[0])[0]) / 2e-6
    assert abs(slope) > 1e-3
    angle = now.q[0, own][2] + slope + scene.loads["push"].direction_rad
    assert force == pytest.approx([0.4 * math.cos(angle), 0.4 * math.sin(angle)], abs=1e-9)


def test_a_stiff_link_has_the_reactions_of_the_rigid_one() -> None:
    flexural = 1e5 * ASKEW.elastic["coupler"].flexural_n_m2
    stiff = driven(with_elastic(ASKEW, flexural_n_m2=flexural))
    rigid = forces(ASKEW, stiff.time_s)
    assert stiff.forces.torque == pytest.approx(rigid.torque, abs=1e-6)
    for pin, each in stiff.forces.pins.items():
        for body, force in each.items():
            assert force == pytest.approx(rigid.pins[pin][body], abs=1e-5)


def test_an_engine_is_given_loads_and_springs_on_segments_of_free_names() -> None:
    scene = SegmentedScene(ASKEW, 5).rigid
    assert scene.loads["push"].body == "coupler-2"
    assert scene.loads["push"].direction_rad == pytest.approx(math.radians(30.0))
    assert scene.loads["turn"].body == "rocker"
    pin = scene.springs["pin"]
    assert isinstance(pin, PinSpring)
    assert pin.bodies == ("rocker", "coupler-5")
    assert pin.free == pytest.approx(math.radians(30.0))
    assert not scene.elastic
    assert not scene.start
    taken = {"coupler-2": replace(fourbar().links["rocker"], name="coupler-2")}
    with pytest.raises(CrankcheckError, match="the name coupler-2, which the scene has"):
        SegmentedScene(replace(fourbar(), links={**fourbar().links, **taken}), 4)


def test_a_chain_starts_with_the_rates_of_the_quasi_static_motion() -> None:
    own = SegmentedScene(fourbar(), 6)
    state = segment_start(own, "quasi-static")
    rates = {state.omega[name] for name in own.segments("coupler")}
    assert len(rates) == 6
    calm, periodic = (
        driven(fourbar(), Polynomials(3), start, 181).elastic["coupler"].middle
        for start in ("quasi-static", "periodic")
    )
    assert largest(calm - periodic) < 0.05 * largest(periodic)


COUNT = 16
BEAMED = BeamedScene(fourbar(), COUNT)


@pytest.fixture(scope="module")
def state() -> State:
    return node_start(BEAMED, "periodic")


def nodes(state: State, of: str) -> Array:
    return np.array([getattr(state, of)[name] for name in BEAMED.nodes("coupler")])


def at_nodes(state: State, of: str) -> Array:
    return np.array([getattr(state, of)[name] for name in BEAMED.bodies("coupler")])


def test_an_engines_beam_and_its_tangents_are_bent_as_in_theory(state: State) -> None:
    motion = DrivenElasticMotion(fourbar(), 1.0, REFERENCE, "periodic", stiffened=True)
    way = nodes(state, "position")
    first, last = way[0], way[-1]
    across = np.array([first[1] - last[1], last[0] - first[0]]) / np.hypot(*(last - first))
    exact = float(motion.at(np.zeros(1)).elastic["coupler"].middle[0])
    assert abs(exact) > 1e-5
    # What it stretches by, which moves the rocker.
    assert (way[COUNT // 2] - first) @ across == pytest.approx(exact, rel=1e-4)
    theta, omega, chord = at_nodes(state, "theta"), at_nodes(state, "omega"), way[2:] - way[:-2]
    apart = np.remainder(np.arctan2(chord[:, 1], chord[:, 0]) - theta[1:-1] + np.pi, 2 * np.pi)
    assert np.abs(apart - np.pi).max() < 5e-5  # of slopes of 4e-3: third derivatives
    drift = nodes(state, "velocity")
    gained = drift[2:] - drift[:-2]
    turning = (chord[:, 0] * gained[:, 1] - chord[:, 1] * gained[:, 0]) / (chord**2).sum(axis=1)
    assert turning == pytest.approx(omega[1:-1], abs=2e-3 * np.abs(omega).max())


def test_a_beam_starts_strained_by_its_axial_force_or_straight(state: State) -> None:
    """By Newton's law: what the force grows by along the link moves its mass."""
    beam, theta = BEAMED.given.beams["coupler"], at_nodes(state, "theta")
    force = beam.axial_n * at_nodes(state, "strain")
    along = np.stack([np.cos(theta), np.sin(theta)], axis=1)
    push = (nodes(state, "acceleration") * along).sum(axis=1) * beam.density_kg_m
    slope = np.gradient(force, beam.element_m)
    assert slope[1:-1] == pytest.approx(push[1:-1], abs=0.05 * np.abs(push).max())
    straight = node_start(BEAMED, "straight")
    assert max(map(abs, straight.strain.values())) < 1e-15
    assert np.ptp(at_nodes(straight, "theta")) == 0.0 < 1e-4 < np.ptp(theta)


def test_an_engines_beam_follows_where_the_frame_of_the_link_lies() -> None:
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
    assert nodes.place[0, :2] == pytest.approx((0.0, 0.0), abs=0.0)
    assert np.abs(nodes.strain - strain).max() < 1e-4
    assert nodes.strain_rate == pytest.approx(0.0, abs=1e-4)
    assert on_a_spiral(rate=0.3).strain_rate == pytest.approx(0.3, abs=1e-3)
