"""Motions of mechanisms: beside the equation of the machine, on their way, and with jumps."""

import math
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from analytic.free.exact_motions import ChainMotion
from analytic.free.release import release
from analytic.kinematics import solve
from analytic.multibody.multibody_motion import MultibodyMotion, Projection
from analytic.multibody.release_multibody import release_multibody
from models.errors import CrankcheckError
from models.files.reading import load_scene
from models.scene.hard import WindowChain
from models.scene.loads import Load
from models.scene.moved import scaled
from models.scene.tabulated import Tabulated
from tests.analytic.free.mechanisms import fourbar
from tests.analytic.multibody.scenes import (
    DOUBLE_PENDULUM,
    FIVE_BAR,
    SLIDER_CRANK,
    THESIS,
    by_bodies,
    scene,
)
from tests.second_opinions.baumgarte_table import gap
from tests.worlds.tiers import few, slow, slowly

SPRINGS = """
[springs]
line = { points = ["A", "C"], rate_n_m = 60.0, damping_n_s_m = 0.3, free_m = 0.3 }
pin = { pin = "B", rate_n_m_rad = 0.2, damping_n_m_s = 0.01, free_deg = 380.0 }
slide = { slider = "C", rate_n_m = 80.0, damping_n_s_m = 0.2, free_m = 0.35 }
[loads]
motor = { link = "crank", law = "polynomial", over = "omega", torque_n_m = [0.1, -0.01] }
wind = { link = "rod", point = "C", frame = "body", direction_deg = 90.0, force_n = 0.4 }
"""
CASES = {
    "swing": load_scene("fourbar-swing"),
    "spun": scene(SLIDER_CRANK + "speed_rad_s = 15.0\n"),
    "pulse": scene(THESIS.split("[start]")[0], 0.0),  # whose angles are read off a drawing
    "springs": scene(SLIDER_CRANK + "start_deg = 30.0\n" + SPRINGS),
}


@cache
def case(name: str) -> tuple[MultibodyMotion, float]:
    """What moves from rest by a pulse takes its time."""
    until_s = 0.5 if name == "pulse" else 0.1
    return by_bodies(CASES[name], until_s), until_s


def test_a_mechanism_of_micrometres_has_masses_too() -> None:
    """Its moments of inertia are 1e-12 of its masses, in SI units."""
    small, time_s = scaled(load_scene("fourbar-swing"), 1e-6), np.array([0.05])
    here, there = (f(small, 0.05).at(time_s).links["crank"].theta[0] for f in (by_bodies, release))
    assert abs(here - small.driver.law.start_rad) > 1e-2
    assert here == pytest.approx(there, abs=1e-10)


@pytest.mark.parametrize(
    "name", few(CASES, CASES.keys() - {"spun", "springs"}, "0.5 s: more that acts")
)
def test_it_goes_as_the_equation_of_the_machine_says_closed_and_with_its_energy(name: str) -> None:
    free, until_s = case(name)
    other = release(CASES[name], until_s)
    time_s = np.linspace(0.0, until_s, 11)
    grown = free.sensitivity(time_s)
    found, wanted = free.at(time_s), other.at(time_s, bound=False)
    for link, motion in found.links.items():
        assert np.all(np.abs(motion.theta - wanted.links[link].theta) <= 1e-9 * grown), link
        assert motion.omega == pytest.approx(wanted.links[link].omega, abs=1e-8)
        assert motion.alpha == pytest.approx(wanted.links[link].alpha, abs=1e-6)
    for slider, motion in found.sliders.items():
        assert motion.displacement == pytest.approx(wanted.sliders[slider].displacement, abs=1e-10)
        assert motion.acceleration == pytest.approx(wanted.sliders[slider].acceleration, abs=1e-6)
    for point, place in found.points.items():
        assert place.acceleration == pytest.approx(wanted.points[point].acceleration, abs=1e-6)
    dense_s = np.linspace(0.0, until_s, 37)
    energy = free.energy(dense_s)
    assert gap(free, dense_s).max() < 1e-15
    assert np.ptp(energy.balance) < 3e-11 * energy.kinetic.max()


@pytest.mark.parametrize("text", [DOUBLE_PENDULUM, FIVE_BAR], ids=["double pendulum", "five-bar"])
def test_two_freedoms_converge_and_keep_their_energy(text: str) -> None:
    time_s = np.linspace(0.0, 0.08, 11)
    fine = release_multibody(scene(text), 0.08)
    rough = release_multibody(scene(text), 0.08, Projection(1e-9))
    for link, motion in fine.at(time_s).links.items():
        assert motion.theta == pytest.approx(rough.at(time_s).links[link].theta, abs=1e-7)
    energy = fine.energy(time_s)
    assert np.ptp(energy.balance) < 1e-11 * np.ptp(energy.potential)
    assert fine.sensitivity(time_s)[-1] >= 1.0


