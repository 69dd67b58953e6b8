"""Constant friction in pymunk: in the reactions, and in what it does to a free mechanism."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from analytic.forces.kinetostatics import forces
from analytic.kinematics import solve
from models.files import load_scene
from models.friction import ConstantFriction
from models.scene import Scene
from sim.pymunk.engine import ENGINE
from sim.run import run
from tests.sim.pymunk.test_reactions import START, misses, of_a_turn


def renamed(name: str, slider: str) -> Scene:
    """With another name for its slider, which leaves that of the point to the pin."""
    scene = load_scene(name)
    ((old, only),) = scene.sliders.items()
    branch = {slider if key == old else key: sign for key, sign in scene.branch.items()}
    return replace(scene, sliders={slider: replace(only, name=slider)}, branch=branch)


def rubbing(scene: Scene, **sizes: float) -> Scene:
    friction = {joint: ConstantFriction(joint, size) for joint, size in sizes.items()}
    return replace(scene, friction=friction)


RUBBING = {
    "pins": rubbing(load_scene("fourbar-lecture-1"), A=0.03, B=0.04, C=0.05, D=0.06),
    "a block without mass": rubbing(renamed("slider-crank-excel-350", "piston"), C=2.0, piston=3.0),
    "one with mass": rubbing(renamed("slider-crank-offset", "piston"), C=0.2, piston=3.0),
    "one on a moving guide": rubbing(renamed("slotted-lever", "die"), B=0.2, die=0.3),
}


@pytest.mark.parametrize("where", RUBBING)
def test_constant_friction_is_against_the_motion(where: str) -> None:
    """But for the samples at which a joint turns back, where it may be anything within its size."""
    scene = RUBBING[where]
    found = of_a_turn(scene, 720).motion.forces
    exact = forces(scene, found.time_s, bound=False)
    same = np.ones(len(found.time_s), dtype=bool)
    for joint, law in scene.friction.items():
        agree = np.isclose(found.friction[joint], exact.friction[joint], atol=1e-9 * law.size)
        assert (~agree).sum() <= 1 + 2, joint  # the first sample, and the ends of two strokes
        same &= agree
    for key, off in misses(found, exact, scene.longest_m).items():
        assert off[same[START:]].max() < 1e-3, key


def test_friction_of_a_pin_brings_a_free_mechanism_to_rest_and_that_of_a_slider_is_refused() -> (
    None
):
    scene = rubbing(load_scene("slider-crank-offset"), B=5.0)
    state = solve(scene, np.zeros(1)).state()
    result = run(scene, state, ENGINE, dt_s=1e-3, steps=1000, drive="free")
    assert np.abs(result.motion.links["crank"].omega[-100:]).max() < 1e-6
    refused = run(rubbing(scene, C=1.0), state, ENGINE, dt_s=1e-3, steps=10, drive="free")
    assert refused.status == "unsupported"
    assert "friction.C: pymunk has no friction that holds a slider at rest" in refused.reason
