"""Driven mechanisms with elastic links: the rigid limit, how far the reference is trusted, instants
and sizes of any kind, laws of the driver, and the fastest of what they do."""

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
from analytic.elastic.elastic_motion import DrivenElasticMotion, bent, fastest_rad_s, sampled
from analytic.forces.kinetostatics import forces
from analytic.kinematics import solve
from models.array import Array
from models.errors import CrankcheckError
from models.files.reading import load_scene
from models.motion import Motion
from models.scene import Scene
from models.scene.elastic import Shape
from models.scene.laws import Oscillating, SpeedChange
from models.scene.moved import scaled
from tests.analytic.elastic.driven import (
    SHIPPED,
    following,
    fourbar,
    largest,
    turning,
    with_elastic,
)
from tests.worlds.tiers import few, slowly

BETWEEN = 2.0
"""By what an estimated error may fall short of the true one."""
BEST = Polynomials(10, 6)


def driven(
    scene: Scene,
    by: Discretisation = REFERENCE,
    start: Shape = "periodic",
    until_s: float | None = None,
) -> DrivenElasticMotion:
    """Followed over a period, if not otherwise said."""
    return DrivenElasticMotion(scene, until_s or scene.driver.law.period_s, by, start, True)


def times(scene: Scene) -> Array:
    return np.linspace(0.0, scene.driver.law.period_s, 37)


def middle(motion: Motion) -> Array:
    return motion.elastic["coupler"].middle


@pytest.mark.parametrize(
    "name", few(SHIPPED, SHIPPED[:1], "a second and more each: by as many shapes as the first")
)
def test_the_reference_is_good_to_1e_8_of_the_deflection(name: str) -> None:
    scene = load_scene(name)
    motion, time_s = driven(scene), times(scene)
    doubt, own = motion.doubt(time_s), motion.at(time_s)
    for link, each in doubt.middle_m.items():
        assert each.max() < 1e-8 * largest(own.elastic[link].middle)
    assert doubt.torque_n_m.max() < 1e-8 * largest(own.forces.torque)


@pytest.mark.parametrize(
    ("by", "start", "fine"),
    [
        (Elements(1), "periodic", Polynomials(5, 3)),
        slowly(Polynomials(4, 2), "quasi-static", BEST, reason="two seconds: another start"),
    ],
)
def test_the_doubt_is_not_under_the_error(
    by: Discretisation, start: Shape, fine: Polynomials
) -> None:
    scene = fourbar(axial_n=3e5)
    time_s = times(scene) if start == "periodic" else np.linspace(0.0, 0.2, 17)
    motion = driven(scene, by, start, time_s[-1])
    found, doubt = motion.at(time_s), motion.doubt(time_s)
    true = replace(motion, by=fine, halved=3).at(time_s)
    own, best = found.elastic["coupler"], true.elastic["coupler"]
    for most, error in (
        (doubt.torque_n_m, found.forces.torque - true.forces.torque),
        (doubt.middle_m["coupler"], own.middle - best.middle),
        (doubt.extension_m["coupler"], own.extension - best.extension),
    ):
        assert most.max() * BETWEEN >= largest(error)
    for link, theta in doubt.theta_rad.items():
        error = found.links[link].theta - true.links[link].theta
        assert theta.max() * BETWEEN >= largest(error) - 1e-15


def test_of_a_chain_the_windows_alone_are_in_doubt() -> None:
    motion = driven(fourbar(), Segments(4), "quasi-static", 0.2)
    doubt = motion.doubt(np.linspace(0.0, 0.2, 9))
    assert 0.0 < doubt.middle_m["coupler"].max() < 1e-8


@pytest.mark.parametrize("bends", [True, slowly(False, reason="a link that stretches")])
def test_a_stiff_link_is_rigid_but_for_one_over_its_modulus(bends: bool) -> None:
    """A link that bends turns the others in the second order only, by its shortening."""
    soft = fourbar(axial_n=float("inf") if bends else 6.3e6)
    own, time_s = soft.elastic["coupler"], times(soft)
    flexural = own.flexural_n_m2 if bends else float("inf")
    rigid, rigid_forces = solve(soft, time_s), forces(soft, time_s)
    errors = []
    for times_as in (5.0, 10.0):
        axial = times_as * own.axial_n
        scene = with_elastic(soft, flexural_n_m2=times_as * flexural, axial_n=axial)
        motion = driven(scene, Polynomials(4, 2)).at(time_s)
        turned = motion.links["rocker"].theta - rigid.links["rocker"].theta
        torque = motion.forces.torque - rigid_forces.torque
        errors.append([largest(middle(motion) if bends else turned), largest(torque)])
    assert np.divide(errors[:-1], errors[1:]) == pytest.approx(2.0, rel=5e-3)


