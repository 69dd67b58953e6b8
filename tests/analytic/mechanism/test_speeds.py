"""Extreme speeds, strokes along directions and under a swing, against closed forms and samples."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from analytic.kinematics import solve, solve_driven
from analytic.mechanism.coriolis import coriolis
from analytic.mechanism.cycle import Along, Output, series
from analytic.mechanism.speeds import extreme_speeds
from analytic.mechanism.travel import travel
from models.errors import CrankcheckError
from models.files import load_scene
from models.laws import ConstantSpeed, Oscillating
from models.passing import passing
from models.scene import Driver

OUTPUTS: list[tuple[str, Output]] = [
    ("fourbar-lecture-1", "rocker"),
    ("fourbar-double-crank", "rocker"),
    ("slider-crank-offset", "C"),
    ("slider-crank-offset", Along("C", 0.4)),
    ("fourbar-lecture-1", Along("C", -1.0)),
    ("shaper", "F"),
    ("shaper", "rod"),
    ("whitworth", "lever"),
    ("sixbar-stephenson", "lever"),
]


@pytest.mark.parametrize(("name", "output"), OUTPUTS)
def test_no_sample_is_faster_and_there_is_no_acceleration(name: str, output: Output) -> None:
    """To rounding: that of a speed, and that of an angle by the third rate of the place."""
    scene = load_scene(name)
    scene = replace(scene, driver=Driver(scene.driver.link, ConstantSpeed(0.0, 1.0)))
    found = extreme_speeds(scene, [output])[output]
    at = np.array([one.driver_rad for one in found])
    _, rate, second = series(solve_driven(scene, at, np.ones_like(at), np.zeros_like(at)), output)
    dense = solve(scene, np.linspace(0.0, math.tau, 20_001))
    _, rates, seconds = series(dense, output)
    third = np.abs(np.gradient(seconds, dense.time_s)).max()
    assert np.abs(second).max() < 1e-14 * (third + np.abs(seconds).max()) * math.tau
    assert [one.rate for one in found] == list(rate)
    size = np.abs(rates).max()
    assert rates.max() <= rate.max() + 1e-14 * size
    assert rates.min() >= rate.min() - 1e-14 * size
    assert rates.max() == pytest.approx(rate.max(), abs=1e-6 * size)
    sign = np.sign(seconds[:-1])
    assert len(found) == np.count_nonzero(sign != np.roll(sign, 1))


def test_the_slotted_lever_is_fastest_where_the_crank_is_in_line_with_it() -> None:
    found = extreme_speeds(load_scene("slotted-lever"), ["lever"])["lever"]
    assert [one.driver_rad for one in found] == pytest.approx(
        [math.pi / 2, 3 * math.pi / 2], abs=1e-15
    )
    assert [one.rate for one in found] == pytest.approx([0.1 / 0.4, -0.1 / 0.2], rel=1e-14)


def test_the_block_of_a_slider_crank_is_fastest_where_a_cubic_has_its_root() -> None:
    """With n rod over crank and s = sin^2 of its angle: s^3 - n^2 s^2 - n^4 s + n^4 = 0, which is
    X'' = 0 of the Excel paper, squared, without the factor that has no root."""
    for length in (2.5, 3.5):
        scene, n = load_scene(f"slider-crank-excel-{round(100 * length)}"), length / 2.0
        roots = np.roots([1.0, -(n**2), -(n**4), n**4])
        (s,) = (float(r.real) for r in roots if abs(r.imag) < 1e-12 and 0.0 < r.real < 1.0)
        angle = math.asin(math.sqrt(s))
        found = extreme_speeds(scene, ["C"])["C"]
        assert [one.driver_rad for one in found] == pytest.approx(
            [angle, math.tau - angle], abs=1e-13
        )


def test_what_keeps_its_speed_has_no_extremes() -> None:
    found = extreme_speeds(load_scene("scotch-yoke"), ["crank", "yoke", "Y"])
    assert (found["crank"], found["yoke"], len(found["Y"])) == ((), (), 2)


def test_a_point_of_the_crank_travels_its_diameter_along_every_direction() -> None:
    scene = load_scene("fourbar-lecture-1")
    for direction in (0.0, 1.0, -2.5):
        along = Along("B", direction)
        found = travel(scene, along)
        assert found.stroke == pytest.approx(0.2, rel=1e-14)
        assert found.time_ratio == pytest.approx(1.0, rel=1e-14)
        assert found.high_at_rad == pytest.approx(direction % math.tau, abs=1e-15)
    with pytest.raises(CrankcheckError, match="A never turns back"):
        travel(scene, Along("A", 0.0))


def test_a_block_along_its_own_line_is_its_slider() -> None:
    scene = load_scene("slider-crank-offset")
    slider, point = travel(scene, "C"), travel(scene, Along("C", 0.0))
    assert point.stroke == pytest.approx(slider.stroke, rel=1e-14)
    assert point.time_ratio == pytest.approx(slider.time_ratio, rel=1e-13)


def test_a_swinging_driver_has_its_limits_at_the_ends_of_its_swing() -> None:
    """Tangent mechanism: y = h tan(phi), and the sleeve goes out to both sides from h."""
    scene, h, end = load_scene("tangent"), 0.15, math.radians(40.0)
    assert travel(scene, "P").stroke == pytest.approx(2.0 * h * math.tan(end), rel=1e-14)
    assert travel(scene, "P").time_ratio == pytest.approx(1.0, rel=1e-14)
    sleeve = travel(scene, "sleeve")
    assert sleeve.stroke == pytest.approx(h / math.cos(end) - h, rel=1e-13)
    assert (sleeve.limits, sleeve.time_ratio) == (4, pytest.approx(1.0, rel=1e-13))
    lever = extreme_speeds(scene, ["lever"])["lever"]
    assert [one.rate for one in lever] == pytest.approx([end, -end], rel=1e-14)
    law = scene.driver.law
    assert isinstance(law, Oscillating)
    for one in extreme_speeds(scene, ["sleeve"])["sleeve"]:
        omega, _ = passing(law, one.driver_rad, clockwise=one.rate * one.driver_rad < 0.0)
        there = solve_driven(scene, np.array([one.driver_rad]), np.array([omega]), np.zeros(1))
        speed = there.sliders["sleeve"].speed[0]
        assert speed == pytest.approx(one.rate * law.frequency_rad_s, rel=1e-13)
    motion = solve(scene, np.linspace(0.0, law.period_s, 40_001))
    fastest = max(one.rate for one in extreme_speeds(scene, ["sleeve"])["sleeve"])
    speeds = motion.sliders["sleeve"].speed / law.frequency_rad_s
    assert speeds.max() == pytest.approx(fastest, rel=1e-7)
    assert speeds.max() <= fastest * (1.0 + 1e-14)


def test_time_ratio_of_one_that_turns_back_on_its_way_is_between_the_outermost() -> None:
    """The shaper's rod is highest at both ends of the ram's stroke, and lowest in between."""
    rod, ram = (travel(load_scene("shaper"), output) for output in ("rod", "F"))
    assert (rod.limits, ram.limits) == (4, 2)
    assert rod.time_ratio == pytest.approx(ram.time_ratio, rel=1e-12)
    assert rod.period_rad == pytest.approx(math.pi, rel=1e-12)


def test_coriolis_is_what_is_left_of_the_acceleration() -> None:
    """In the guide's frame: a crank pin's acceleration less the guide's and that along it."""
    scene = load_scene("whitworth")
    motion = solve(scene, np.linspace(0.0, 0.6, 200))
    lever, slider, pin = motion.links["lever"], motion.sliders["B"], motion.points["B"]
    across = np.stack([-np.sin(lever.theta), np.cos(lever.theta)], axis=1)
    turning = lever.alpha * slider.displacement  # the line goes through the lever's pivot
    left = np.sum(pin.acceleration * across, axis=1) - turning
    assert list(coriolis(scene, motion)) == ["B"]
    assert np.allclose(coriolis(scene, motion)["B"], left, rtol=0, atol=1e-11)
    assert np.abs(left).max() > 10.0
