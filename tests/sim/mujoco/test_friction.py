"""Constant friction in MuJoCo's joints, against the reference."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from analytic.forces import kinetostatics
from analytic.free.window_chain import ChainMotion
from analytic.kinematics import solve
from models import mjcf_friction, tree
from models.errors import EngineError
from models.files import load_scene
from models.friction import ConstantFriction, CoulombFriction
from models.mjcf import build
from models.scene import Scene
from models.window_chain import Chain
from sim.mujoco import session
from sim.registry import engine
from sim.run import run
from sim.settings import resolved
from tests.sim.mujoco.test_reactions import STEPS, opened

FOURBAR = load_scene("fourbar-lecture-1")


def rubbing(scene: Scene, **sizes: float) -> Scene:
    return replace(scene, friction={k: ConstantFriction(k, size) for k, size in sizes.items()})


@pytest.mark.parametrize(("name", "sizes"), [
    ("fourbar-lecture-1", {"A": 0.05}),
    ("fourbar-lecture-1", {"D": 0.05}),
    ("fourbar-lecture-1", {"C": 0.05, "B": 0.03}),
    ("slider-crank-offset", {"C": 10.0}),
    ("slotted-lever", {"B": 1.0}),
    ("whitworth", {"B": 1.0}),
])  # fmt: skip
def test_friction_costs_the_torque_of_the_reference(name: str, sizes: dict[str, float]) -> None:
    """At 720 steps a turn, but for the samples about a turning point: there friction goes from one
    side to the other, in MuJoCo over some steps."""
    scene = rubbing(load_scene(name), **sizes)
    found = opened(scene).record_forces(STEPS, 1).forces.stretch(slice(5, None))
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


def test_a_free_rod_slows_down_at_its_rate_and_then_stands() -> None:
    """1 N m on 1/3 kg m^2: from 1 rad/s it takes a third of a second, and a sixth of a radian."""
    chain = Chain(0, gravity_m_s2=0.0)
    scene = rubbing(chain.scene(), A0=1.0)
    state = ChainMotion(chain).motion(np.zeros(1)).state(0)
    done = run(scene, state, "mujoco", dt_s=2e-3, steps=300, drive="free")
    rod, time_s = done.motion.links["rocker0"], done.motion.time_s
    sliding = time_s < 0.33
    turned = np.abs(rod.theta - rod.theta[0])
    np.testing.assert_allclose(turned[sliding], (time_s - 1.5 * time_s**2)[sliding], atol=1e-12)
    assert turned[-1] == pytest.approx(1.0 / 6.0, abs=5e-5)  # but for the step in which it stops
    assert abs(rod.omega[-1]) < 1e-12


def turned(scene: Scene) -> Scene:
    """The same driver, with the two links of its pin in the other order."""
    driver = scene.driver
    law = replace(driver.law, start_rad=-driver.law.start_rad, speed_rad_s=-driver.law.speed_rad_s)  # type: ignore[attr-defined, call-arg]  # of constant speed
    return replace(scene, driver=replace(driver, link=driver.base, base=driver.link, law=law))


@pytest.mark.parametrize(("scene", "joint", "size"), [
    (load_scene("slider-crank-by-piston"), "C", 0.5),
    (load_scene("fourbar-by-coupler"), "B", 0.02),
    (turned(load_scene("fourbar-by-coupler")), "B", 0.02),
    (load_scene("fourbar-lecture-1"), "A", 0.02),
], ids=["slider", "pin", "pin, links in the other order", "crank"])  # fmt: skip
def test_friction_of_the_driven_joint_is_not_taken_for_the_drive(
    scene: Scene, joint: str, size: float
) -> None:
    """What rubs in the driven joint itself is no part of what the drive exerts."""
    scene = rubbing(scene, **{joint: size})
    start = solve(scene, np.zeros(1)).state()
    dt_s = scene.driver.law.period_s / 720
    done = run(scene, start, "mujoco", "tuned", dt_s=dt_s, steps=120, with_forces=True)
    found = done.motion.forces
    drive = kinetostatics.forces(scene, found.time_s[20:], skip_dead_points=True).torque
    assert np.nanmax(np.abs(found.torque[20:] - drive)) < 0.02 * size


def test_the_tree_is_planned_once(monkeypatch: pytest.MonkeyPatch) -> None:
    plans: list[object] = []

    def counted(*args: Any, **options: Any) -> tree.Tree:
        plans.append(args)
        return tree.plan(*args, **options)

    for module in (mjcf_friction, session):
        monkeypatch.setattr(module, "plan", counted)
    scene, mujoco = FOURBAR, engine("mujoco")
    settings = resolved(mujoco.profiles["tuned"], {"close": "B"})
    mujoco.open(scene, solve(scene, np.zeros(1)).state(), settings, 1e-3, "prescribed")
    assert len(plans) == 1
