"""Periodic motions: by three methods that share nothing but the equations, and where there is none;
Floquet's multipliers, against known ones and integration over many turns; and vibration over speeds
and inertia: critical speeds where motions are refused, and what a heavy rocker does."""

import math
from contextlib import nullcontext
from dataclasses import replace

import numpy as np
import pytest
from scipy.special import mathieu_a, mathieu_b  # type: ignore[import-untyped]  # ships no stubs

from analytic.elastic import periodic
from analytic.elastic.discretisation import Modes
from analytic.elastic.elastic_motion import DrivenElasticMotion
from analytic.elastic.natural import lowest_rad_s, natural_modes
from analytic.elastic.periodic import (
    LinearForm,
    PeriodicMotion,
    instants,
    linear_motion,
    linearise,
    periodic_motion,
)
from analytic.elastic.reduced import ReducedForm
from analytic.elastic.vibration import vibrate
from analytic.lectures.vibration.floquet import by_collocation, stability, stability_of
from analytic.lectures.vibration.over_speeds import OverSpeeds, over_inertia, over_speeds, spectra
from analytic.lectures.vibration.steady_vibration import (
    AnySpeed,
    apart,
    at_speed,
    spectrum,
    steady_vibration,
)
from models.array import Array
from models.errors import CrankcheckError
from models.files.reading import load_scene, shipped
from models.scene import Scene
from models.scene.characteristics import Polynomial, Sine
from models.scene.laws import ConstantSpeed, FromRest
from models.scene.loads import Load
from models.scene.tabulated import Tabulated
from tests.analytic.elastic.driven import FEW, following, form_of, turning, with_elastic
from tests.worlds.tiers import slow

DRIVEN = [n for n in shipped("elastic") if type(load_scene(n).driver.law) is ConstantSpeed]


@pytest.mark.parametrize("name", DRIVEN)
def test_two_methods_start_the_linear_motion_alike(name: str) -> None:
    form = form_of(load_scene(name))
    linear = linearise(form, instants(65, form.period_s), 1e-4)
    balanced = linear_motion(form, linear)
    place, rate, _ = (own[0] for own in balanced.at(np.zeros(1)))
    largest = np.abs(balanced.z).max()
    fastest = np.abs(balanced.at(balanced.time_s)[1]).max()
    z, rates = by_collocation(linear, form.period_s, 128).start
    assert np.abs(z - place).max() <= 1e-9 * largest
    assert np.abs(rates - rate).max() <= 3e-8 * fastest


def test_time_integration_comes_back_after_a_turn() -> None:
    form = form_of(turning(3.5, damping_s=1e-3))
    found = periodic_motion(form)
    z, rates, _ = (own[0] for own in found.at(np.zeros(1)))
    after = vibrate(form, z, rates, form.period_s, 20).at(np.array([form.period_s]))
    assert np.abs(after[0][0] - z).max() <= 1e-11 * np.abs(found.z).max()


def test_small_deflections_are_those_of_the_linear_theory() -> None:
    off = []
    for ratio in (20.5, 10.5):
        form = form_of(turning(ratio))
        found = periodic_motion(form)
        linear = linear_motion(form, linearise(form, found.time_s, 1e-4))
        off.append(np.abs(found.z - linear.z).max() / np.abs(linear.z).max())
    # The equations next to the rigid motion hold its axial forces: what is left goes with w^2, and
    # w with the square of the speed.
    assert off[0] < 5e-6
    assert np.log(off[1] / off[0]) / np.log(20.5 / 10.5) == pytest.approx(4.0, abs=0.3)


def test_a_whole_frequency_ratio_is_refused_if_not_damped() -> None:
    with pytest.raises(CrankcheckError) as refused:
        periodic_motion(form_of(turning(5.0)))
    text = str(refused.value)
    assert "elastic.coupler vibrates at order 5 of the driver" in text
    assert "mode 1 across has 77.3704 rad/s, 5 times that" in text
    assert "take another speed (14.07 rad/s" in text
    assert "or give elastic links damping_s" in text
    assert periodic_motion(form_of(turning(5.0, damping_s=1e-3))).sensitivity.size < 5.0


def test_sensitivity_is_the_change_with_the_stiffness() -> None:
    scene, share = turning(5.05), 1e-5
    flexural = (1.0 + share) * scene.elastic["coupler"].flexural_n_m2
    found = periodic_motion(form_of(scene))
    changed = periodic_motion(form_of(with_elastic(scene, flexural_n_m2=flexural)))
    change = np.abs(changed.z - found.z).max() / np.abs(found.z).max() / share
    assert found.sensitivity.size == pytest.approx(change, rel=1e-2)
    assert found.sensitivity.order == 5


