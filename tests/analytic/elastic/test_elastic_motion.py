"""Driven mechanisms with elastic links: the rigid limit, how far the reference is trusted, instants
and sizes of any kind, laws of the driver; and their integration: against a library's method, by its
energy, beside the equations with every coordinate kept, and by nodes that are exact as they say.
"""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp  # type: ignore[import-untyped]

from analytic.elastic.discretisation import (
    REFERENCE,
    Discretisation,
    Elements,
    Modes,
    Polynomials,
    Segments,
)
from analytic.elastic.elastic_motion import DrivenElasticMotion, bent, fastest_rad_s, sampled
from analytic.elastic.free_windows import radau
from analytic.elastic.reduced import ReducedForm
from analytic.elastic.vibration import vibrate
from analytic.forces.kinetostatics import forces
from analytic.free.window import gauss
from analytic.kinematics import solve
from models.array import Array
from models.errors import CrankcheckError
from models.files.reading import load_scene
from models.motion import Motion
from models.scene import Scene
from models.scene.elastic import Shape
from models.scene.laws import FromRest, Oscillating, SpeedChange
from models.scene.moved import scaled
from tests.analytic.elastic.driven import (
    apart,
    following,
    form_of,
    fourbar,
    largest,
    turning,
    with_elastic,
)
from tests.second_opinions.driven_multipliers import DrivenMultipliers
from tests.worlds.tiers import slowly

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
    "name", ["fourbar-elastic", slowly("sixbar-elastic", reason="two seconds")]
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


def test_similar_mechanisms_of_any_size_bend_alike() -> None:
    """Of one frequency; they bend by so much that the small one's deflection is found only where
    angles count as lengths."""
    found = []
    for size in (1e-4, 1.0):
        flexural = size**4 * fourbar().elastic["coupler"].flexural_n_m2
        scene = with_elastic(scaled(turning(3.5), size), flexural_n_m2=flexural)
        time_s = np.linspace(0.0, scene.driver.law.period_s, 20)
        found.append(largest(middle(driven(scene, Elements(1), until_s=1.0).at(time_s))) / size)
    assert found[0] == pytest.approx(found[1], rel=1e-6)


def test_some_at_a_time_the_motion_and_shape_are_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    motion = driven(load_scene("fourbar-elastic"), Modes(1), until_s=1.0)
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
    at_s = np.array([0.1, 0.2])
    shape = bent(motion, at_s, np.linspace(0.0, 1.0, 5))["coupler"]
    assert largest(shape[:, [0, -1]]) < 1e-17
    np.testing.assert_allclose(shape[:, 2], middle(motion.at(at_s)), rtol=1e-12)


@pytest.mark.parametrize("damping_s", [1e-5, 1e-3])
def test_damping_of_a_stiff_chain_is_faster_than_its_vibration(damping_s: float) -> None:
    """Damping over stiffness leaves the modes what they are: each has its ratio of damping."""
    scene, by = load_scene("fourbar-elastic"), Segments(8)
    highest = fastest_rad_s(scene, by)
    ratio = max(1.0, 0.5 * damping_s * highest)
    fastest = highest * (ratio + math.sqrt(ratio**2 - 1.0))
    damped = with_elastic(scene, damping_s=damping_s)
    assert fastest_rad_s(damped, by) == pytest.approx(fastest, rel=1e-6)


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
         "needs a driver that is a link pinned to the ground.*pin B of crank and coupler"),
    ],
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


def followed(scene: Scene, until_s: float, by: Discretisation) -> DrivenElasticMotion:
    return DrivenElasticMotion(scene, until_s, by, "quasi-static", stiffened=True)


def by_a_library(form: ReducedForm, until_s: float) -> np.ndarray:
    """The coefficients and rates at the end, from a straight start."""
    m = form.size

    def slope(time_s: float, state: np.ndarray) -> np.ndarray:
        at = np.array([time_s])
        now = form.at(at, state[None, :m], state[None, m:], form.near(at))
        return np.concatenate([state[m:], now.seconds[0]])

    run = solve_ivp(slope, (0.0, until_s), np.zeros(2 * m), method="DOP853", rtol=1e-9, atol=1e-12)
    return np.asarray(run.y[:, -1])


def test_a_straight_start_rings_as_by_a_library() -> None:
    form, until = form_of(fourbar(damping_s=1e-3), Polynomials(2)), 0.015
    expected = by_a_library(form, until)
    still = np.zeros(form.size)
    history = vibrate(form, still, still, until, 6)
    z, rates, _ = (own[0] for own in history.at(np.array([until])))
    assert z == pytest.approx(expected[: form.size], abs=1e-7 * np.abs(z).max())
    assert rates == pytest.approx(expected[form.size :], abs=1e-7 * np.abs(rates).max())


