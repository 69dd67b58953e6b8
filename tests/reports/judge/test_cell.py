"""A cell from run to verdict, alone and in a pool."""

from __future__ import annotations

import math
import os
from collections.abc import Callable
from dataclasses import replace
from types import ModuleType
from typing import Any

import pytest

from analytic.kinematics import solve
from models.array import Array
from models.errors import EngineError, ReachError
from models.files import load_scene
from models.laws import Accelerating
from models.motion import Motion
from models.scene import Scene
from reports.judge import cell as cells
from reports.judge.cell import Cell, check, unfinished
from reports.verify.all_cells import check_all
from reports.workers.scheduler import FEW
from sim.engine import Run
from sim.run import run
from tests.worlds.tiers import slow

STEPS = 360


def cell(scene: Scene, engine: str = "mujoco", profile: str = "tuned") -> Cell:
    return Cell(scene, engine, profile, scene.driver.law.period_s / STEPS, STEPS)


@pytest.mark.parametrize("engine", ["mujoco", "pymunk"])
def test_a_tuned_fourbar_shrinks_with_second_order(fourbar: Scene, engine: str) -> None:
    seen = check(cell(fourbar, engine)).convergence
    assert seen.trend == "shrinks"
    assert seen.order == pytest.approx(2.0, abs=0.3)
    assert seen.unit == "rad"
    assert len(seen.error) == 3


@pytest.mark.parametrize("engine", ["mujoco", "pymunk"])
@pytest.mark.parametrize(("speed", "acceleration"), [(10.0, 5.0), (0.0, -20.0), (10.0, -20.0)])
def test_a_crank_of_steady_acceleration_is_within_tolerance(
    fourbar: Scene, engine: str, speed: float, acceleration: float
) -> None:
    """From rest, and where it turns round on its way, too."""
    law = Accelerating(math.pi / 2, speed, acceleration)
    found = check(cell(replace(fourbar, driver=replace(fourbar.driver, law=law)), engine))
    assert found.verdict == "within", found.failures
    assert found.convergence.trend == "shrinks"


@slow("only here is a crank off by the rounding of a real sum of 250,000 steps")
def test_the_rounding_of_a_long_run_is_not_taken_for_a_floor(fourbar: Scene) -> None:
    seen = check(Cell(fourbar, "mujoco", "tuned", 1e-4, 62832)).convergence
    assert max(seen.error) < 1e-8
    assert seen.trend in ("shrinks", "at rounding")


@pytest.mark.parametrize(("off_s", "trend"), [(2e-11, "at rounding"), (3e-10, "does not shrink")])
def test_what_rounding_explains_of_the_crank_it_explains_of_all_links(
    fourbar: Scene,
    fake_engine: ModuleType,
    monkeypatch: pytest.MonkeyPatch,
    off_s: float,
    trend: str,
) -> None:
    """A crank that is 2e-10 rad off at every step, as after a long run, and one off by more."""

    def late(scene: Scene, time_s: Array) -> Motion:
        moved = solve(scene, time_s - off_s * (time_s > 0.0), bound=False)
        return replace(moved, time_s=time_s)

    fake = fake_engine.FakeEngine(late)
    monkeypatch.setattr(cells, "engine", lambda _: fake)
    monkeypatch.setattr(cells, "run", lambda one, state, _, *a, **b: run(one, state, fake, *a, **b))
    seen = check(cell(fourbar)).convergence
    assert min(seen.error) > 1e-11
    assert seen.trend == trend


@pytest.mark.parametrize("dt_s", [1e-3, 1e-4])
def test_mujoco_as_shipped_has_a_floor_and_says_so(fourbar: Scene, dt_s: float) -> None:
    one = Cell(fourbar, "mujoco", "as-shipped", dt_s, round(0.63 / dt_s))
    found = check(one)
    assert found.verdict == "out"
    rocker = found.errors.worst("angle")
    assert rocker.maximum > 5e-4
    assert found.convergence.trend == "does not shrink"
    assert 5e-4 < found.convergence.floor < 1e-3


def test_the_tuned_errors_promised_at_a_millisecond_over_ten_turns(fourbar: Scene) -> None:
    steps = 6284
    mujoco, pymunk = (
        check(Cell(fourbar, name, "tuned", 1e-3, steps, converge=False)).errors
        for name in ("mujoco", "pymunk")
    )
    for errors, angle in ((mujoco, 1e-6), (pymunk, 1e-4)):
        rocker, drive = errors.worst("angle"), errors.worst("drive")
        assert rocker.maximum < angle
        assert drive.maximum < 1e-9
    gap = mujoco.worst("gap")
    assert gap.maximum < 1e-6