@pytest.mark.parametrize(
    ("scene", "words"),
    [
        (turning(2.9, rocker=30.0), "far from that of small deflections"),
        (turning(1.1), r"bend too far for a beam.*take a lower speed"),
        (following(turning(), FromRest(1.0, 7.4, 0.3)), "their loads are not the same"),
    ],
)
def test_what_has_no_periodic_motion_is_refused(scene: Scene, words: str) -> None:
    with pytest.raises(CrankcheckError, match=words):
        periodic_motion(form_of(scene))


@pytest.mark.parametrize(("orders", "repeats"), [(2.0, True), (0.7, False)])
def test_a_load_over_time_has_to_repeat(orders: float, repeats: bool) -> None:
    scene = turning()
    speed = scene.driver.law.peak_speed_rad_s
    load = Load("pull", "rocker", "C", Sine(0.1, math.tau / (orders * speed)), direction_rad=0.3)
    form = form_of(replace(scene, loads={"pull": load}))
    told = pytest.raises(CrankcheckError, match="with loads that repeat each turn")
    with nullcontext() if repeats else told:
        assert periodic_motion(form).decay < 1e-12


@slow("a second: 257 terms of a load with kinks")
def test_what_kinks_leave_out_is_in_the_doubt(monkeypatch: pytest.MonkeyPatch) -> None:
    """A load with kinks has a series without end: two motions that stop at as many of its terms
    leave the same out."""
    hat = Tabulated((0.0, 0.5 * math.pi, math.pi), (0.0, 0.5, 0.0), "linear", math.tau)
    scene = turning(10.5, damping_s=1e-3)
    scene = replace(scene, loads={"push": Load("push", "rocker", None, hat, "angle")})
    motion = DrivenElasticMotion(scene, 1.0, Modes(1), "periodic", stiffened=True)
    closely = periodic_motion(motion.form, 257)
    monkeypatch.setattr(periodic, "MOST", 65)
    assert isinstance(motion.history, PeriodicMotion)
    time_s = instants(40, motion.form.period_s)
    true = np.abs(motion.history.at(time_s)[0] - closely.at(time_s)[0]).max()
    other = replace(motion, halved=1).history.at(time_s)[0]
    assert np.abs(motion.history.at(time_s)[0] - other).max() > 0.5 * true
    assert true > 1e-8 * np.abs(closely.z).max()


ONE = Modes(1, 0)


def mathieu(a: float, q: float) -> LinearForm:
    """y'' + (a - 2 q cos 2 t) y = 0 over its period, pi."""
    time_s = instants(9, math.pi)
    one, zero = np.ones((9, 1, 1)), np.zeros((9, 1, 1))
    stiffness = (a - 2.0 * q * np.cos(2.0 * time_s))[:, None, None]
    return LinearForm(time_s, one, zero, stiffness, zero[:, 0])


def test_the_bounds_of_mathieus_equation() -> None:
    q = 2.0
    for bound in (mathieu_a, mathieu_b):
        for order, multiplier in ((1, -1.0), (2, 1.0)):
            found = by_collocation(mathieu(bound(order, q), q), math.pi, 24).multipliers
            assert np.abs(found - multiplier).max() < 1e-5  # a double one: the root of rounding
    constant = stability(mathieu(3.7**2, 0.0), math.pi)
    assert constant.deviations[0].order == pytest.approx(1.85, abs=1e-9)
    between = 0.5 * (mathieu_a(1, q) + mathieu_b(1, q))
    unstable = stability(mathieu(between, q), math.pi)
    assert not unstable.is_stable
    assert unstable.deviations[0].order == 0.5
    assert stability(mathieu(0.5 * (mathieu_a(1, q) + mathieu_b(2, q)), q), math.pi).is_stable


def test_damping_takes_what_liouville_says() -> None:
    form = form_of(turning(3.5, damping_s=1e-3), ONE)
    motion = periodic_motion(form)
    near = 1e-2 * np.abs(motion.z).max(), motion.at(motion.time_s)
    linear = linearise(form, motion.time_s, *near)
    found = by_collocation(linear, form.period_s, 64)
    assert np.abs(found.multipliers).max() < 1.0
    rates = np.trace(np.linalg.solve(linear.mass, linear.damping), axis1=1, axis2=2)
    volume = math.exp(-form.period_s * float(rates.mean()))
    assert np.linalg.det(found.matrix) == pytest.approx(volume, rel=1e-8)


def deviated(form: ReducedForm, turns: int, share: float, windows: int) -> tuple[Array, Array]:
    """A small deviation from the periodic motion, y and y', and what turns make of it, by the
    equations of motion: half the difference of two to either side, which leaves squares out."""
    found = periodic_motion(form)
    z, rates, _ = (own[0] for own in found.at(np.zeros(1)))
    by = share * np.abs(found.z).max()
    until_s = turns * form.period_s
    runs = [vibrate(form, z + each, rates, until_s, windows) for each in (by, -by)]
    ends = [np.concatenate([x[0] for x in run.at(np.array([until_s]))[:2]]) for run in runs]
    return np.repeat([by, 0.0], form.size), 0.5 * (ends[0] - ends[1])


