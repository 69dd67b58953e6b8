"""Quick returns, and cranks that turn clockwise or speed up, against numbers in print.

What was measured off a drawing there has the accuracy of one, which each test states.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

from analytic.kinematics import solve
from analytic.mechanism.coriolis import coriolis
from analytic.mechanism.cycle import Along
from analytic.mechanism.travel import travel
from models.files import parse_scene
from models.scene import Scene

SLIDER_CRANK = """
[ground]
points = {{ O = [0.0, 0.0] }}
[links]
crank = {{ bar = ["O", "B"], length_m = {crank} }}
rod = {{ points = {{ B = [0.0, 0.0], A = [{rod}, 0.0], D = [{middle}, 0.0] }} }}
[sliders.A]
on = "ground"
"""
SLOTTED = """
[ground]
points = {{ A = [{x!r}, {y!r}], C = [0.0, 0.0] }}
[links]
crank = {{ bar = ["A", "B"], length_m = {crank} }}
lever = {{ bar = ["C", "D"], length_m = {lever} }}
[sliders.B]
on = "lever"
"""
STEADY = '[driver]\nlink = "crank"\nspeed_rad_s = 1.0\n'


def scene(text: str, driver: str = STEADY, **numbers: float) -> Scene:
    head = 'name = "published"\nsource = "in print"\n'
    return parse_scene(head + text.format(**numbers) + driver, "test")


def accelerating(speed: float, acceleration: float, start_deg: float) -> str:
    return (
        f'[driver]\nlink = "crank"\nlaw = "accelerating"\nspeed_rad_s = {speed}\n'
        f"acceleration_rad_s2 = {acceleration}\nstart_deg = {start_deg}\n"
    )


def test_crank_and_slotted_lever() -> None:
    """R. S. Khurmi and J. K. Gupta, Theory of Machines, chapter 5: pivots 240 mm apart, crank
    120 mm, slotted bar 450 mm: 30 degrees to either side, time ratio 2, stroke 450 mm."""
    found = scene(SLOTTED, x=0.0, y=0.24, crank=0.12, lever=0.45)
    lever = travel(found, "lever")
    assert math.degrees(lever.stroke) == pytest.approx(60.0, rel=1e-13)
    assert lever.time_ratio == pytest.approx(2.0, rel=1e-13)
    assert travel(found, Along("D", 0.0)).stroke == pytest.approx(0.45, rel=1e-13)


def test_whitworth_quick_return() -> None:
    """The same chapter: crank 150 mm, pivots 100 mm apart, the line of stroke through the lever's
    pivot, across that of the pivots: time ratio 2.735."""
    found = scene(SLOTTED, x=0.0, y=0.1, crank=0.15, lever=0.3)
    assert travel(found, Along("D", 0.0)).time_ratio == pytest.approx(2.735, abs=5e-4)


def test_time_ratio_is_that_of_the_synthesis_lecture() -> None:
    """Lecture "Tong hop co cau", slider-crank types: central, a stroke of twice the crank; offset,
    more than that, and Q = (180 + a) / (180 - a), a the angle between the rod's limit positions."""
    text = SLIDER_CRANK.replace('on = "ground"', 'on = "ground"\nthrough_m = [0.0, {offset}]')
    central = travel(scene(text, crank=0.1, rod=0.3, middle=0.1, offset=0.0), "A")
    assert central.stroke == pytest.approx(0.2, rel=1e-14)
    offset = travel(scene(text, crank=0.1, rod=0.3, middle=0.1, offset=-0.1), "A")
    assert offset.stroke > 0.2
    between = math.degrees(math.asin(0.1 / 0.2) - math.asin(0.1 / 0.4))
    ratio = (180.0 + between) / (180.0 - between)
    assert offset.time_ratio == pytest.approx(ratio, rel=1e-13)


def test_a_clockwise_crank() -> None:
    """Khurmi and Gupta, chapter 8: crank 150 mm clockwise at 300 rpm, rod 600 mm, at 45 degrees
    from the inner dead centre: its middle has 4.1 m/s and 117 m/s^2, the rod 5.67 rad/s, 171.67
    rad/s^2. Drawn: 3 %."""
    driver = f'[driver]\nlink = "crank"\nspeed_rad_s = {-10.0 * math.pi}\nstart_deg = 45.0\n'
    motion = solve(scene(SLIDER_CRANK, driver, crank=0.15, rod=0.6, middle=0.3), np.zeros(1))
    middle, rod = motion.points["D"], motion.links["rod"]
    assert math.hypot(*middle.velocity[0]) == pytest.approx(4.1, rel=0.03)
    assert math.hypot(*middle.acceleration[0]) == pytest.approx(117.0, rel=0.005)
    assert rod.omega[0] == pytest.approx(5.67, rel=0.01)
    assert rod.alpha[0] == pytest.approx(171.67, rel=0.002)


def test_a_crank_that_speeds_up_clockwise() -> None:
    """The same chapter: four-bar of 300, 360, 360 and 600 mm, crank at 60 degrees, 10 rad/s and 30
    rad/s^2 clockwise: 2.2 m/s and 29.6 m/s^2 of B, 37.8 and 73.8 rad/s^2 of the links. Drawn: 5 %.
    """
    text = """
[ground]
points = {{ P1 = [0.0, 0.0], P2 = [0.6, 0.0] }}
[links]
crank = {{ bar = ["P1", "A"], length_m = 0.3 }}
coupler = {{ bar = ["A", "B"], length_m = 0.36 }}
rocker = {{ bar = ["P2", "B"], length_m = 0.36 }}
"""
    motion = solve(scene(text, accelerating(-10.0, -30.0, 60.0)), np.zeros(1))
    b = motion.points["B"]
    assert math.hypot(*b.velocity[0]) == pytest.approx(2.2, rel=0.02)
    assert math.hypot(*b.acceleration[0]) == pytest.approx(29.6, rel=0.05)
    assert motion.links["coupler"].alpha[0] == pytest.approx(37.8, rel=0.01)
    assert motion.links["rocker"].alpha[0] == pytest.approx(73.8, rel=0.05)


def test_a_quick_return_whose_crank_speeds_up() -> None:
    """R. C. Hibbeler, Engineering Mechanics: Dynamics, chapter 16, rotating axes: crank 100 mm at 3
    rad/s and 9 rad/s^2, its pin 300 mm along the slotted link and 30 degrees from it: 0.866 rad/s
    and 3.23 rad/s^2; Coriolis is 2 * 0.866 * 0.15 m/s^2."""
    pivot = {"x": 0.3 - 0.1 * math.cos(math.radians(30.0)), "y": 0.05}
    found = scene(SLOTTED, accelerating(3.0, 9.0, -30.0), crank=0.1, lever=0.5, **pivot)
    motion = solve(found, np.zeros(1))
    assert motion.links["lever"].omega[0] == pytest.approx(0.866, abs=5e-4)
    assert motion.links["lever"].alpha[0] == pytest.approx(3.23, abs=5e-3)
    assert motion.sliders["B"].speed[0] == pytest.approx(0.15, rel=1e-13)
    assert coriolis(found, motion)["B"][0] == pytest.approx(2 * 0.866 * 0.15, abs=2e-4)