def test_a_tolerance_that_is_too_tight_puts_the_cell_out(fourbar: Scene) -> None:
    found = check(replace(cell(fourbar), tolerance={"angle": 1e-12}, converge=False))
    assert found.verdict == "out"
    assert [f.rule for f in found.failures] == ["CC103"]
    assert found.convergence is None


def test_a_cell_that_has_no_run_is_a_row_with_a_reason(fourbar: Scene) -> None:
    found = unfinished(cell(fourbar), "crashed", "the engine ended its process")
    assert found.verdict == "out"
    assert "the engine ended its process" in found.failures[0].text


def test_what_can_not_be_compared_is_a_row_with_a_reason(
    fourbar: Scene, monkeypatch: pytest.MonkeyPatch
) -> None:
    def no_reference(*_: object) -> None:
        raise ReachError("the driver is out of reach")

    monkeypatch.setattr(cells, "compare", no_reference)
    found = check(cell(fourbar))
    assert (found.verdict, found.status) == ("out", "crashed")
    assert "the driver is out of reach" in found.failures[0].text


def finer_run(change: Callable[[Run], Run]) -> Callable[..., Run]:
    """As `run`, except that what comes of half the step is changed."""

    def changed(*args: Any, **options: Any) -> Run:
        done = run(*args, **options)
        return change(done) if options["every"] == 2 else done

    return changed


def fails(_: Run) -> Run:
    raise EngineError("no finer step")


def opened(done: Run, gap_m: float) -> Run:
    """The run with a gap at C that the limit at the full step is too wide for."""
    return replace(done, gaps={**done.gaps, "C": done.gaps["C"] * 0.0 + gap_m})


def cut(done: Run) -> Run:
    return replace(done, motion=replace(done.motion, time_s=done.motion.time_s[:50]))


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (fails, "no finer step"),
        (lambda done: replace(done, status="diverged", reason="apart"), "diverged at t = "),
        (lambda done: replace(done, motion=None), "nothing was logged"),
        (lambda done: replace(done, gaps={}), "gap of A nan"),
        (lambda done: opened(done, 2.5e-5), "gap of C 0.0001, limit 7.6e-05"),
        (cut, "50 samples, not the 361"),
    ],
    ids=["raises", "diverged", "logged nothing", "without gaps", "open pin", "short"],
)
def test_a_finer_run_that_does_not_end_well_fails_the_cell(
    fourbar: Scene, monkeypatch: pytest.MonkeyPatch, change: Callable[[Run], Run], words: str
) -> None:
    monkeypatch.setattr(cells, "run", finer_run(change))
    found = check(cell(fourbar))
    assert [f.rule for f in found.failures] == ["CC110"]
    assert words in found.failures[0].text
    shown = check(replace(cell(fourbar), gated=False))
    assert "CC110" in {f.rule for f in shown.advice}


def test_errors_that_are_over_their_limit_at_once_are_not_told_again(fourbar: Scene) -> None:
    seen = check(cell(fourbar, "pymunk", "as-shipped")).convergence
    assert (seen.trend, seen.over, seen.faults) == ("shrinks", (), ())


def test_a_cell_that_kills_its_process_in_a_pool_costs_that_cell_alone(
    fourbar: Scene, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The others have the same errors as in one process, in the same order."""
    scenes = [fourbar, load_scene("slotted-lever"), load_scene("tangent")]
    cells = [
        replace(cell(scene, engine), converge=False)
        for scene in scenes
        for engine in ("mujoco", "pymunk")
    ]
    assert len(cells) >= FEW + 2
    cells[2] = replace(cells[2], profile="deadly")
    monkeypatch.setattr("reports.verify.all_cells.advised", deadly_check)
    heard: list[str] = []
    found = check_all(cells, 2, lambda one: heard.append(one.cell.label))
    assert [one.status for one in found] == ["ok", "ok", "crashed", "ok", "ok", "ok"]
    assert [one.cell.label for one in found] == [one.label for one in cells]
    assert sorted(heard) == sorted(one.label for one in cells)
    del found[2], cells[2]
    assert [one.errors for one in found] == [one.errors for one in check_all(cells, 1)]


def test_a_cell_of_an_engine_that_is_not_ours_is_apart_by_itself(
    fourbar: Scene, monkeypatch: pytest.MonkeyPatch
) -> None:
    one = replace(cell(fourbar, "penalty", "deadly"), converge=False)
    monkeypatch.setattr("reports.verify.all_cells.advised", deadly_check)
    (found,) = check_all([one], 2)
    assert found.reason == "the engine ended its process (exit code 1)"


def deadly_check(cell: Cell) -> object:
    """As `check`, except that one profile ends its process as a fault in native code does."""
    if cell.profile == "deadly":
        os._exit(1)
    return check(cell)
