"""Vibration over speeds and inertia: critical speeds where motions are refused, and what a heavy
rocker does."""

from __future__ import annotations

import numpy as np
import pytest

from analytic.elastic.any_speed import at_speed
from analytic.elastic.discretisation import Modes
from analytic.elastic.natural import lowest_rad_s
from analytic.elastic.over_inertia import over_inertia
from analytic.elastic.over_speeds import OverSpeeds, over_speeds, spectra
from analytic.elastic.periodic import periodic_motion
from analytic.elastic.steady_vibration import steady_vibration
from analytic.elastic.swing import spectrum
from models.errors import CrankcheckError
from tests.analytic.elastic.turning import FEW, form_of, fourbar
from tests.worlds.tiers import slowly


@pytest.fixture(scope="module", params=[9, slowly(27, reason="speeds nearer to critical ones")])
def over(request: pytest.FixtureRequest) -> OverSpeeds:
    return over_speeds(fourbar(), FEW, np.linspace(11.0, 24.0, request.param))


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
        if refused:
            with pytest.raises(CrankcheckError, match="a resonance"):
                periodic_motion(form)
        else:
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
    lowest = lowest_rad_s(fourbar())
    found = over_inertia(
        fourbar(), Modes(1, 0), lowest / np.array([5.5, 4.13]), "rocker", np.array([1.0, 30.0])
    )
    assert found.multipliers[0] == pytest.approx(1.0, abs=1e-9)
    assert found.multipliers[1, 0] == pytest.approx(1.0, abs=1e-9)
    assert found.multipliers[1, 1] > 1.5
    assert np.all(found.shares[1] > 0.0)
