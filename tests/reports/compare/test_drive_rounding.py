"""Long runs: the drive is granted the rounding of its own sum, and no more than that."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from types import ModuleType

import numpy as np
import pytest

from analytic.kinematics import solve
from models.laws import ConstantSpeed, Law, Oscillating
from models.scene import Scene
from reports.compare.beside import Beside, Truth
from reports.compare.compare import compare
from reports.compare.drive_rounding import summed
from reports.compare.errors import Errors
from reports.judge.cell import check
from reports.judge.tolerance import limits
from sim.run import run
from tests.worlds.tiers import slow, slowly
from tests.worlds.turns import of_turns

ENGINES = ("mujoco", "pymunk")
LAWS = {
    "constant": ConstantSpeed(0.3, 10.0),
    "backwards": ConstantSpeed(-3.0, -7.3),
    "oscillating": Oscillating(1.0, 0.5, 10.0),
}


def share(scene: Scene, errors: Errors) -> float:
    """The drive error over its limit."""
    return errors.worst("drive").pure / limits(scene, errors, {})["drive"].number


def drive_share(scene: Scene, engine: str, law: Law, steps_per_turn: float, steps: int) -> float:
    """That of a run that keeps some 2000 of its samples."""
    scene = replace(scene, driver=replace(scene.driver, law=law))
    state = solve(scene, np.zeros(1)).state()
    dt_s = law.period_s / steps_per_turn
    done = run(scene, state, engine, dt_s=dt_s, steps=steps, every=max(steps // 2000, 1))
    assert done.status == "ok"
    return share(scene, compare(Beside.of(Truth(scene), done)))


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("steps_per_turn", [slowly(90.0, reason="steps that divide a turn"), 977.3])
def test_the_drive_of_a_long_run_is_within_what_rounding_explains(
    steps_per_turn: float, law: str, engine: str, fourbar: Scene
) -> None:
    for steps in (1000, 10_000):
        assert drive_share(fourbar, engine, LAWS[law], steps_per_turn, steps) < 0.7


@slow("a million steps: what grows with their square is seen in a sum that long")
@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("law", LAWS)
def test_the_drive_of_ten_thousand_turns_is_within_what_rounding_explains(
    law: str, engine: str, fourbar: Scene
) -> None:
    assert drive_share(fourbar, engine, LAWS[law], 90.0, 1_000_000) < 0.7


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize(
    ("turns", "least"), [(100, 1e-10), slowly(1000, 1e-8, reason="where rounding is over the rest")]
)
def test_a_thousand_turns_are_within_tolerance_as_one_turn_is(
    turns: int, least: float, engine: str, fourbar: Scene
) -> None:
    found = check(of_turns(fourbar, engine, 90, turns))
    assert found.failures == ()
    assert found.limits["drive"].number > least


def test_the_limit_grows_with_the_square_of_the_steps_and_again_for_a_law_that_is_no_line() -> None:
    short, long = (summed(LAWS["constant"], 1e-3, steps) for steps in (10_000, 100_000))
    assert long / short == pytest.approx(100.0, rel=0.03)
    swing = LAWS["oscillating"]
    line = ConstantSpeed(swing.offset_rad, swing.peak_speed_rad_s)
    assert summed(swing, 1e-3, 1000) == pytest.approx(4.0 * summed(line, 1e-3, 1000))


@pytest.mark.parametrize("name", ["drive", "angle", "gap", "velocity", "acceleration"])
def test_every_limit_leaves_room_for_what_the_driver_passes_on(name: str, fourbar: Scene) -> None:
    short = Errors((), (), (), curvature=2.0, conditioning=0.5, step_rad=1e-6)
    long = replace(short, summed_rad=1e-4)
    grown = limits(fourbar, long, {})[name].number - limits(fourbar, short, {})[name].number
    assert grown >= 1e-4


@pytest.mark.parametrize("slower", [False, True])
def test_a_part_in_a_hundred_thousand_is_seen_in_the_drive_of_a_turn(
    slower: bool, fourbar: Scene, errors_of: Callable[..., Errors], fake_engine: ModuleType
) -> None:
    """The crank is behind by so much throughout, or slower by that."""
    rate = fourbar.driver.law.peak_speed_rad_s
    behind = fake_engine.turned_link("crank", lambda t: -1e-5 * (rate * t if slower else 1.0))
    assert share(fourbar, errors_of(fourbar, behind)) > 5_000
