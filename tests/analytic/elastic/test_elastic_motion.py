"""Driven mechanisms with elastic links: the rigid limit, how far the reference is trusted, instants
and sizes of any kind, and the fastest of what they do."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from analytic.elastic.discretisation import (
    REFERENCE,
    Discretisation,
    Elements,
    Modes,
    Polynomials,
    Segments,
)
from analytic.elastic.elastic_motion import DrivenElasticMotion
from analytic.elastic.sampled import bent, sampled
from analytic.elastic.stiffness import fastest_rad_s
from analytic.forces.kinetostatics import forces
from analytic.kinematics import solve
from models.elastic import Shape
from models.files import load_scene, parse_scene
from models.motion import Motion
from models.scene import Scene
from tests.analytic.elastic.driven import SHIPPED, fourbar, with_elastic
from tests.worlds.tiers import few, slowly

BETWEEN = 2.0
"""By what an estimated error may fall short of the true one."""
BEST = Polynomials(10, 6)
SECONDS = "two seconds each: other shapes, whose errors are estimated in the same way"


def driven(
    scene: Scene, by: Discretisation = REFERENCE, start: Shape = "periodic", halved: int = 0
) -> DrivenElasticMotion:
    return DrivenElasticMotion(scene, scene.driver.law.period_s, by, start, True, halved)


def times(scene: Scene) -> np.ndarray:
    return np.linspace(0.0, scene.driver.law.period_s, 37)


def off(one: Motion, other: Motion) -> dict[str, float]:
    """The largest differences of two motions."""
    found = {"torque": np.abs(one.forces.torque - other.forces.torque).max()}
    for name, own in one.elastic.items():
        found[f"middle {name}"] = np.abs(own.middle - other.elastic[name].middle).max()
        found[f"extension {name}"] = np.abs(own.extension - other.elastic[name].extension).max()
    for name, link in one.links.items():
        found[f"theta {name}"] = np.abs(link.theta - other.links[name].theta).max()
    return found


@pytest.mark.parametrize(
    "name", few(SHIPPED, SHIPPED[:1], "a second and more each: by as many shapes as the first")
)
def test_the_reference_is_good_to_1e_8_of_the_deflection(name: str) -> None:
    scene = load_scene(name)
    motion, time_s = driven(scene), times(scene)
    doubt, own = motion.doubt(time_s), motion.at(time_s)
    for link, middle in doubt.middle_m.items():
        assert middle.max() < 1e-8 * np.abs(own.elastic[link].middle).max()
    assert doubt.torque_n_m.max() < 1e-8 * np.abs(own.forces.torque).max()


@pytest.mark.parametrize(
    ("by", "start", "fine"),
    [
        (Elements(1), "periodic", Polynomials(5, 3)),
        slowly(Elements(1), "periodic", BEST, reason=SECONDS),
        slowly(Polynomials(3, 1), "periodic", BEST, reason=SECONDS),
        slowly(Polynomials(4, 2), "quasi-static", BEST, reason=SECONDS),
        slowly(Modes(3, 2), "periodic", BEST, reason=SECONDS),
        slowly(Elements(2), "periodic", BEST, reason=SECONDS),
    ],
)
def test_the_estimated_error_is_not_under_the_true_one(
    by: Discretisation, start: Shape, fine: Polynomials
) -> None:
    scene = fourbar(axial_n=3e5)
    time_s = times(scene) if start == "periodic" else np.linspace(0.0, 0.2, 17)
    motion = replace(driven(scene, by, start), until_s=time_s[-1])
    best = replace(motion, by=fine, halved=3)
    true = off(motion.at(time_s), best.at(time_s))
    doubt = motion.doubt(time_s)
    assert doubt.torque_n_m.max() * BETWEEN >= true["torque"]
    assert doubt.middle_m["coupler"].max() * BETWEEN >= true["middle coupler"]
    assert doubt.extension_m["coupler"].max() * BETWEEN >= true["extension coupler"]
    for link, theta in doubt.theta_rad.items():
        assert theta.max() * BETWEEN >= true[f"theta {link}"] - 1e-15


@pytest.mark.parametrize("count", [4, slowly(6, reason="windows for stiffer segments")])
def test_of_a_chain_the_windows_alone_are_in_doubt(count: int) -> None:
    motion = replace(driven(fourbar(), Segments(count), "quasi-static"), until_s=0.2)
    doubt = motion.doubt(np.linspace(0.0, 0.2, 9))
    assert 0.0 < doubt.middle_m["coupler"].max() < 1e-8


@pytest.mark.parametrize(
    ("bends", "stiffer"),
    [
        (True, (5.0, 10.0)),
        *(
            slowly(bends, (5.0, 10.0, 20.0), reason="a link that stretches; that the ratio stays")
            for bends in (True, False)
        ),
    ],
)
def test_a_stiff_link_comes_to_the_rigid_one_as_one_over_its_modulus(
    bends: bool, stiffer: tuple[float, ...]
) -> None:
    """A link that bends turns the others in the second order only, by its shortening."""
    soft = fourbar(axial_n=float("inf") if bends else 6.3e6)
    own, time_s = soft.elastic["coupler"], times(soft)
    flexural = own.flexural_n_m2 if bends else float("inf")
    rigid, rigid_forces = solve(soft, time_s), forces(soft, time_s)
    errors = []
    for times_as in stiffer:
        axial = times_as * own.axial_n
        scene = with_elastic(soft, flexural_n_m2=times_as * flexural, axial_n=axial)
        motion = driven(scene, Polynomials(4, 2)).at(time_s)
        shape = motion.elastic["coupler"]
        turned = motion.links["rocker"].theta - rigid.links["rocker"].theta
        torque = np.abs(motion.forces.torque - rigid_forces.torque).max()
        errors.append([np.abs(shape.middle if bends else turned).max(), torque])
    ratios = np.divide(errors[:-1], errors[1:])
    assert ratios == pytest.approx(2.0, rel=5e-3)


@pytest.mark.parametrize(
    "counts", [[2, 4], slowly([2, 4, 8], reason="a second: the order with more elements")]
)
def test_elements_come_to_the_polynomials_with_order_4(counts: list[int]) -> None:
    scene = fourbar()
    time_s = times(scene)
    true = driven(scene).at(time_s)
    errors = [
        off(driven(scene, Elements(count)).at(time_s), true)["middle coupler"] for count in counts
    ]
    order = -np.polyfit(np.log(counts), np.log(errors), 1)[0]
    assert order > 3.7


@pytest.mark.parametrize(
    "counts", [[4, 8], slowly([4, 8, 16], reason="a second: the order with more segments")]
)
def test_chains_come_to_the_beam_with_order_2(counts: list[int]) -> None:
    scene = fourbar()
    time_s = times(scene)
    true = driven(scene).at(time_s)
    largest = np.abs(true.elastic["coupler"].middle).max()
    errors = [
        off(driven(scene, Segments(count)).at(time_s), true)["middle coupler"] / largest
        for count in counts
    ]
    order = -np.polyfit(np.log(counts), np.log(errors), 1)[0]
    assert order == pytest.approx(2.0, abs=0.1)
    assert errors[-1] == pytest.approx(0.8 / counts[-1] ** 2, rel=0.05)


SIMILAR = """
name = "similar"
source = "ours"
[ground]
points = {{ A = [0.0, 0.0], D = [{0}, 0.0] }}
[links]
crank = {{ bar = ["A", "B"], length_m = {1}, mass_kg = 0.4 }}
coupler = {{ bar = ["B", "C"], length_m = {2}, mass_kg = 2.4 }}
rocker = {{ bar = ["D", "C"], length_m = {3}, mass_kg = 0.5 }}
[elastic.coupler]
flexural_n_m2 = {4}
[driver]
link = "crank"
speed_rad_s = 5.0
start_deg = 200.0
[start]
shape = "periodic"
[branch]
C = 1
"""


def deflection(size: float, by: Discretisation) -> float:
    """The largest over that size, of a four-bar of 0.84 of it whose frequency is the same."""
    lengths = (0.84 * size, 0.28 * size, 0.56 * size, 0.62 * size)
    scene = parse_scene(SIMILAR.format(*lengths, 8.0 * size**3), "similar")
    motion = DrivenElasticMotion(scene, 1.0, by, "periodic", stiffened=True)
    middle = motion.at(np.linspace(0.0, scene.driver.law.period_s, 20)).elastic["coupler"].middle
    return float(np.abs(middle).max()) / size


@pytest.mark.parametrize(
    "by", few([Elements(1), Elements(2), Segments(4)], {Elements(1)}, "more slopes, and angles")
)
def test_similar_mechanisms_of_any_size_bend_alike(by: Discretisation) -> None:
    assert deflection(1e-4, by) == pytest.approx(deflection(1.0, by), rel=1e-6)


@pytest.fixture(scope="module")
def motion() -> DrivenElasticMotion:
    return DrivenElasticMotion(load_scene("fourbar-elastic"), 1.0, Modes(1), "periodic", True)


def test_some_at_a_time_and_in_any_order_it_is_the_same(
    motion: DrivenElasticMotion, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("analytic.elastic.sampled.TOGETHER", 3)
    time_s = np.array([0.7, 0.1, 0.3, 0.0, 0.9, 0.5, 0.2])
    whole, each = motion.at(time_s), sampled(motion, time_s)
    for found, wanted in (
        (each.time_s, whole.time_s),
        (each.forces.time_s, whole.forces.time_s),
        (each.links["rocker"].alpha, whole.links["rocker"].alpha),
        (each.points["C"].position, whole.points["C"].position),
        (each.elastic["coupler"].middle, whole.elastic["coupler"].middle),
        (each.forces.torque, whole.forces.torque),
    ):
        np.testing.assert_allclose(found, wanted, rtol=1e-12, atol=1e-13)


def test_the_shape_goes_through_both_pins_and_the_middle(motion: DrivenElasticMotion) -> None:
    time_s = np.array([0.1, 0.2])
    shape = bent(motion, time_s, np.linspace(0.0, 1.0, 5))["coupler"]
    assert np.max(np.abs(shape[:, [0, -1]])) < 1e-17
    np.testing.assert_allclose(shape[:, 2], motion.at(time_s).elastic["coupler"].middle, rtol=1e-12)


@pytest.mark.parametrize("damping_s", [1e-5, 1e-3])
def test_damping_of_a_stiff_chain_is_faster_than_its_vibration(damping_s: float) -> None:
    """Damping over stiffness leaves the modes what they are: each has its ratio of damping."""
    scene, by = load_scene("fourbar-elastic"), Segments(8)
    highest = fastest_rad_s(scene, by)
    links = {n: replace(link, damping_s=damping_s) for n, link in scene.elastic.items()}
    ratio = max(1.0, 0.5 * damping_s * highest)
    fastest = highest * (ratio + math.sqrt(ratio**2 - 1.0))
    assert fastest_rad_s(replace(scene, elastic=links), by) == pytest.approx(fastest, rel=1e-6)
