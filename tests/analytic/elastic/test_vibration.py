"""The integration of driven elastic links: against a library's method, by its energy, beside the
equations with every coordinate kept, and by nodes that are exact as high as they say."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp  # type: ignore[import-untyped]

from analytic.elastic import vibration
from analytic.elastic.discretisation import Discretisation, Elements, Modes, Polynomials
from analytic.elastic.elastic_motion import DrivenElasticMotion
from analytic.elastic.free_windows import radau
from analytic.elastic.reduced import ReducedForm
from analytic.elastic.vibration import SlopesOverWindows, tangent, vibrate
from analytic.free.window import gauss
from models.errors import CrankcheckError
from models.files.reading import load_scene
from models.scene import Scene
from models.scene.elastic import Shape
from models.scene.laws import FromRest
from tests.analytic.elastic.driven import (
    apart,
    following,
    form_of,
    fourbar,
    turning,
    with_elastic,
)
from tests.second_opinions.driven_multipliers import DrivenMultipliers
from tests.worlds.tiers import slowly


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


def test_windows_end_at_kinks_and_in_between_the_motion_is_smooth() -> None:
    scene = following(fourbar(), FromRest(fourbar().driver.law.offset_rad, 8.0, 0.31))
    motion = DrivenElasticMotion(scene, 0.6, Polynomials(5), "straight", stiffened=True)
    assert 0.31 in motion.history.edges_s
    assert len(motion.history.edges_s) >= 16
    time_s = np.linspace(0.0, 0.6, 41)
    largest = np.abs(motion.at(time_s).elastic["coupler"].middle).max()
    assert motion.doubt(time_s).middle_m["coupler"].max() < 1e-5 * largest


@pytest.mark.parametrize(
    ("scene", "start"),
    [
        (fourbar(axial_n=3e4, damping_s=2e-4), "straight"),
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


def test_what_bends_too_far_is_refused_with_words() -> None:
    motion = followed(with_elastic(fourbar(), flexural_n_m2=1e-2), 0.1, Polynomials(3))
    with pytest.raises(CrankcheckError, match=r"coupler bends by 0\.\d+ of its length.*stiffer"):
        motion.at(np.linspace(0.0, 0.1, 5))


def test_a_link_that_hardly_bends_takes_no_more_windows_than_it_needs() -> None:
    motion = followed(with_elastic(fourbar(), flexural_n_m2=1e12), 0.01, Polynomials(3))
    middle = motion.at(np.linspace(0.0, 0.01, 5)).elastic["coupler"].middle
    assert 0.0 < np.abs(middle).max() < 1e-13
    assert len(motion.history.z) < 30


def test_a_window_that_is_too_long_is_halved() -> None:
    form = form_of(turning(1.3), Modes(1, 0))
    still = np.zeros(form.size)
    long, short = (vibrate(form, still, still, form.period_s, count) for count in (2, 30))
    middle = np.array([0.5 * form.period_s])
    assert len(long.edges_s) > 3
    assert long.at(middle)[0][0, 0] == pytest.approx(short.at(middle)[0][0, 0], rel=1e-3)


def test_what_is_stiff_is_met_as_well_as_rounding_lets_it(monkeypatch: pytest.MonkeyPatch) -> None:
    """Elements whose highest frequencies are a thousand times the first: what rounding leaves of
    the accelerations may be large, next to them."""
    taken = []

    def counted(*own: object) -> SlopesOverWindows:
        taken.append(own)
        return tangent(*own)  # type: ignore[arg-type]

    monkeypatch.setattr(vibration, "tangent", counted)
    motion = followed(fourbar(), 0.2, Elements(8))
    blocks = len(motion.history.z) / vibration.BLOCK
    assert len(taken) <= 2 * math.ceil(blocks)


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
def test_by_radaus_nodes_polynomials_up_to_their_order_are_exact(count: int) -> None:
    rule = radau(count)
    assert rule.places[-1] == 1.0
    for power in range(2 * count - 1):
        assert rule.end_once @ rule.places**power == pytest.approx(1.0 / (power + 1), rel=1e-12)
    for power in range(count):
        whole = rule.places ** (power + 1) / (power + 1)
        once, twice = (by @ rule.places**power for by in (rule.once, rule.twice))
        np.testing.assert_allclose(once, whole, atol=1e-13)
        np.testing.assert_allclose(twice, whole * rule.places / (power + 2), atol=1e-13)


def test_by_radaus_nodes_what_is_stiff_is_gone_after_a_step() -> None:
    """u' = -z u: the end of a step of 1 goes to 0 with 1/z, where Gauss' nodes keep it."""
    rule = radau(10)
    for z in (1e4, 1e6):
        slopes = np.linalg.solve(np.eye(10) + z * rule.once, -z * np.ones(10))
        assert abs(1.0 + rule.end_once @ slopes) < 100.0 / z
