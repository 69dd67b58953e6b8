"""Samples beside jumps of forces: of friction where its joint turns, of loads on one stroke."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from analytic.forces.kinetostatics import forces
from analytic.kinematics import solve
from models.characteristics import Constant
from models.files import load_scene
from models.friction import ConstantFriction
from models.loads import Load
from models.scene import Scene
from models.tabulated import Tabulated
from reports.compare.jumps import NEAR, near_jumps

SLIDER = load_scene("slider-crank-offset")


def _near(scene: Scene, steps: int = 360) -> list[int]:
    """The samples that are beside a jump."""
    time_s = np.linspace(0.0, scene.driver.law.period_s, steps + 1)
    motion = solve(scene, time_s, bound=False)
    motion = replace(motion, forces=forces(scene, motion, bound=False))
    return np.flatnonzero(near_jumps(scene, motion)).tolist()


def _turns(steps: int = 360) -> list[int]:
    """The samples after which the slider turns back."""
    time_s = np.linspace(0.0, SLIDER.driver.law.period_s, steps + 1)
    speed = solve(SLIDER, time_s, bound=False).sliders["C"].speed
    return np.flatnonzero(np.diff(np.sign(speed))).tolist()


def _beside(turns: list[int]) -> list[int]:
    return sorted(k + by for k in turns for by in range(1 - NEAR, 1 + NEAR))


def test_nothing_jumps_without_friction_and_loads_of_strokes() -> None:
    assert _near(SLIDER) == []
    both = Load("push", "block C", "C", Constant(1.0))
    assert _near(replace(SLIDER, loads={"push": both})) == []


def test_friction_jumps_where_its_joint_turns_back() -> None:
    scene = replace(SLIDER, friction={"C": ConstantFriction("C", 0.5)})
    assert len(_turns()) == 2
    assert _near(scene) == _beside(_turns())


def test_so_does_a_load_of_a_stroke_where_it_is_other_than_0() -> None:
    push = Load("push", "block C", "C", Constant(1.0), slider="C", stroke="forward")
    assert _near(replace(SLIDER, loads={"push": push})) == _beside(_turns())
    ends = Tabulated((-1.0, 0.3, 0.35, 1.0), (0.0, 0.0, 1.0, 1.0))  # at the outer end alone
    far = replace(push, characteristic=ends, over="displacement")
    assert _near(replace(SLIDER, loads={"push": far})) == _beside(_turns()[1:])


def test_a_run_of_few_samples_has_them_all_beside_a_jump() -> None:
    scene = replace(SLIDER, friction={"C": ConstantFriction("C", 0.5)})
    assert _near(scene, 2) == [0, 1, 2]
