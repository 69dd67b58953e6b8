"""Mechanisms that another joint than a crank's drives: the same motion, and bounds that hold."""

import math
from dataclasses import replace

import numpy as np
import pytest

from analytic.kinematics import reach, solve, solve_driven
from models.errors import ReachError
from models.files.reading import load_scene, parse_scene
from models.scene import Scene
from tests.analytic.four_bars import fourbar
from tests.analytic.test_bounds import shares
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
sliders.S = { on = "barrel", link = "rod", point = "E", through_m = [0.1, 0.0], angle_deg = 4.0 }
[driver]
slider = "S"
law = "oscillating"
centre_m = 0.12
amplitude_m = 0.04
frequency_rad_s = 5.0
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


def test_a_piston_stands_between_its_dead_points_alone() -> None:
    scene = load_scene("slider-crank-by-piston")
    _, ahead = reach(scene)
    assert ahead == pytest.approx((0.2, 0.4), abs=1e-12)
    with pytest.raises(ReachError, match=r"slider C at 0\.41 m: the loop cannot close at B"):
        solve_driven(scene, np.array([0.41]), np.ones(1), np.zeros(1))