def test_windows_end_at_kinks_with_smooth_motion_in_between_and_are_halved_if_too_long() -> None:
    scene = following(fourbar(), FromRest(fourbar().driver.law.offset_rad, 8.0, 0.21))
    motion = DrivenElasticMotion(scene, 0.4, Polynomials(5), "straight", stiffened=True)
    assert 0.21 in motion.history.edges_s
    assert len(motion.history.edges_s) >= 11
    time_s = np.linspace(0.0, 0.4, 41)
    largest = np.abs(motion.at(time_s).elastic["coupler"].middle).max()
    assert motion.doubt(time_s).middle_m["coupler"].max() < 1e-5 * largest
    form = form_of(turning(1.3), Modes(1, 0))
    still = np.zeros(form.size)
    long, short = (vibrate(form, still, still, form.period_s, count) for count in (2, 30))
    middle = np.array([0.5 * form.period_s])
    assert len(long.edges_s) > 3
    assert long.at(middle)[0][0, 0] == pytest.approx(short.at(middle)[0][0, 0], rel=1e-3)


@pytest.mark.parametrize(
    ("scene", "start"),
    [
        slowly(
            fourbar(axial_n=3e4, damping_s=2e-4), "straight", reason="0.4 s: from another start"
        ),
        (with_elastic(load_scene("slider-crank-elastic"), damping_s=1e-3), "periodic"),
    ],
)
def test_the_drive_gives_what_energy_and_damping_take(scene: Scene, start: Shape) -> None:
    until = 0.3
    motion = DrivenElasticMotion(scene, until, Polynomials(3, 1), start, True, halved=2)
    rule, edges = gauss(10), np.linspace(0.0, until, 129)
    span = edges[1] - edges[0]
    time_s = (edges[:-1, None] + span * rule.places).ravel()
    form = motion.form

    def energy(at: float) -> float:
        now, _ = motion.instant(np.array([at]))
        q, rates = now.now.q, now.now.rates
        kinetic = 0.5 * rates[0] @ form.assembly.mass(q)[0] @ rates[0]
        return float(kinetic + form.assembly.height_energy(q)[0])

    now, seconds = motion.instant(time_s)
    _, torque = form.reactions(time_s, now, seconds)
    lost = sum(body.lost(now.now.rates[:, own]) for body, own in form.assembly.elastic.values())
    power = torque * form.law.at(time_s)[1] - lost
    given = span * np.sum(power.reshape(-1, 10) @ rule.end_once)
    flow = span * np.sum(np.abs(power).reshape(-1, 10) @ rule.end_once)
    assert energy(until) - energy(0.0) == pytest.approx(given, abs=1e-9 * flow)


def test_what_bends_too_far_is_refused_and_what_hardly_does_takes_few_windows() -> None:
    motion = followed(with_elastic(fourbar(), flexural_n_m2=1e-2), 0.1, Polynomials(3))
    with pytest.raises(CrankcheckError, match=r"coupler bends by 0\.\d+ of its length.*stiffer"):
        motion.at(np.linspace(0.0, 0.1, 5))
    motion = followed(with_elastic(fourbar(), flexural_n_m2=1e12), 0.01, Polynomials(3))
    middle = motion.at(np.linspace(0.0, 0.01, 5)).elastic["coupler"].middle
    assert 0.0 < np.abs(middle).max() < 1e-13
    assert len(motion.history.z) < 30


@pytest.mark.parametrize("turns", [0.1, slowly(2.0, reason="errors that grow with the turns")])
def test_it_agrees_with_the_equations_of_every_coordinate(turns: float) -> None:
    """With weight and damping, from one state."""
    scene = replace(fourbar(damping_s=1e-4), gravity_m_s2=(0.0, -9.81))
    until_s = turns * scene.driver.law.period_s
    driven, time_s = followed(scene, until_s, Modes(1)), np.linspace(0.0, until_s, 11)
    start = driven.first.now.q[0], driven.first.now.rates[0]
    kept = DrivenMultipliers(driven.form.assembly, start, until_s)
    assert apart(driven.at(time_s), kept.at(time_s), "coupler") < 1e-8


@pytest.mark.parametrize("count", [2, 3, 10])
def test_radaus_nodes_are_exact_for_polynomials_and_end_what_is_stiff(count: int) -> None:
    rule = radau(count)
    assert rule.places[-1] == 1.0
    for power in range(2 * count - 1):
        assert rule.end_once @ rule.places**power == pytest.approx(1.0 / (power + 1), rel=1e-12)
    for power in range(count):
        whole = rule.places ** (power + 1) / (power + 1)
        once, twice = (by @ rule.places**power for by in (rule.once, rule.twice))
        np.testing.assert_allclose(once, whole, atol=1e-13)
        np.testing.assert_allclose(twice, whole * rule.places / (power + 2), atol=1e-13)
    # u' = -z u: the end of a step of 1 goes to 0 with 1/z, where Gauss' nodes keep it.
    for z in (1e4, 1e6):
        slopes = np.linalg.solve(np.eye(count) + z * rule.once, -z * np.ones(count))
        assert abs(1.0 + rule.end_once @ slopes) < 100.0 / z
