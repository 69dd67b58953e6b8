"""The reference against the numbers and formulas of lectures, papers and textbooks."""

from __future__ import annotations

import math

import numpy as np
import pytest

from analytic.dyads.plane import EPS
from analytic.kinematics import solve
from models.array import Array
from models.files import load_scene, shipped

SLIDER_CRANKS = [name for name in shipped() if name.startswith("slider-crank")]


def assert_near(found: Array, bound: Array, wanted: Array, scale: Array | float) -> None:
    """Within the bound and the rounding of the formula, of some thirty operations."""
    assert np.all(np.abs(found - wanted) <= bound + 32 * EPS * (np.abs(wanted) + scale))


def test_lecture_example_1_at_90_deg() -> None:
    """The lecture's figures, to their last digit."""
    motion = solve(load_scene("fourbar-lecture-1"), np.zeros(1))
    coupler, rocker, c = motion.links["coupler"], motion.links["rocker"], motion.points["C"]
    assert motion.links["crank"].theta[0] == pytest.approx(math.pi / 2, abs=1e-15)
    assert coupler.omega[0] == pytest.approx(-1.3257269, abs=0.5e-7)
    assert rocker.omega[0] == pytest.approx(4.6761490, abs=0.5e-7)
    assert coupler.alpha[0] == pytest.approx(20.297811, abs=0.5e-6)
    assert rocker.alpha[0] == pytest.approx(19.396967, abs=0.5e-6)
    assert math.hypot(*c.velocity[0]) == pytest.approx(0.9352298, abs=0.5e-7)
    assert math.hypot(*c.acceleration[0]) == pytest.approx(5.8459573, abs=0.5e-7)


@pytest.mark.parametrize("name", SLIDER_CRANKS)
def test_slider_crank_follows_the_lecture(name: str) -> None:
    """Section IV: f2 below the rod's pin, so the rod stands at -f2 and the line at y = -e."""
    scene = load_scene(name)
    motion = solve(scene, np.linspace(0.0, scene.driver.law.period_s, 721))
    l1, l2 = scene.links["crank"].points["B"][0], scene.links["rod"].points["C"][0]
    e, w, f1 = (
        -scene.sliders["C"].through_m[1],
        motion.links["crank"].omega[0],
        motion.links["crank"].theta,
    )
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


@pytest.mark.parametrize("name", [n for n in SLIDER_CRANKS if "excel" in n])
def test_slider_crank_follows_the_excel_paper(name: str) -> None:
    """X, X', X'', rod speed and acceleration as functions of R, L and the crank angle."""
    scene = load_scene(name)
    motion = solve(scene, np.linspace(0.0, scene.driver.law.period_s, 721))
    r, length, w = 2.0, float(name[-3:]) / 100.0, 1.0
    phi = motion.links["crank"].theta
    s, c = np.sin(phi), np.cos(phi)
    root = np.sqrt(length**2 - r**2 * s**2)
    found, bound, steep = motion.sliders["C"], motion.bound.sliders["C"], length / root
    assert_near(found.displacement, bound.displacement, r * c + root, length * steep)
    assert_near(found.speed, bound.speed, -r * w * s - r**2 * w * s * c / root, r * steep**2)
    x2 = -r * w**2 * c - r**2 * w**2 * ((c**2 - s**2) / root + r**2 * s**2 * c**2 / root**3)
    assert_near(found.acceleration, bound.acceleration, x2, r * steep**4)
    rod, rod_bound = motion.links["rod"], motion.bound.links["rod"]
    assert_near(rod.omega, rod_bound.omega, -r * w * c / root, steep**2)
    alpha = r * w**2 * s * (length**2 - r**2) / root**3
    assert_near(rod.alpha, rod_bound.alpha, alpha, steep**4)


def test_scotch_yoke_is_a_cosine() -> None:
    scene = load_scene("scotch-yoke")
    motion = solve(scene, np.linspace(0.0, 2.0, 500))
    r, phi, w = 0.1, motion.links["crank"].theta, 10.0
    for name, (x, v, a) in {
        "Y": (r * np.cos(phi), -r * w * np.sin(phi), -r * w**2 * np.cos(phi)),
        "B": (r * np.sin(phi), r * w * np.cos(phi), -r * w**2 * np.sin(phi)),
    }.items():
        found, bound = motion.sliders[name], motion.bound.sliders[name]
        assert_near(found.displacement, bound.displacement, x, r)
        assert_near(found.speed, bound.speed, v, r * w)
        assert_near(found.acceleration, bound.acceleration, a, r * w**2)
    assert not motion.links["yoke"].omega.any()


def test_tangent_mechanism_is_a_tangent() -> None:
    scene = load_scene("tangent")
    motion = solve(scene, np.linspace(0.0, 1.0, 500))
    lever, h = motion.links["lever"], 0.15
    phi, w, g = lever.theta, lever.omega, lever.alpha
    sec, tan = 1.0 / np.cos(phi), np.tan(phi)
    found, bound = motion.sliders["P"], motion.bound.sliders["P"]
    assert_near(found.displacement, bound.displacement, h * tan, h)
    assert_near(found.speed, bound.speed, h * sec**2 * w, h * 10)
    assert_near(found.acceleration, bound.acceleration, h * sec**2 * (g + 2 * w * w * tan), h * 1e3)
    sleeve, bound = motion.sliders["sleeve"], motion.bound.sliders["sleeve"]
    assert_near(sleeve.displacement, bound.displacement, h * sec, h)
    assert_near(sleeve.speed, bound.speed, h * sec * tan * w, h * 10)
    turning = h * sec * (tan * g + w * w * (sec**2 + tan**2))
    assert_near(sleeve.acceleration, bound.acceleration, turning, h * 1e3)


def test_slotted_lever_adds_up_with_coriolis() -> None:
    """What the lever, the sliding and Coriolis give the block is what the crank gives its pin."""
    scene = load_scene("slotted-lever")
    motion = solve(scene, np.linspace(0.0, 0.7, 300))
    assert motion.bound is not None
    r, d, w, phi = 0.1, 0.3, 10.0, motion.links["crank"].theta
    lever, slide, b = motion.links["lever"], motion.sliders["B"], motion.points["B"].position
    square = r * r + d * d + 2 * r * d * np.sin(phi)
    assert np.allclose(lever.omega, w * r * (r + d * np.sin(phi)) / square, rtol=0, atol=1e-13)
    assert np.allclose(slide.displacement, np.sqrt(square), rtol=0, atol=1e-15)
    along = b / np.hypot(*b.T)[:, None]
    across = np.stack([-along[:, 1], along[:, 0]], axis=1)
    transport = (
        lever.alpha[:, None] * np.stack([-b[:, 1], b[:, 0]], axis=1) - lever.omega[:, None] ** 2 * b
    )
    coriolis = (2.0 * lever.omega * slide.speed)[:, None] * across
    summed = transport + slide.acceleration[:, None] * along + coriolis
    crank = -(w**2) * (b - np.array([0.0, d]))
    assert np.abs(coriolis).max() > 1.0
    assert np.allclose(summed, crank, rtol=0, atol=1e-12)
    assert np.allclose(motion.points["B"].acceleration, crank, rtol=0, atol=1e-12)
