"""Constant friction in MuJoCo's joints, against the reference."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from analytic.forces import kinetostatics
from analytic.kinematics import solve
from models.errors import EngineError
from models.files import load_scene
from models.friction import ConstantFriction, CoulombFriction
from models.mjcf import build
from models.scene import Scene
from sim.run import run
from tests.sim.mujoco.test_reactions import STEPS, acting, opened

FOURBAR = load_scene("fourbar-lecture-1")


def rubbing(scene: Scene, **sizes: float) -> Scene:
    return replace(scene, friction={k: ConstantFriction(k, size) for k, size in sizes.items()})


@pytest.mark.parametrize(
    ("name", "sizes"),
    [
        ("fourbar-lecture-1", {"A": 0.05}),
        ("fourbar-lecture-1", {"D": 0.05}),
        ("fourbar-lecture-1", {"C": 0.05, "B": 0.03}),
        ("slider-crank-offset", {"C": 10.0}),
        ("slotted-lever", {"B": 1.0}),
        ("whitworth", {"B": 1.0}),
    ],
)
def test_friction_costs_the_torque_of_the_reference(name: str, sizes: dict[str, float]) -> None:
    """At 720 steps a turn, but for the samples about a turning point: there friction goes from one
    side to the other, in MuJoCo over some steps."""
    scene = rubbing(load_scene(name), **sizes)
    found = acting(opened(scene).record_forces(STEPS, 1)).stretch(slice(5, None))
    true = kinetostatics.forces(scene, found.time_s, bound=False)
    turning = np.zeros(len(found.time_s), dtype=bool)
    for joint, size in sizes.items():
        off = np.abs(found.friction[joint] - true.friction[joint])
        assert np.abs(found.friction[joint]).max() == pytest.approx(size, rel=1e-9)
        turning |= off > 1e-3 * size
    assert turning.mean() < 0.015
    error = np.abs(found.torque - true.torque)[~turning]
    assert error.max() < 0.01 * np.abs(true.torque).max()
    assert np.quantile(error, 0.98) < 1e-4 * np.abs(true.torque).max()
    bare = kinetostatics.forces(load_scene(name), found.time_s, bound=False)
    assert np.abs(true.torque - bare.torque).max() > 0.02 * np.abs(true.torque).max()


def test_loops_close_at_a_pin_that_does_not_rub_or_the_scene_is_not_held() -> None:
    at_c = rubbing(FOURBAR, C=0.05)
    assert opened(at_c).facts().settings["close"] == "D"
    state = solve(FOURBAR, np.zeros(1)).state()
    assert 'frictionloss="0.05"' in build(at_c, state)
    assert "frictionloss" not in build(FOURBAR, state)
    done = run(rubbing(FOURBAR, B=0.1, C=0.1, D=0.1), state, "mujoco", dt_s=1e-3, steps=10)
    assert done.status == "unsupported"
    assert "friction.C asks for it; leave a pin of that loop without" in done.reason


def test_friction_that_grows_with_the_reaction_has_no_text() -> None:
    scene = replace(FOURBAR, friction={"B": CoulombFriction("B", 0.1, 0.01)})
    with pytest.raises(EngineError, match=r"friction.B: .*constant friction alone"):
        build(scene, solve(FOURBAR, np.zeros(1)).state())