def deflection(size: float) -> float:
    """The largest over that size, of a four-bar of so many times the lengths, whose frequency is
    the same; it bends by so much that a small one is found only where angles count as lengths."""
    flexural = size**4 * fourbar().elastic["coupler"].flexural_n_m2
    scene = with_elastic(scaled(turning(3.5), size), flexural_n_m2=flexural)
    time_s = np.linspace(0.0, scene.driver.law.period_s, 20)
    return largest(middle(driven(scene, Elements(1), until_s=1.0).at(time_s))) / size


def test_similar_mechanisms_of_any_size_bend_alike() -> None:
    assert deflection(1e-4) == pytest.approx(deflection(1.0), rel=1e-6)


@pytest.fixture(scope="module")
def motion() -> DrivenElasticMotion:
    return driven(load_scene("fourbar-elastic"), Modes(1), until_s=1.0)


def test_some_at_a_time_it_is_the_same(
    motion: DrivenElasticMotion, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("analytic.elastic.elastic_motion.TOGETHER", 3)
    time_s = np.array([0.7, 0.1, 0.3, 0.0, 0.9, 0.5, 0.2])
    whole, each = motion.at(time_s), sampled(motion, time_s)
    for found, wanted in (
        (each.forces.time_s, whole.forces.time_s),
        (each.links["rocker"].alpha, whole.links["rocker"].alpha),
        (each.points["C"].position, whole.points["C"].position),
        (middle(each), middle(whole)),
        (each.forces.torque, whole.forces.torque),
    ):
        np.testing.assert_allclose(found, wanted, rtol=1e-12, atol=1e-13)


def test_the_shape_goes_through_both_pins_and_the_middle(motion: DrivenElasticMotion) -> None:
    time_s = np.array([0.1, 0.2])
    shape = bent(motion, time_s, np.linspace(0.0, 1.0, 5))["coupler"]
    assert largest(shape[:, [0, -1]]) < 1e-17
    np.testing.assert_allclose(shape[:, 2], middle(motion.at(time_s)), rtol=1e-12)


@pytest.mark.parametrize("damping_s", [1e-5, 1e-3])
def test_damping_of_a_stiff_chain_is_faster_than_its_vibration(damping_s: float) -> None:
    """Damping over stiffness leaves the modes what they are: each has its ratio of damping."""
    scene, by = load_scene("fourbar-elastic"), Segments(8)
    highest = fastest_rad_s(scene, by)
    ratio = max(1.0, 0.5 * damping_s * highest)
    fastest = highest * (ratio + math.sqrt(ratio**2 - 1.0))
    damped = with_elastic(scene, damping_s=damping_s)
    assert fastest_rad_s(damped, by) == pytest.approx(fastest, rel=1e-6)


def test_a_smooth_law_is_followed() -> None:
    scene = following(fourbar(), SpeedChange(1.5, 3.0, 6.0, 0.1, 0.2))
    motion = driven(scene, Polynomials(4), "quasi-static", 0.4)
    time_s = np.linspace(0.0, 0.4, 21)
    bent_m = largest(middle(motion.at(time_s)))
    assert bent_m > 1e-4
    assert motion.doubt(time_s).middle_m["coupler"].max() < 1e-3 * bent_m


def test_what_oscillates_has_a_periodic_motion() -> None:
    motion = driven(following(fourbar(), Oscillating(1.5, 0.5, 9.0)), Polynomials(4))
    first, again = middle(motion.at(np.array([0.1, 0.1 + motion.until_s])))
    assert first == pytest.approx(again, abs=1e-12)


@pytest.mark.parametrize(
    ("scene", "says"),
    [
        (following(fourbar(), SpeedChange(1.5, 3.0, 6.0, 0.1, 0.0)),
         r"jumps from 3 to 6 rad/s.*rise_s"),
        (load_scene("fourbar-lecture-1"), r"no link of it is elastic"),
        (replace(fourbar(), ground={"A": (0.0, 0.0), "D": (1.35, 0.0)}), "through a change point"),
        (replace(load_scene("fourbar-by-coupler"), elastic=fourbar().elastic),
         "takes a driver that is a link pinned to the ground.*pin B of crank and coupler"),
    ],
    ids=["jump", "rigid", "change point", "inner driver"],
)  # fmt: skip
def test_what_is_not_followed_is_named(scene: Scene, says: str) -> None:
    with pytest.raises(CrankcheckError, match=says):
        _ = driven(scene, Polynomials(4), "straight", 1.0).form


def test_times_beyond_the_end_and_endless_ones_are_refused() -> None:
    for until_s, at_s, words in (
        (0.4, 0.5, r"followed up to 0\.4 s"),
        (1e4, 0.0, "50000 are the most"),
    ):
        motion = driven(fourbar(), Polynomials(4), "quasi-static", until_s)
        with pytest.raises(CrankcheckError, match=words):
            motion.at(np.array([at_s]))
    assert driven(fourbar(), Polynomials(4)).at(np.array([1e4])).elastic