@slow("a second: the multipliers are held by what Liouville says")
def test_an_unstable_motion_grows_as_its_multiplier_says() -> None:
    form = form_of(turning(4.15, rocker=30.0), ONE)
    found = stability_of(form, periodic_motion(form))
    assert found.largest == pytest.approx(2.58, abs=0.01)
    assert not found.is_stable
    assert found.deviations[0].order == 3.5  # twice that is 7: it feeds on the turning
    start, end = deviated(form, 1, 1e-6, windows=16)
    expected, scale = found.monodromy.matrix @ start, [1.0, 77.37]  # of y, and of y'
    assert np.abs((end - expected) / scale).max() < 1e-6 * np.abs(expected / scale).max()


BY = Modes(2, 0)


def test_at_any_speed_the_linearised_equations_are_those_made_there() -> None:
    """Polynomials of the speed, but with a load that goes with it otherwise."""
    heavy = replace(turning(damping_s=1e-3), gravity_m_s2=(0.0, -9.81))
    drag = Load("drag", "rocker", None, Polynomial((0.0, 0.0, 0.0, -1e-3)), over="omega")
    for scene, polynomials in ((heavy, True), (replace(turning(), loads={"drag": drag}), False)):
        any_speed = AnySpeed(scene, BY, 5.0, 40.0)
        assert (any_speed._series is not None) == polynomials
        found, there = any_speed.linear(11.0), form_of(at_speed(scene, 11.0), BY)
        assert apart(found, linearise(there, found.time_s, 1e-4)) < 1e-7
    with pytest.raises(CrankcheckError, match="at a constant one; found another law"):
        at_speed(following(turning(), FromRest(0.0, 10.0, 0.2)), 10.0)


def test_held_still_it_vibrates_as_its_coupler_alone() -> None:
    """A coupler that bends moves its pins by squares of its deflection alone."""
    modes = natural_modes(*AnySpeed(turning(), BY, 5.0, 40.0).still())
    wanted = lowest_rad_s(turning()) * np.outer(np.ones(len(modes.frequency_rad_s)), [1.0, 4.0])
    assert modes.frequency_rad_s[:, :2] == pytest.approx(wanted, rel=1e-6)


@pytest.fixture(scope="module")
def over() -> OverSpeeds:
    return over_speeds(turning(), FEW, np.linspace(11.0, 24.0, 9))


def test_next_to_whole_ratios_are_critical_bands_of_no_motion(over: OverSpeeds) -> None:
    strong = {each.order: each for each in over.critical if each.mode == 1}
    assert sorted(strong) == [4, 5, 6, 7]
    for order, each in strong.items():
        assert each.ratio == pytest.approx(order, rel=2e-3)
    assert strong[4].band > strong[5].band > strong[6].band > strong[7].band > 1e-4
    five = next(each for each in over.critical if each.order == 5)
    for share, refused in ((0.3, True), (3.0, False)):
        form = form_of(at_speed(over.scene, (1.0 + share * five.band) * five.speed_rad_s))
        told = pytest.raises(CrankcheckError, match="a resonance") if refused else nullcontext()
        with told:
            periodic_motion(form)


def test_a_point_and_its_spectrum_are_those_of_its_speed(over: OverSpeeds) -> None:
    point = over.points[1]
    vibration = steady_vibration(at_speed(over.scene, point.speed_rad_s), FEW)
    assert point.share == pytest.approx(vibration.theories["linear"]["coupler"].share, rel=1e-6)
    assert point.ratio == pytest.approx(lowest_rad_s(over.scene) / point.speed_rad_s)
    wave = np.cos(2.0 * np.pi * 3.0 * np.arange(65) / 65)
    assert spectrum(2.0 + 0.5 * wave)[[0, 3, 4]] == pytest.approx([2.0, 0.5, 0.0], abs=1e-12)
    amplitudes = spectra(over, "coupler")
    assert amplitudes.shape == (len(over.points), 33)
    middle = np.abs(over.points[0].swings["coupler"].middle).max() / 0.75
    assert amplitudes[0].max() <= middle <= amplitudes[0].sum()


def test_a_heavy_rocker_makes_it_unstable() -> None:
    speeds = lowest_rad_s(turning()) / np.array([5.5, 4.13])
    found = over_inertia(turning(), Modes(1, 0), speeds, "rocker", np.array([1.0, 30.0]))
    assert found.multipliers[0] == pytest.approx(1.0, abs=1e-9)
    assert found.multipliers[1, 0] == pytest.approx(1.0, abs=1e-9)
    assert found.multipliers[1, 1] > 1.5
    assert np.all(found.shares[1] > 0.0)
