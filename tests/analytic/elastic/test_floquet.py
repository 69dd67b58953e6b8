"""Floquet's multipliers: against known ones, against integration over many turns, and their
structure."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.special import mathieu_a, mathieu_b  # type: ignore[import-untyped]  # ships no stubs

from analytic.elastic.discretisation import Modes
from analytic.elastic.floquet import stability, stability_of
from analytic.elastic.linearised import LinearForm, linearise
from analytic.elastic.monodromy import by_collocation
from analytic.elastic.periodic import instants, periodic_motion
from analytic.elastic.reduced import ReducedForm
from analytic.elastic.vibration import vibrate
from models.array import Array
from tests.analytic.elastic.turning import form_of, fourbar
from tests.worlds.tiers import slow, slowly

ONE = Modes(1, 0)


def mathieu(a: float, q: float) -> LinearForm:
    """y'' + (a - 2 q cos 2 t) y = 0 over its period, pi."""
    time_s = instants(9, math.pi)
    one, zero = np.ones((9, 1, 1)), np.zeros((9, 1, 1))
    stiffness = (a - 2.0 * q * np.cos(2.0 * time_s))[:, None, None]
    return LinearForm(time_s, one, zero, stiffness, zero[:, 0])


@pytest.mark.parametrize("q", [0.5, 2.0])
def test_the_bounds_of_mathieus_equation(q: float) -> None:
    for order, multiplier in ((1, -1.0), (2, 1.0)):
        for bound in (mathieu_a(order, q), mathieu_b(order, q)):
            found = by_collocation(mathieu(bound, q), math.pi, 24).multipliers
            assert np.abs(found - multiplier).max() < 1e-5  # a double one: the root of rounding
    between = 0.5 * (mathieu_a(1, q) + mathieu_b(1, q))
    unstable = stability(mathieu(between, q), math.pi)
    assert not unstable.is_stable
    assert unstable.deviations[0].order == 0.5
    assert stability(mathieu(0.5 * (mathieu_a(1, q) + mathieu_b(2, q)), q), math.pi).is_stable


def test_constant_equations_keep_their_order() -> None:
    found = stability(mathieu(3.7**2, 0.0), math.pi)
    assert found.deviations[0].order == pytest.approx(1.85, abs=1e-9)
    assert found.deviations[0].from_whole == pytest.approx(0.15, abs=1e-9)


def about(form: ReducedForm) -> LinearForm:
    """The equations next to the periodic motion."""
    found = periodic_motion(form)
    return linearise(form, found.time_s, 1e-2 * np.abs(found.z).max(), found.at(found.time_s))


@pytest.mark.parametrize("ratio", [10.5, 3.5])
def test_undamped_multipliers_lie_on_the_circle_in_pairs(ratio: float) -> None:
    form = form_of(fourbar(ratio))
    found = by_collocation(about(form), form.period_s, 128)
    assert np.abs(np.abs(found.multipliers) - 1.0).max() < 1e-9
    assert np.linalg.det(found.matrix) == pytest.approx(1.0, abs=1e-9)
    inverse = np.sort_complex(1.0 / found.multipliers)
    assert np.abs(inverse - np.sort_complex(found.multipliers)).max() < 1e-6


def test_damping_takes_what_liouville_says() -> None:
    form = form_of(fourbar(3.5, damping_s=1e-3), ONE)
    linear = about(form)
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
    ends = [
        np.concatenate([end[0][0], end[1][0]])
        for sign in (1.0, -1.0)
        for end in [
            vibrate(form, z + sign * by, rates, turns * form.period_s, windows).at(
                np.array([turns * form.period_s])
            )
        ]
    ]
    return np.concatenate([np.full(form.size, by), np.zeros(form.size)]), 0.5 * (ends[0] - ends[1])


def scaled(state: Array, form: ReducedForm) -> Array:
    """y, and y' over the frequency that it is of."""
    state = state.copy()
    state[form.size :] /= 77.37
    return state


@pytest.mark.parametrize("turns", [1, slowly(2, reason="what has grown grows on")])
def test_an_unstable_motion_grows_as_its_multiplier_says(turns: int) -> None:
    form = form_of(fourbar(4.15, rocker=30.0), ONE)
    found = stability_of(form, periodic_motion(form))
    assert found.largest == pytest.approx(2.58, abs=0.01)
    assert not found.is_stable
    assert found.deviations[0].order == 3.5  # twice that is 7: it feeds on the turning
    start, end = deviated(form, turns, 1e-6, windows=16 * turns)
    expected = np.linalg.matrix_power(found.monodromy.matrix, turns) @ start
    off = np.abs(scaled(end - expected, form)).max()
    assert off < 1e-6 * np.abs(scaled(expected, form)).max()


@slow("800 windows, twice: nothing shorter sees a frequency that is off by 1e-7")
def test_a_hundred_turns_agree_with_the_multipliers() -> None:
    form = form_of(fourbar(3.5), ONE)
    matrix = stability_of(form, periodic_motion(form)).monodromy.matrix
    start, end = deviated(form, 100, 1e-4, windows=800)
    expected = np.linalg.matrix_power(matrix, 100) @ start
    off = np.abs(scaled(end - expected, form)).max()
    assert off < 1e-4 * np.abs(scaled(expected, form)).max()
