"""Vibration over speeds and inertia: linearised equations at any speed, critical speeds where
motions are refused, and what a heavy rocker does."""

from __future__ import annotations

from contextlib import nullcontext
from dataclasses import replace

import numpy as np
import pytest

from analytic.elastic.any_speed import AnySpeed, apart, at_speed
from analytic.elastic.discretisation import Modes
from analytic.elastic.linearised import linearise
from analytic.elastic.natural import lowest_rad_s, natural_modes
from analytic.elastic.over_inertia import over_inertia
from analytic.elastic.over_speeds import OverSpeeds, over_speeds, spectra
from analytic.elastic.periodic import periodic_motion
from analytic.elastic.steady_vibration import steady_vibration
from analytic.elastic.swing import spectrum
from models.characteristics import Polynomial
from models.errors import CrankcheckError
from models.laws import FromRest
from models.loads import Load
from models.scene import Scene
from tests.analytic.elastic.driven import FEW, following, form_of, turning
from tests.worlds.tiers import slowly

BY = Modes(2, 0)


def off(scene: Scene, speed: float) -> float:
    """What the linearised equations at a speed are off those that are made there."""
    found = AnySpeed(scene, BY, 5.0, 40.0).linear(speed)
    return apart(found, linearise(form_of(at_speed(scene, speed), BY), found.time_s, 1e-4))


def test_the_linearised_equations_are_polynomials_of_the_speed() -> None:
    scene = replace(turning(damping_s=1e-3), gravity_m_s2=(0.0, -9.81))
    assert AnySpeed(scene, BY, 5.0, 40.0)._series is not None
    assert off(scene, 11.0) < 1e-7


def test_a_load_that_goes_with_the_speed_otherwise_is_met_as_well() -> None:
    drag = Load("drag", "rocker", None, Polynomial((0.0, 0.0, 0.0, -1e-3)), over="omega")
    scene = replace(turning(), loads={"drag": drag})
    assert AnySpeed(scene, BY, 5.0, 40.0)._series is None
    assert off(scene, 11.0) < 1e-7


def test_laws_without_a_constant_speed_are_refused() -> None:
    with pytest.raises(CrankcheckError, match="at a constant one; found another law"):
        at_speed(following(turning(), FromRest(0.0, 10.0, 0.2)), 10.0)


def test_held_still_it_vibrates_as_its_coupler_alone() -> None:
    """A coupler that bends moves its pins by squares of its deflection alone."""
    modes = natural_modes(*AnySpeed(turning(), BY, 5.0, 40.0).still())
    wanted = lowest_rad_s(turning()) * np.outer(np.ones(len(modes.frequency_rad_s)), [1.0, 4.0])
    assert modes.frequency_rad_s[:, :2] == pytest.approx(wanted, rel=1e-6)


@pytest.fixture(scope="module", params=[9, slowly(27, reason="speeds nearer to critical ones")])
def over(request: pytest.FixtureRequest) -> OverSpeeds:
    return over_speeds(turning(), FEW, np.linspace(11.0, 24.0, request.param))


def test_critical_speeds_are_those_next_to_whole_ratios(over: OverSpeeds) -> None:
    strong = {each.order: each for each in over.critical if each.mode == 1}
    assert sorted(strong) == [4, 5, 6, 7]
    for order, each in strong.items():
        assert each.ratio == pytest.approx(order, rel=2e-3)
    assert strong[4].band > strong[5].band > strong[6].band > strong[7].band > 1e-4


def test_motions_are_refused_within_the_band_and_not_outside(over: OverSpeeds) -> None:
    five = next(each for each in over.critical if each.order == 5)
    for share, refused in ((0.3, True), (3.0, False)):
        form = form_of(at_speed(over.scene, (1.0 + share * five.band) * five.speed_rad_s))
        told = pytest.raises(CrankcheckError, match="a resonance") if refused else nullcontext()
        with told:
            periodic_motion(form)


def test_a_point_is_the_linear_theory_at_its_speed(over: OverSpeeds) -> None:
    point = over.points[1]
    vibration = steady_vibration(at_speed(over.scene, point.speed_rad_s), FEW)
    assert point.share == pytest.approx(vibration.theories["linear"]["coupler"].share, rel=1e-6)
    assert point.ratio == pytest.approx(lowest_rad_s(over.scene) / point.speed_rad_s)


def test_spectra_hold_the_whole_deflection(over: OverSpeeds) -> None:
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
