"""Periodic motions: by three methods that share nothing but the equations, and where there is
none."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from analytic.elastic import periodic
from analytic.elastic.discretisation import Discretisation, Elements, Modes, Segments
from analytic.elastic.elastic_motion import DrivenElasticMotion
from analytic.elastic.linearised import linearise
from analytic.elastic.monodromy import by_collocation, by_newmark
from analytic.elastic.periodic import PeriodicMotion, instants, linear_motion, periodic_motion
from analytic.elastic.swing import swings
from analytic.elastic.vibration import vibrate
from models.characteristics import Sine
from models.errors import CrankcheckError
from models.files import load_scene, shipped
from models.laws import ConstantSpeed, FromRest
from models.loads import Load
from models.tabulated import Tabulated
from tests.analytic.elastic.turning import form_of, fourbar
from tests.worlds.tiers import few, slowly

DRIVEN = [n for n in shipped("elastic") if type(load_scene(n).driver.law) is ConstantSpeed]


@pytest.mark.parametrize("name", DRIVEN)
def test_three_methods_start_the_linear_motion_alike(name: str) -> None:
    form = form_of(load_scene(name))
    linear = linearise(form, instants(65, form.period_s), 1e-4)
    balanced = linear_motion(form, linear)
    place, rate, _ = (own[0] for own in balanced.at(np.zeros(1)))
    largest = np.abs(balanced.z).max()
    fastest = np.abs(balanced.at(balanced.time_s)[1]).max()
    for monodromy, close in (
        (by_collocation(linear, form.period_s, 128), 1e-9),
        (by_newmark(linear, form.period_s, 4000), 1e-6),
    ):
        z, rates = monodromy.start
        assert np.abs(z - place).max() <= close * largest
        assert np.abs(rates - rate).max() <= 30.0 * close * fastest


def test_newmark_is_of_order_two() -> None:
    form = form_of(fourbar(3.5))
    linear = linearise(form, instants(65, form.period_s), 1e-4)
    exact, _ = by_collocation(linear, form.period_s, 64).start
    errors = [
        np.abs(by_newmark(linear, form.period_s, n).start[0] - exact).max() for n in (500, 1000)
    ]
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2.0, abs=0.02)


@pytest.mark.parametrize("damping_s", [0.0, 1e-3])
def test_time_integration_comes_back_after_a_turn(damping_s: float) -> None:
    form = form_of(fourbar(3.5, damping_s=damping_s))
    found = periodic_motion(form)
    z, rates, _ = (own[0] for own in found.at(np.zeros(1)))
    after = vibrate(form, z, rates, form.period_s, 20).at(np.array([form.period_s]))
    assert np.abs(after[0][0] - z).max() <= 1e-11 * np.abs(found.z).max()


def test_small_deflections_are_those_of_the_linear_theory() -> None:
    off = []
    for ratio in (20.5, 10.5):
        form = form_of(fourbar(ratio))
        found = periodic_motion(form)
        linear = linear_motion(form, linearise(form, found.time_s, 1e-4))
        off.append(np.abs(found.z - linear.z).max() / np.abs(linear.z).max())
    # The equations next to the rigid motion hold its axial forces: what is left goes with w^2, and
    # w with the square of the speed.
    assert off[0] < 5e-6
    assert np.log(off[1] / off[0]) / np.log(20.5 / 10.5) == pytest.approx(4.0, abs=0.3)


@pytest.mark.parametrize("ratio", [7.0, 5.0, 4.0, 3.0, 2.0])
def test_a_whole_frequency_ratio_is_refused(ratio: float) -> None:
    with pytest.raises(CrankcheckError) as refused:
        periodic_motion(form_of(fourbar(ratio)))
    text = str(refused.value)
    assert f"elastic.coupler vibrates at order {ratio:g} of the driver" in text
    assert f"mode 1 across has 77.3704 rad/s, {ratio:g} times that" in text
    assert f"take another speed ({77.3704 / (ratio + 0.5):.4g} rad/s" in text
    assert "or give elastic links damping_s" in text


def test_between_resonances_the_deflection_goes_with_the_compliance() -> None:
    assert periodic_motion(form_of(fourbar(20.5))).sensitivity.size == pytest.approx(1.0, abs=0.01)
    near = periodic_motion(form_of(fourbar(5.05))).sensitivity
    assert near.size > 1.5
    assert near.order == 5


def test_damping_takes_the_resonance_away() -> None:
    found = periodic_motion(form_of(fourbar(5.0, damping_s=1e-3)))
    assert found.sensitivity.size < 5.0


def test_sensitivity_is_the_change_with_the_stiffness() -> None:
    scene, share = fourbar(5.1), 1e-5
    found = periodic_motion(form_of(scene))
    own = scene.elastic["coupler"]
    stiffer = replace(own, flexural_n_m2=(1.0 + share) * own.flexural_n_m2)
    changed = periodic_motion(form_of(replace(scene, elastic={"coupler": stiffer})))
    change = np.abs(changed.z - found.z).max() / np.abs(found.z).max() / share
    assert found.sensitivity.size == pytest.approx(change, rel=1e-2)


def test_another_branch_is_not_taken_for_the_motion() -> None:
    with pytest.raises(CrankcheckError, match="far from that of small deflections"):
        periodic_motion(form_of(fourbar(2.9, rocker=30.0)))


def test_too_soft_links_are_refused_with_a_cure() -> None:
    with pytest.raises(CrankcheckError, match=r"bend too far for a beam.*take a lower speed"):
        periodic_motion(form_of(fourbar(1.1)))


def test_a_drive_that_does_not_repeat_is_refused() -> None:
    scene = fourbar()
    law = scene.driver.law
    assert isinstance(law, ConstantSpeed)
    from_rest = FromRest(law.start_rad, law.speed_rad_s, 0.3)
    with pytest.raises(CrankcheckError, match="what moves them is not the same"):
        periodic_motion(form_of(replace(scene, driver=replace(scene.driver, law=from_rest))))


@pytest.mark.parametrize(("orders", "repeats"), [(2.0, True), (0.7, False)])
def test_a_load_over_time_has_to_repeat(orders: float, repeats: bool) -> None:
    scene = fourbar()
    speed = scene.driver.law.peak_speed_rad_s
    load = Load("pull", "rocker", "C", Sine(0.1, math.tau / (orders * speed)), direction_rad=0.3)
    form = form_of(replace(scene, loads={"pull": load}))
    if repeats:
        assert periodic_motion(form).decay < 1e-12
    else:
        with pytest.raises(CrankcheckError, match="with loads that repeat each turn"):
            periodic_motion(form)


@pytest.mark.parametrize("most", [65, slowly(129, reason="a longer series leaves out less")])
def test_what_kinks_leave_out_of_the_series_is_in_the_doubt(
    most: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A load with kinks has a series without end: two motions that stop at as many of its terms
    leave the same out."""
    hat = Tabulated((0.0, 0.5 * math.pi, math.pi), (0.0, 0.5, 0.0), "linear", math.tau)
    scene = fourbar(10.5, damping_s=1e-3)
    scene = replace(scene, loads={"push": Load("push", "rocker", None, hat, "angle")})
    motion = DrivenElasticMotion(scene, 1.0, Modes(1), "periodic", stiffened=True)
    closely = periodic_motion(motion.form, 4 * most - 3)
    monkeypatch.setattr(periodic, "MOST", most)
    assert isinstance(motion.history, PeriodicMotion)
    time_s = instants(40, motion.form.period_s)
    true = np.abs(motion.history.at(time_s)[0] - closely.at(time_s)[0]).max()
    other = replace(motion, halved=1).history.at(time_s)[0]
    assert np.abs(motion.history.at(time_s)[0] - other).max() > 0.5 * true
    assert true > 1e-8 * np.abs(closely.z).max()


@pytest.mark.parametrize(
    "by",
    few(
        [Elements(3), Elements(4), Segments(8, corrected=True)],
        {Elements(3)},
        "more slopes, and angles",
    ),
)
def test_links_swing_alike_by_coefficients_of_any_kind(by: Discretisation) -> None:
    """By slopes and angles as well as by lengths."""
    scene = fourbar(10.5)
    known, other = (
        swings(form, periodic_motion(form).z)["coupler"]
        for form in (form_of(scene, Modes(3)), form_of(scene, by))
    )
    assert other.largest_m == pytest.approx(known.largest_m, rel=3e-2)
    assert other.amplitudes[1] == pytest.approx(known.amplitudes[1], rel=3e-2)
