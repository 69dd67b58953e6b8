"""The reference against the numbers and formulas of lectures, papers and textbooks.

What was measured off a drawing in print has the accuracy of one, which each test states.
"""

import math
from dataclasses import replace

import numpy as np
import pytest

from analytic.dyads.plane import EPS
from analytic.kinematics import solve
from analytic.mechanism.cycle import Along, coriolis, travel
from models.array import Array
from models.files.reading import load_scene, parse_scene
from models.scene import Scene
from models.scene.laws import Accelerating
from tests.analytic.four_bars import fourbar


def assert_near(found: Array, bound: Array, wanted: Array, scale: Array | float) -> None:
    """Within the bound and the rounding of the formula, of some thirty operations."""
    assert np.all(np.abs(found - wanted) <= bound + 32 * EPS * (np.abs(wanted) + scale))


def test_lecture_example_1_at_90_deg() -> None:
    motion = solve(load_scene("fourbar-lecture-1"), np.zeros(1))
    coupler, rocker, c = motion.links["coupler"], motion.links["rocker"], motion.points["C"]
    assert motion.links["crank"].theta[0] == pytest.approx(math.pi / 2, abs=1e-15)
    assert coupler.omega[0] == pytest.approx(-1.3257269, abs=0.5e-7)
    assert rocker.omega[0] == pytest.approx(4.6761490, abs=0.5e-7)
    assert coupler.alpha[0] == pytest.approx(20.297811, abs=0.5e-6)
    assert rocker.alpha[0] == pytest.approx(19.396967, abs=0.5e-6)
    assert math.hypot(*c.velocity[0]) == pytest.approx(0.9352298, abs=0.5e-7)
    assert math.hypot(*c.acceleration[0]) == pytest.approx(5.8459573, abs=0.5e-7)


@pytest.mark.parametrize("name", ["slider-crank-offset", "slider-crank-excel-210"])
def test_slider_crank_follows_the_lecture(name: str) -> None:
    """Section IV: f2 below the rod's pin, so the rod stands at -f2 and the line at y = -e."""
    scene = load_scene(name)
    motion = solve(scene, np.linspace(0.0, scene.driver.law.period_s, 721))
    l1, l2 = scene.links["crank"].points["B"][0], scene.links["rod"].points["C"][0]
    crank = motion.links["crank"]
    e, w, f1 = -scene.sliders["C"].through_m[1], crank.omega[0], crank.theta
    f2 = np.arcsin((l1 * np.sin(f1) + e) / l2)
    x = l1 * np.cos(f1) + l2 * np.cos(f2)
    v = -l1 * w * (np.sin(f1) + np.cos(f1) * np.tan(f2))
    a = -l1 * w**2 * (np.cos(f1 + f2) / np.cos(f2) + l1 * np.cos(f1) ** 2 / (l2 * np.cos(f2) ** 3))
    found, bound, steep = motion.sliders["C"], motion.bound.sliders["C"], 1.0 / np.cos(f2)
    assert_near(found.displacement, bound.displacement, x, (l1 + l2) * steep)
    assert_near(found.speed, bound.speed, v, l1 * w * steep**2)
    assert_near(found.acceleration, bound.acceleration, a, l1 * w**2 * steep**4)
    turn = np.abs(motion.links["rod"].theta + f2)
    assert np.all(turn <= motion.bound.links["rod"].theta + 32 * EPS * steep)


SLOTTED = """
ground.points = {{ A = [{x!r}, {y!r}], C = [0.0, 0.0] }}
links.crank = {{ bar = ["A", "B"], length_m = {crank} }}
links.lever = {{ bar = ["C", "D"], length_m = {lever} }}
sliders.B.on = "lever"
"""


def scene(
    text: str, *, speed: float = 1.0, start: float = 0.0, gain: float = 0.0, **numbers: float
) -> Scene:
    """A mechanism in print, its crank at a speed that may grow [rad/s, deg, rad/s^2]."""
    head = 'name = "published"\nsource = "in print"\n'
    driver = f'\n[driver]\nlink = "crank"\nspeed_rad_s = {speed}\nstart_deg = {start}\n'
    grows = f'law = "accelerating"\nacceleration_rad_s2 = {gain}\n' if gain else ""
    return parse_scene(head + text.format(**numbers) + driver + grows, "test")


def test_quick_returns_have_the_time_ratios_of_the_textbook() -> None:
    """R. S. Khurmi and J. K. Gupta, Theory of Machines, chapter 5: pivots 240 mm apart, crank
    120 mm, slotted bar 450 mm: 30 degrees to either side, time ratio 2, stroke 450 mm."""
    found = scene(SLOTTED, x=0.0, y=0.24, crank=0.12, lever=0.45)
    lever = travel(found, "lever")
    assert math.degrees(lever.stroke) == pytest.approx(60.0, rel=1e-13)
    assert lever.time_ratio == pytest.approx(2.0, rel=1e-13)
    assert travel(found, Along("D", 0.0)).stroke == pytest.approx(0.45, rel=1e-13)
    # Whitworth's: crank 150 mm, pivots 100 mm apart, the line of stroke through the lever's
    # pivot, across that of the pivots: time ratio 2.735.
    whitworth = scene(SLOTTED, x=0.0, y=0.1, crank=0.15, lever=0.3)
    assert travel(whitworth, Along("D", 0.0)).time_ratio == pytest.approx(2.735, abs=5e-4)


def test_a_crank_that_speeds_up_clockwise() -> None:
    """The same chapter: four-bar of 300, 360, 360 and 600 mm, crank at 60 degrees, 10 rad/s and 30
    rad/s^2 clockwise: 2.2 m/s and 29.6 m/s^2 of B, 37.8 and 73.8 rad/s^2 of the links. Drawn: 5 %.
    """
    found = fourbar(0.3, 0.36, 0.36, 0.6)
    law = Accelerating(math.radians(60.0), -10.0, -30.0)
    motion = solve(replace(found, driver=replace(found.driver, law=law)), np.zeros(1))
    c = motion.points["C"]
    assert math.hypot(*c.velocity[0]) == pytest.approx(2.2, rel=0.02)
    assert math.hypot(*c.acceleration[0]) == pytest.approx(29.6, rel=0.05)
    assert motion.links["coupler"].alpha[0] == pytest.approx(37.8, rel=0.01)
    assert motion.links["rocker"].alpha[0] == pytest.approx(73.8, rel=0.05)


def test_a_quick_return_whose_crank_speeds_up() -> None:
    """R. C. Hibbeler, Engineering Mechanics: Dynamics, chapter 16, rotating axes: crank 100 mm at 3
    rad/s and 9 rad/s^2, its pin 300 mm along the slotted link and 30 degrees from it: 0.866 rad/s
    and 3.23 rad/s^2; Coriolis is 2 * 0.866 * 0.15 m/s^2."""
    pivot = {"x": 0.3 - 0.1 * math.cos(math.radians(30.0)), "y": 0.05}
    found = scene(SLOTTED, speed=3.0, gain=9.0, start=-30.0, crank=0.1, lever=0.5, **pivot)
    motion = solve(found, np.zeros(1))
    assert motion.links["lever"].omega[0] == pytest.approx(0.866, abs=5e-4)
    assert motion.links["lever"].alpha[0] == pytest.approx(3.23, abs=5e-3)
    assert motion.sliders["B"].speed[0] == pytest.approx(0.15, rel=1e-13)
    assert coriolis(found, motion)["B"][0] == pytest.approx(2 * 0.866 * 0.15, abs=2e-4)
