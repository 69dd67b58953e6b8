"""Mechanisms that another joint than a crank's drives: the same motion, and bounds that hold."""

import math
from dataclasses import replace

import numpy as np
import pytest

from analytic.kinematics import reach, solve, solve_driven
from analytic.structure.mobility import analyse
from models.array import Array
from models.errors import ReachError
from models.files.reading import load_scene, parse_scene
from models.motion import Motion
from models.scene import Scene
from models.scene.driver import driver_course
from tests.analytic.chain import coordinates
from tests.analytic.four_bars import fourbar
from tests.analytic.test_bounds import shares
from tests.second_opinions import newton
from tests.worlds.tiers import slowly

LENGTHS = {"usual": (0.1, 0.25, 0.2, 0.3), "parallelogram": (0.1, 0.3, 0.1, 0.3)}
LENGTHS |= {"change point": (0.2, 0.35, 0.25, 0.3), "kite": (0.2, 0.2, 0.3, 0.3)}


def by_pin(lengths: tuple[float, float, float, float], start: float, branch: int = 1) -> Scene:
    driver, degrees = 'pin = "B", links = ["crank", "coupler"]', math.degrees(start)
    return fourbar(*lengths, branch, driver=driver, start_deg=degrees)


CYLINDER = """
name = "cylinder"
source = "test"
ground.points = { A = [0.0, 0.0], D = [0.5, -0.1] }
links.barrel.points = { A = [0.0, 0.02], F = [0.2, 0.0] }
links.rod.points = { E = [0.0, 0.0], C = [0.35, 0.01] }
links.lever.points = { D = [0.0, 0.0], C = [0.3, 0.0] }
sliders.S.on = "barrel"
sliders.S.link = "rod"
sliders.S.point = "E"
sliders.S.through_m = [0.05, 0.01]
sliders.S.direction_deg = 3.0
sliders.S.angle_deg = 4.0
driver.slider = "S"
driver.law = "oscillating"
driver.centre_m = 0.12
driver.amplitude_m = 0.04
driver.frequency_rad_s = 5.0
"""
PISTON = load_scene("slider-crank-by-piston")
LEANING = replace(PISTON.sliders["C"], direction_rad=math.radians(10.0), through_m=(0.0, 0.02))
SCENES = {
    "piston": replace(PISTON, sliders={"C": LEANING}),
    "cylinder": parse_scene(CYLINDER, "test"),
    "coupler pin": by_pin(LENGTHS["usual"], -1.0),
    "coupler pin, other side": by_pin(LENGTHS["usual"], -1.0, -1),
}


@pytest.mark.parametrize("name", SCENES)
def test_error_stays_below_the_bound(name: str) -> None:
    found = shares(SCENES[name], np.array([0.0, 0.37, 1.9, 17.0]))
    assert found.max() <= 1.0
    assert np.median(found[0]) > 1e-4


@pytest.mark.parametrize("name", SCENES)
def test_newton_on_all_constraints_finds_the_same_motion(name: str) -> None:
    scene, time_s = SCENES[name], np.linspace(0.0, 3.0, 40)
    motion = solve(scene, time_s)
    start = coordinates(scene, motion, 0)
    bodies = newton.Constraints(scene).bodies
    guess = {b: tuple(start[3 * i : 3 * i + 3]) for i, b in enumerate(bodies)}
    other = newton.solve(scene, time_s, newton.Guess(guess))
    for link, own in motion.links.items():
        twin = other.links[link]
        turned = own.theta - twin.theta
        assert np.abs(turned - math.tau * np.round(turned / math.tau)).max() < 1e-12
        assert np.allclose(own.omega, twin.omega, rtol=0, atol=1e-11)
        assert np.allclose(own.alpha, twin.alpha, rtol=0, atol=1e-10)


@pytest.mark.parametrize(
    ("name", "samples"),
    [
        *((name, 151) for name in ("usual", "kite")),
        *(slowly(name, 601, reason="instants nearer to a change point") for name in LENGTHS),
    ],
)
def test_a_four_bar_driven_at_its_coupler_follows_the_one_driven_at_its_crank(
    name: str, samples: int
) -> None:
    """Over two turns, through change points where it has them."""
    lengths = LENGTHS[name]
    known = solve(fourbar(*lengths, start_deg=math.degrees(1.2)), np.linspace(0.0, 12.9, samples))
    crank, coupler = known.links["crank"], known.links["coupler"]
    relative = [getattr(coupler, q) - getattr(crank, q) for q in ("theta", "omega", "alpha")]
    found = solve_driven(by_pin(lengths, float(relative[0][0])), *relative)
    for link, own in known.links.items():
        twin = found.links[link]
        assert np.allclose(own.theta, twin.theta, rtol=0, atol=1e-11)
        assert np.allclose(own.omega, twin.omega, rtol=0, atol=1e-8)
        assert np.allclose(own.alpha, twin.alpha, rtol=0, atol=1e-6)
    if name != "usual":
        assert {crossing.dyad for crossing in found.crossings} == {"C"}
    assert all(np.isfinite(one.alpha).all() for one in found.bound.links.values())


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
    _, ahead = reach(scene)
    assert ahead == pytest.approx((0.2, 0.4), abs=1e-12)
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
