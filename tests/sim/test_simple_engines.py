"""The engines on the common seam: the lecture's four-bar as near as each is known to come."""

from collections.abc import Mapping

import numpy as np
import pytest

from analytic.kinematics import solve
from models.files.reading import load_scene, shipped
from reports.judge.cell import check
from reports.plan.requirements import chosen_engines
from sim.registry import ENGINES, apart, available
from tests.worlds.engines import HERE, SIMPLE
from tests.worlds.runs import massless, ran
from tests.worlds.tiers import few, slow
from tests.worlds.turns import of_turns

INSTALLS_IN_A_MINUTE = [name for name in ("rapier", "box2d", "dart") if name in HERE]
LATER = "not installed by `make test`, or built in seconds"
WITHIN: Mapping[str, float] = {
    "simbody": 1e-9, "drake": 1e-4, "dart": 1e-4, "bullet": 1e-4, "rapier": 2e-5, "box2d": 2e-4,
}  # fmt: skip
"""Largest error of the rocker in a second at 1 ms, tuned [rad]."""


@pytest.mark.parametrize("name", few(SIMPLE, INSTALLS_IN_A_MINUTE, LATER))
def test_the_rocker_of_the_lectures_four_bar_is_where_it_has_to_be(name: str) -> None:
    scene = load_scene("fourbar-lecture-1")
    motion = ran(scene, name, dt_s=1e-3, steps=1000).motion
    true = solve(scene, motion.time_s).links["rocker"].theta
    assert np.abs(motion.links["rocker"].theta - true).max() < WITHIN[name]


@slow("18 scenes each")
@pytest.mark.parametrize("name", SIMPLE)
@pytest.mark.parametrize("scene", shipped())
def test_a_tuned_engine_is_within_tolerance_on_a_shipped_scene(name: str, scene: str) -> None:
    found = check(of_turns(scene, name, 720, turns=2))
    assert found.verdict == "within", found.failures


@pytest.mark.parametrize("name", few(SIMPLE, INSTALLS_IN_A_MINUTE, LATER))
def test_a_driven_block_without_mass_hands_the_drives_force_on_to_its_pin(name: str) -> None:
    scene = massless(load_scene("slider-crank-by-piston"))
    found = check(of_turns(scene, name, with_forces=True))
    assert found.verdict == "within", found.failures


def test_all_are_those_that_are_installed_and_the_others_are_named_with_their_command(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert chosen_engines("all") == HERE
    lines = capsys.readouterr().err.splitlines()
    lacking = [one for one in available() if not one.version]
    assert len(lines) == len(lacking)
    for line, one in zip(lines, lacking, strict=True):
        assert f"engine {one.name}: not installed; " in line
        assert one.install in line


def test_engines_that_may_end_their_process_run_in_one_of_their_own() -> None:
    assert not apart(["mujoco", "pymunk", "exudyn"])
    assert all(apart(["mujoco", name]) for name in ENGINES if name in WITHIN)
    assert apart(["an engine of a user"])
