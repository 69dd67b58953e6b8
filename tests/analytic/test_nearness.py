"""The distance of dyads from singular positions, where a sine of an angle does not tell it."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from analytic.kinematics import solve_driven
from analytic.nearness import nearness
from models.files import load_scene, shipped
from models.motion import Motion
from models.scene import Scene

TURN = np.linspace(0.0, math.tau, 721)


def turned(scene: Scene, theta: np.typing.NDArray[np.float64] = TURN) -> Motion:
    return solve_driven(scene, theta, np.ones_like(theta), np.zeros_like(theta), bound=False)


def lever(short: float) -> Scene:
    """The slotted lever whose block comes as near to the pivot as ``short`` times the crank."""
    scene = load_scene("slotted-lever")
    return replace(scene, ground={"A": (0.0, 0.1 * (1.0 + short)), "C": (0.0, 0.0)})


@pytest.mark.parametrize("short", [2.0, 0.1, 1e-3, 1e-6, 0.0])
def test_a_block_that_comes_near_to_the_pivot_of_its_lever_is_near(short: float) -> None:
    """The least distance of the two over the largest, at the crank's lower end."""
    scene = lever(short)
    theta = np.sort(np.append(TURN, -0.5 * math.pi))
    motion = turned(scene, theta)
    found = nearness(scene, motion)["B"]
    assert (motion.conditioning["B"] == 1.0).all()
    assert found.min() == pytest.approx(short / (2.0 + short), abs=1e-15)
    assert math.sin(theta[np.argmin(found)]) == pytest.approx(-1.0, abs=1e-9)
    assert found.max() == 1.0


@pytest.mark.parametrize(("name", "least"), [("slotted-lever", 0.5), ("shaper", 0.5)])
def test_ordinary_levers_are_as_far_as_their_blocks_stay(name: str, least: float) -> None:
    scene = load_scene(name)
    assert nearness(scene, turned(scene))["B"].min() == pytest.approx(least, abs=1e-12)


@pytest.mark.parametrize("name", [n for n in shipped() if n.startswith(("slider", "fourbar-lec"))])
def test_of_other_dyads_it_is_the_sine(name: str) -> None:
    scene = load_scene(name)
    motion = turned(scene)
    found = nearness(scene, motion)
    assert found.keys() == motion.conditioning.keys()
    assert all((found[key] == motion.conditioning[key]).all() for key in found)
