"""Long runs: the drive is granted the rounding of its own sum, and no more than that."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from analytic.kinematics import solve
from models.laws import ConstantSpeed, Law, Oscillating
from models.scene import Scene
from reports.compare.beside import Beside, Truth
from reports.compare.compare import compare
from reports.compare.drive_rounding import summed
from reports.compare.errors import Errors
from reports.judge.cell import Cell, check
from reports.judge.tolerance import limits
from sim.engine import Poses
from sim.run import run
from tests.worlds.tiers import slow, slowly

ENGINES = ("mujoco", "pymunk")
LAWS = {
    "constant": ConstantSpeed(0.3, 10.0),
    "backwards": ConstantSpeed(-3.0, -7.3),
    "oscillating": Oscillating(1.0, 0.5, 10.0),
}


def drive_share(scene: Scene, engine: str, law: Law, steps_per_turn: float, steps: int) -> float:
    """The drive error over its limit in a run that keeps some 2000 of its samples."""
    scene = replace(scene, driver=replace(scene.driver, law=law))
    state = solve(scene, np.zeros(1)).state()
    dt_s = law.period_s / steps_per_turn
    done = run(scene, state, engine, dt_s=dt_s, steps=steps, every=max(steps // 2000, 1))
    errors = compare(Beside.of(Truth(scene), done))
    assert done.status == "ok"
    worst = errors.worst("drive")
    return worst.pure / limits(scene, errors, {})["drive"].number


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
    dt_s = fourbar.driver.law.period_s / 90
    found = check(Cell(fourbar, engine, "tuned", dt_s, 90 * turns, converge=False))
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


def late(poses: Poses) -> Poses:
    """The crank 1e-5 rad behind throughout."""
    crank = poses.bodies["crank"]
    bodies = {**poses.bodies, "crank": replace(crank, theta=crank.theta - 1e-5)}
    return replace(poses, bodies=bodies)


def slow(poses: Poses) -> Poses:
    """The crank slower by a part in 1e5."""
    crank = poses.bodies["crank"]
    theta = crank.theta - 1e-5 * (crank.theta - crank.theta[0])
    return replace(poses, bodies={**poses.bodies, "crank": replace(crank, theta=theta)})


@pytest.mark.parametrize("fault", [late, slow])
def test_a_part_in_a_hundred_thousand_is_seen_in_the_drive_of_a_turn(
    fault: Callable[[Poses], Poses], fourbar: Scene, errors_of: Callable[..., Errors]
) -> None:
    errors = errors_of(fourbar, fault)
    worst = errors.worst("drive")
    assert worst.pure > 5_000 * limits(fourbar, errors, {})["drive"].number