@slow("two seconds: only in half a second of motion changes grow by as much")
def test_sensitivity_is_what_a_changed_start_or_speed_grows_by() -> None:
    mechanism = CASES["swing"]
    law, end = mechanism.driver.law, np.array([0.5])
    nudged = replace(mechanism, driver=replace(mechanism.driver, law=law.turned(1e-5)))
    own, other = (by_bodies(one, 0.5) for one in (mechanism, nudged))
    here, there = (one.at(end).links["crank"].theta[0] for one in (own, other))
    assert abs(there - here) <= 1.01e-5 * own.sensitivity(end)[0]
    assert own.sensitivity(end)[0] < 100.0
    # Spun so fast that its speed tells when it is where.
    pulsed = load_scene("fourbar-pulse")
    law = replace(pulsed.driver.law, speed_rad_s=20.0)
    spun, end = replace(pulsed, loads={}, driver=replace(pulsed.driver, law=law)), np.array([0.5])
    wanted = release(spun, 0.5).sensitivity(end)[0]
    assert wanted > 8.0
    assert by_bodies(spun, 0.5).sensitivity(end)[0] == pytest.approx(wanted, rel=0.05)


@pytest.mark.parametrize("beside_rad", [slowly(0.0, reason="at the row itself"), 1e-17])
def test_it_starts_at_a_row_of_a_table(beside_rad: float) -> None:
    """Or by rounding beside it, and so crosses the row as soon as it is in free motion."""
    gas = (
        '[loads.gas]\nblock = "C"\ndirection_deg = 180.0\nlaw = "table"\nover = "angle"\n'
        'interpolation = "linear"\nat_deg = [0.0, 90.0, 270.0]\nperiod_deg = 360.0\n'
        "force_n = [4.0, 1.0, 2.0]\n"
    )
    mechanism = scene(SLIDER_CRANK + "speed_rad_s = 15.0\n" + gas)
    near = solve(mechanism, np.zeros(1), bound=False).state()
    near = replace(near, theta={**near.theta, "crank": beside_rad})
    ways = release_multibody(mechanism, 0.05, near=near), release(mechanism, 0.05)
    found, wanted = (way.at(np.array([0.05])).links["crank"].theta for way in ways)
    assert found == pytest.approx(wanted, abs=1e-10)


CUT = (
    '[loads.cut]\nblock = "C"\ndirection_deg = 180.0\nslider = "C"\nstroke = "forward"\nforce_n = '
)


def test_a_load_on_one_stroke_jumps_where_the_slider_turns_or_holds_it() -> None:
    """Its work is its force times the strokes."""
    until_s = 0.05
    text = SLIDER_CRANK + "speed_rad_s = 40.0\nstart_deg = 150.0\n" + CUT + "2.0\n"
    free = by_bodies(scene(text), until_s)
    energy = free.energy(np.linspace(0.0, until_s, 11))
    assert np.ptp(energy.balance) < 1e-11 * energy.kinetic.max()
    slider = free.at(np.linspace(0.0, until_s, 201)).sliders["C"]
    forward = np.maximum(np.diff(slider.displacement), 0.0).sum()
    assert energy.work[-1] == pytest.approx(-2.0 * forward, abs=1e-5)
    assert energy.work[-1] < -0.05
    held = SLIDER_CRANK + "speed_rad_s = 15.0\n" + CUT + "20.0\n"
    with pytest.raises(CrankcheckError, match=r"loads\.cut holds slider C in place"):
        by_bodies(scene(held), 1.0).at(np.array([1.0]))


def test_tables_have_kinks_at_their_rows_and_in_all_their_periods() -> None:
    """Its work is the area below it, between the places of start and end."""
    table = (
        '[loads.gas]\nblock = "C"\ndirection_deg = 0.0\nlaw = "table"\nslider = "C"\n'
        'over = "displacement"\ninterpolation = "linear"\n'
        "at_m = [0.1, 0.25, 0.3, 0.35, 0.41]\nforce_n = [0.0, 5.0, 2.0, 7.0, 1.0]\n"
    )
    free = by_bodies(scene(SLIDER_CRANK + "speed_rad_s = 20.0\nstart_deg = 60.0\n" + table), 0.06)
    place = free.at(np.array([0.0, 0.06])).sliders["C"].displacement
    rows = [row for row in (0.25, 0.3, 0.35) if place[1] < row < place[0]]
    x = np.unique([*np.linspace(*place, 9), *rows])
    area = -np.trapezoid(np.interp(x, [0.1, 0.25, 0.3, 0.35, 0.41], [0, 5, 2, 7, 1]), x)
    assert rows
    assert free.energy(np.array([0.06])).work[0] == pytest.approx(area, abs=1e-9)
    # Over time in all its periods.
    motor = Load("motor", "crank", None, Tabulated((0.0, 0.02), (1.0, -1.0), period=0.05))
    spun = by_bodies(replace(CASES["spun"], loads={"motor": motor}), 0.11)
    assert spun.edges_s == pytest.approx([0.02, 0.05, 0.07, 0.1])


