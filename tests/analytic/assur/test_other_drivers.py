"""The shipped mechanisms with a triad, driven at another link: of class II, and the same motion."""

from __future__ import annotations

import math

import numpy as np
import pytest

from analytic.kinematics import reach, solve, solve_driven
from analytic.structure.mobility import analyse
from models.array import Array
from models.driver_course import driver_course
from models.errors import ReachError
from models.files import load_scene
from models.motion import Motion
from models.scene import Scene

PAIRS = {
    "triad-platform": ("triad-platform-by-leg", "leg3"),
    "triad-slider": ("triad-slider-by-rocker", "rocker"),
}


def half_turns(scene: Scene, link: str) -> list[Array]:
    """The times [s] between the limits of a link, which swings to and fro in a turn, two halves."""
    period = scene.driver.law.period_s
    time_s = np.linspace(0.0, period, 2001)
    omega = solve(scene, time_s, bound=False).links[link].omega
    first, second = time_s[1:][np.sign(omega[1:]) != np.sign(omega[:-1])]
    ends = ((first, second), (second, first + period))
    return [np.linspace(begin, end, 41)[1:-1] for begin, end in ends]


def apart(one: Motion, other: Motion) -> float:
    """The largest distance of a point [m]."""
    off = (other.points[name].position - at.position for name, at in one.points.items())
    return max(float(np.max(np.hypot(*each.T))) for each in off)


@pytest.mark.parametrize("name", PAIRS)
def test_the_same_mechanism_is_of_class_ii_by_another_link_and_moves_the_same(name: str) -> None:
    """The crank is on one side of its dyad in one half of its turn alone."""
    other, link = PAIRS[name]
    scene, again = load_scene(name), load_scene(other)
    assert analyse(scene).triads
    assert not analyse(again).triads
    pairs = []
    for time_s in half_turns(scene, link):
        first = solve(scene, time_s)
        own = first.links[link]
        pairs.append((first, solve_driven(again, own.theta, own.omega, own.alpha)))
    first, second = min(pairs, key=lambda pair: apart(*pair))
    assert apart(first, second) < 1e-12
    for point, at in second.points.items():
        shift = np.hypot(*(at.acceleration - first.points[point].acceleration).T)
        known = first.bound.points[point].acceleration + second.bound.points[point].acceleration
        # The second is driven at angles that are themselves off by the bound of the first.
        assert np.all(shift <= 1e-9 * (1.0 + np.hypot(*at.acceleration.T)) + known)


def test_a_piston_stands_between_its_dead_points_alone() -> None:
    scene = load_scene("slider-crank-by-piston")
    (_, _), (low, high) = reach(scene)
    assert math.isclose(low, 0.2, abs_tol=1e-12)
    assert math.isclose(high, 0.4, abs_tol=1e-12)
    with pytest.raises(ReachError, match=r"slider C at 0\.41 m: the loop cannot close at B"):
        solve_driven(scene, np.array([0.41]), np.ones(1), np.zeros(1))


def test_crank_and_coupler_make_whole_turns_against_each_other() -> None:
    scene = load_scene("fourbar-by-coupler")
    assert reach(scene) == [(-math.pi, math.pi)]
    motion = solve(scene, np.linspace(0.0, scene.driver.law.period_s, 9))
    turned, _, _ = driver_course(scene, motion)
    assert math.isclose(turned[-1] - turned[0], -math.tau, abs_tol=1e-12)
    crank = motion.links["crank"].theta
    assert math.isclose(crank[-1] - crank[0], math.tau, abs_tol=1e-9)
