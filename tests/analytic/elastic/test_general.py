"""Elastic links in scenes with all that scenes have: frames that start elsewhere, named points,
loads, springs, gravity."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from analytic.elastic.discretisation import REFERENCE, Discretisation, Polynomials, Segments
from analytic.elastic.elastic_motion import DrivenElasticMotion
from analytic.elastic.segment_start import segment_start
from analytic.forces.kinetostatics import forces
from models.elastic import Shape
from models.errors import CrankcheckError
from models.files import parse_scene
from models.motion import Motion
from models.scene import Scene
from models.segmented import SegmentedScene
from models.springs import PinSpring
from tests.analytic.elastic.driven import fourbar, largest, with_elastic
from tests.worlds.tiers import slowly

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


def test_where_the_frame_of_an_elastic_link_lies_changes_nothing() -> None:
    plain, other = driven(rich()), driven(ASKEW)
    for point, own in plain.points.items():
        assert other.points[point].position == pytest.approx(own.position, abs=1e-12)
        assert other.points[point].acceleration == pytest.approx(own.acceleration, abs=1e-8)
    middle = plain.elastic["coupler"].middle
    assert other.elastic["coupler"].middle == pytest.approx(middle, abs=1e-12)
    assert other.forces.torque == pytest.approx(plain.forces.torque, abs=1e-9)


def test_a_named_point_in_the_middle_is_where_the_deflection_has_it() -> None:
    motion = driven(rich())
    b, c, m = (motion.points[name].position for name in "BCM")
    way = c - b
    across = np.stack([-way[:, 1], way[:, 0]], axis=1) / np.linalg.norm(way, axis=1)[:, None]
    away = ((m - b) * across).sum(axis=1)
    assert largest(away) > 1e-3
    assert motion.elastic["coupler"].middle == pytest.approx(away, abs=1e-12)


@pytest.mark.parametrize(
    ("counts", "most"),
    [((4, 8), 0.12), slowly((8, 24), 0.03, reason="a fourth of the limit: two seconds")],
)
def test_loads_and_springs_act_on_a_chain_as_they_do_on_the_beam(
    counts: tuple[int, int], most: float
) -> None:
    """With moments on it a chain comes to the beam with order 1."""
    true, *chains = (
        driven(ASKEW, by).elastic["coupler"].middle for by in (REFERENCE, *map(Segments, counts))
    )
    first, second = (largest(chain - true) / largest(true) for chain in chains)
    assert first < most
    assert second < first * counts[0] / counts[1]


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


def test_an_engine_is_given_loads_and_springs_on_segments() -> None:
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


@pytest.mark.parametrize("count", [3, slowly(5, reason="shapes that ring faster")])
def test_a_chain_starts_with_the_rates_of_the_quasi_static_motion(count: int) -> None:
    own = SegmentedScene(fourbar(), 6)
    state = segment_start(own, "quasi-static")
    rates = {state.omega[name] for name in own.segments("coupler")}
    assert len(rates) == 6
    calm, periodic = (
        driven(fourbar(), Polynomials(count), start, 181).elastic["coupler"].middle
        for start in ("quasi-static", "periodic")
    )
    assert largest(calm - periodic) < 0.05 * largest(periodic)


def test_a_name_that_segments_need_is_refused() -> None:
    taken = {"coupler-2": replace(fourbar().links["rocker"], name="coupler-2")}
    with pytest.raises(CrankcheckError, match="the name coupler-2, which the scene has"):
        SegmentedScene(replace(fourbar(), links={**fourbar().links, **taken}), 4)
