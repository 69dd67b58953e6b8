"""Mechanisms that another joint than a crank's drives: the same motion, and bounds that hold."""

from __future__ import annotations

import math

import numpy as np
import pytest

from analytic.check import newton
from analytic.check.newton import Guess
from analytic.kinematics import solve, solve_driven
from models.files import parse_scene
from models.scene import Scene
from tests.analytic.chain import coordinates
from tests.analytic.test_bounds import shares
from tests.worlds.tiers import slowly

LENGTHS = {"usual": (0.1, 0.25, 0.2, 0.3), "parallelogram": (0.1, 0.3, 0.1, 0.3)}
LENGTHS |= {"change point": (0.2, 0.35, 0.25, 0.3), "kite": (0.2, 0.2, 0.3, 0.3)}
AT_CRANK = 'link = "crank"'
AT_PIN = 'pin = "B"\nlinks = ["crank", "coupler"]'


def fourbar(
    lengths: tuple[float, float, float, float], driver: str, start: float, branch: int = 1
) -> Scene:
    """A four-bar A B C D, by the lengths of crank, coupler, rocker and ground."""
    a, b, c, d = lengths
    return parse_scene(
        f"""
name = "fourbar"
source = "test"
[ground]
points = {{ A = [0.0, 0.0], D = [{d}, 0.0] }}
[links]
crank = {{ bar = ["A", "B"], length_m = {a} }}
coupler = {{ bar = ["B", "C"], length_m = {b} }}
rocker = {{ bar = ["D", "C"], length_m = {c} }}
[driver]
{driver}
speed_rad_s = 1.0
start_deg = {math.degrees(start)!r}
[branch]
C = {branch}
""",
        "test",
    )


CYLINDER = """
name = "cylinder"
source = "test"
[ground]
points = { A = [0.0, 0.0], D = [0.5, -0.1] }
[links.barrel]
points = { A = [0.0, 0.02], F = [0.2, 0.0] }
[links.rod]
points = { E = [0.0, 0.0], C = [0.35, 0.01] }
[links.lever]
points = { D = [0.0, 0.0], C = [0.3, 0.0] }
[sliders.S]
on = "barrel"
link = "rod"
point = "E"
through_m = [0.05, 0.01]
direction_deg = 3.0
angle_deg = 4.0
[driver]
slider = "S"
law = "oscillating"
centre_m = 0.12
amplitude_m = 0.04
frequency_rad_s = 5.0
"""
PISTON = """
name = "piston"
source = "test"
[ground]
points = { A = [0.0, 0.0] }
[links]
crank = { bar = ["A", "B"], length_m = 0.1 }
rod = { bar = ["B", "C"], length_m = 0.3 }
[sliders.C]
on = "ground"
direction_deg = 10.0
through_m = [0.0, 0.02]
[driver]
slider = "C"
law = "oscillating"
centre_m = 0.3
amplitude_m = 0.05
frequency_rad_s = 6.0
"""
SCENES = {
    "piston": parse_scene(PISTON, "test"),
    "cylinder": parse_scene(CYLINDER, "test"),
    "coupler pin": fourbar(LENGTHS["usual"], AT_PIN, -1.0),
    "coupler pin, other side": fourbar(LENGTHS["usual"], AT_PIN, -1.0, -1),
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
    other = newton.solve(scene, time_s, Guess(guess))  # type: ignore[arg-type]  # threes
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
    known = solve(fourbar(LENGTHS[name], AT_CRANK, 1.2), np.linspace(0.0, 12.9, samples))
    crank, coupler = known.links["crank"], known.links["coupler"]
    relative = [getattr(coupler, q) - getattr(crank, q) for q in ("theta", "omega", "alpha")]
    scene = fourbar(LENGTHS[name], AT_PIN, float(relative[0][0]))
    found = solve_driven(scene, relative[0], relative[1], relative[2])
    for link, own in known.links.items():
        twin = found.links[link]
        assert np.allclose(own.theta, twin.theta, rtol=0, atol=1e-11)
        assert np.allclose(own.omega, twin.omega, rtol=0, atol=1e-8)
        assert np.allclose(own.alpha, twin.alpha, rtol=0, atol=1e-6)
    if name != "usual":
        assert {crossing.dyad for crossing in found.crossings} == {"C"}
    bound = found.bound
    assert all(np.isfinite(one.alpha).all() for one in bound.links.values())