@slow("a second: a parallelogram goes through its flat positions as well")
def test_a_chain_goes_through_its_flat_positions_and_is_smooth_within_a_passage() -> None:
    """At which its mobility is N + 1: twice down, and twice up, in one turn and a bit."""
    turning = ChainMotion(WindowChain(2))
    free = release_multibody(WindowChain(2).scene(), 2.0, near=turning.motion(np.zeros(1)).state())
    time_s = np.linspace(0.0, 2.0, 81)
    found, (theta, _, alpha) = free.at(time_s), turning.at(time_s)
    assert abs(theta[-1] - theta[0]) > math.tau
    for rocker in WindowChain(2).rockers():
        assert found.links[rocker].theta == pytest.approx(theta, abs=1e-11)
        assert found.links[rocker].alpha == pytest.approx(alpha, abs=1e-6)
    assert len(free._history.passages) == 2
    # Of a shorter one, within its passage.
    turning = ChainMotion(WindowChain(1))
    near = turning.motion(np.zeros(1)).state()
    free = release_multibody(WindowChain(1).scene(), 0.75, Projection(1e-11), near=near)
    (passage,) = free._history.passages
    flat = np.linspace(passage.begin_s, passage.end_s, 9)
    theta, _, alpha = turning.at(flat)
    assert np.sin(theta).min() < 0.0 < np.sin(theta).max()
    assert passage.at_s == pytest.approx(flat.mean(), abs=1e-3)
    found = free.at(flat).links["rocker1"]
    assert found.theta == pytest.approx(theta, abs=1e-8)
    assert found.alpha == pytest.approx(alpha, abs=1e-5)


def test_a_parallelogram_goes_through_its_flat_positions() -> None:
    """In a few steps: those of one that is missed shrink to nothing."""
    own = fourbar(0.0838, 0.4833, 0.0838, 0.4833, start_deg=14.404, speed_rad_s=0.0, branch=1)
    free, other, time_s = by_bodies(own, 0.32), release(own, 0.32), np.linspace(0.0, 0.32, 41)
    assert len(free._history.passages) >= 2
    assert free._history.steps < 150
    found, wanted = free.at(time_s), other.at(time_s, bound=False)
    for link, motion in found.links.items():
        off = np.abs(motion.theta - wanted.links[link].theta)
        assert np.all(off <= 1e-10 * other.sensitivity(time_s)), link


@slow("a second and a half: its steps shrink beside a change point")
@pytest.mark.parametrize(
    ("beside", "start_deg", "until_s"),
    [
        (1e-7, 165.0, 0.05),
        slowly(-1e-9, 80.0, 0.3, reason="nearer, to the other side, and from farther off"),
    ],
)
def test_beside_a_change_point_it_turns_off(
    beside: float, start_deg: float, until_s: float
) -> None:
    """To what rounding leaves of its lengths; and its steps do not shrink to nothing either."""
    own = fourbar(0.15, 0.3, 0.15 * (1.0 + beside), 0.3, start_deg=start_deg, speed_rad_s=9.0)
    at_start = solve(own, np.zeros(1), bound=False).state()
    free = release_multibody(own, until_s, Projection(1e-11), near=at_start)
    assert free._history.passages == ()
    assert free._history.steps < 250
    energy = free.energy(np.linspace(0.0, until_s, 11))
    assert np.ptp(energy.balance) < 1e-14 / abs(beside) * energy.kinetic.max()


def test_too_many_steps_and_no_time_are_told_soon(monkeypatch: pytest.MonkeyPatch) -> None:
    for until_s in (math.nan, 0.0):
        with pytest.raises(CrankcheckError, match="give a time above 0"):
            release_multibody(scene(DOUBLE_PENDULUM), until_s)
    monkeypatch.setattr("analytic.multibody.steps.MOST_STEPS", 200)
    monkeypatch.setattr("analytic.multibody.steps.FIRST_STEPS", 20)
    damped = scene(DOUBLE_PENDULUM + '[springs.stiff]\npoints = ["A", "C"]\ndamping_n_s_m = 1e6\n')
    with pytest.raises(CrankcheckError, match=r"took 20 steps .* give a time of .* s or less"):
        release_multibody(damped, 1.0).at(np.array([1.0]))
