"""A cell from run to verdict, alone and in a pool; its rows in frames; how often it solves."""

import os
from collections import Counter
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pandas as pd
import pytest

from analytic import prepared
from analytic.kinematics import solve
from models.array import Array
from models.errors import EngineError, ReachError
from models.files.reading import load_scene, shipped
from models.motion import Motion
from models.scene import Scene
from reports.judge import cell as cells
from reports.judge.cell import Cell, check, unfinished
from reports.judge.rows import ERROR_COLUMNS, cell_frame
from reports.judge.tolerance import FORCES
from reports.quantities import named
from reports.quantities.limits import DEFAULTS
from reports.verify.advised import check_all
from sim.engine import Run
from sim.run import run
from tests.worlds.fake.engine import FakeEngine
from tests.worlds.tiers import few
from tests.worlds.turns import of_turns

BOTH = pytest.mark.parametrize("engine", ["mujoco", "pymunk"])


@pytest.mark.parametrize(("off_s", "trend"), [(2e-11, "at rounding"), (3e-10, "does not shrink")])
def test_what_rounding_explains_of_the_crank_it_explains_of_all_links(
    fourbar: Scene, monkeypatch: pytest.MonkeyPatch, off_s: float, trend: str
) -> None:
    """A crank that is 2e-10 rad off at every step, as after a long run, and one off by more."""

    def late(scene: Scene, time_s: Array) -> Motion:
        moved = solve(scene, time_s - off_s * (time_s > 0.0), bound=False)
        return replace(moved, time_s=time_s)

    fake = FakeEngine(late)
    monkeypatch.setattr(cells, "engine", lambda _: fake)
    monkeypatch.setattr(cells, "run", lambda one, state, _, *a, **b: run(one, state, fake, *a, **b))
    seen = check(of_turns(fourbar, converge=True)).convergence
    assert min(seen.error) > 1e-11
    assert seen.trend == trend


def test_mujoco_as_shipped_has_a_floor_and_says_so(fourbar: Scene) -> None:
    found = check(Cell(fourbar, "mujoco", "as-shipped", 1e-3, 630))
    assert (found.verdict, found.convergence.trend) == ("out", "does not shrink")
    assert found.errors.worst("angle").maximum > 5e-4
    assert 5e-4 < found.convergence.floor < 1e-3


def test_the_tuned_errors_promised_at_a_millisecond_over_ten_turns(fourbar: Scene) -> None:
    for engine, most in (
        ("mujoco", {"angle": 1e-6, "drive": 1e-9, "gap": 1e-6}),
        ("pymunk", {"angle": 1e-4, "drive": 1e-9}),
    ):
        errors = check(Cell(fourbar, engine, "tuned", 1e-3, 6284, converge=False)).errors
        assert all(errors.worst(name).maximum < limit for name, limit in most.items()), engine


def test_what_can_not_be_compared_says_why(fourbar: Scene, monkeypatch: pytest.MonkeyPatch) -> None:
    def no_reference(*_: object) -> None:
        raise ReachError("the driver is out of reach")

    monkeypatch.setattr(cells, "compare", no_reference)
    found = check(of_turns(fourbar, converge=True))
    assert (found.verdict, found.status) == ("out", "crashed")
    assert "the driver is out of reach" in found.failures[0].text


def fails(_: Run) -> Run:
    raise EngineError("no finer step")


def opened(done: Run) -> Run:
    """The run with a gap at C that the limit at the full step is too wide for."""
    return replace(done, gaps={**done.gaps, "C": done.gaps["C"] * 0.0 + 2.5e-5})


def cut(done: Run) -> Run:
    return replace(done, motion=replace(done.motion, time_s=done.motion.time_s[:50]))


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (fails, "no finer step"),
        (lambda done: replace(done, status="diverged", reason="apart"), "diverged at t = "),
        (lambda done: replace(done, motion=None), "nothing was logged"),
        (lambda done: replace(done, gaps={}), "gap of A nan"),
        (opened, "gap of C 0.0001, limit 7.6e-05"),
        (cut, "50 samples, not the 361"),
    ],
    ids=["raises", "diverged", "logged nothing", "without gaps", "open pin", "short"],
)
def test_a_finer_run_that_does_not_end_well_fails_the_cell(
    fourbar: Scene, monkeypatch: pytest.MonkeyPatch, change: Callable[[Run], Run], words: str
) -> None:
    def changed(*args: Any, **options: Any) -> Run:
        done = run(*args, **options)
        return change(done) if options["every"] == 2 else done

    monkeypatch.setattr(cells, "run", changed)
    found = check(of_turns(fourbar, converge=True))
    assert [f.rule for f in found.failures] == ["CC110"]
    assert words in found.failures[0].text
    shown = check(replace(found.cell, gated=False))
    assert "CC110" in {f.rule for f in shown.advice}


def test_errors_that_are_over_their_limit_at_once_are_not_told_again(fourbar: Scene) -> None:
    one = of_turns(fourbar, "pymunk", converge=True, profile="as-shipped")
    seen = check(one).convergence
    assert (seen.trend, seen.over, seen.faults) == ("shrinks", (), ())


def deadly_check(cell: Cell) -> object:
    """As `check`, except that one profile ends its process as a fault in native code does."""
    if cell.profile == "deadly":
        os._exit(1)
    return check(cell)


def test_a_cell_that_kills_its_process_costs_only_itself(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("reports.verify.advised.advised", deadly_check)
    (found,) = check_all([of_turns("fourbar-lecture-1", "penalty", profile="deadly")], 2)
    assert found.reason == "the engine ended its process (exit code 1)"


UNLIKE = (
    "fourbar-double-rocker",
    "scotch-yoke",
    "shaper",
    "sixbar-watt",
    "slotted-lever",
    "tangent",
)


@BOTH
@pytest.mark.parametrize("name", few(shipped(), UNLIKE, "the same joints in other places"))
def test_every_shipped_scene_is_within_tolerance_at_90_steps_a_turn(name: str, engine: str) -> None:
    found = check(of_turns(name, engine, 90, turns=2))
    assert found.verdict == "within", found.failures


def test_a_failure_is_a_row_with_its_reason_and_the_same_columns(slider_crank: Scene) -> None:
    cell = of_turns(slider_crank, "pymunk", converge=True)
    frame = cell_frame([check(cell), unfinished(cell, "crashed", "gone")])
    assert frame["status"].tolist() == ["ok", "crashed"]
    assert frame["reason"].tolist() == ["", "gone"]
    assert frame["verdict"].tolist() == ["within", "out"]
    assert pd.isna(frame["angle_error_rad"][1])
    assert frame["failed_rules"].tolist() == ["", "CC101"]
    # Columns carry units, and nothing that is not reported.
    units = ("_rad", "_m", "_rad_s", "_m_s", "_rad_s2", "_m_s2", "_n", "_n_m", "_j", "_kg_m2_s")
    names = {name for name, *_ in ERROR_COLUMNS}
    other = {name for name, of, *_ in ERROR_COLUMNS if of in named("force", "free", "elastic")}
    assert all(name.endswith(units) for name in names)
    assert names - other == names & set(frame.columns)
    pure = {f"{name.replace('-', '_')}_pure" for name in DEFAULTS if name not in FORCES}
    assert pure <= set(frame.columns)
    assert pd.isna(frame["angular_acceleration_error_rad_s2"][0])
    for name in ("displacement_error_m", "slider_speed_error_m_s", "pin_gap_m", "drive_error_rad"):
        assert frame[name][0] >= 0.0


def test_a_scene_is_prepared_and_solved_once_for_instants(monkeypatch: pytest.MonkeyPatch) -> None:
    """For the log of each engine, for its logged crank, and for velocities that belong to other
    instants; two more would be one for each finer run. The state at the start, the same for all,
    is a solution of one instant."""
    counts: Counter[object] = Counter()
    analyse, motion = prepared.analyse, prepared.Prepared.motion

    def analysed(scene: Scene) -> object:
        counts["prepared"] += 1
        return analyse(scene)

    def moved(ready: object, names: object, time_s: Array, *args: object, **bound: bool) -> Motion:
        counts[len(time_s)] += 1
        return motion(ready, names, time_s, *args, **bound)

    monkeypatch.setattr(prepared, "analyse", analysed)
    monkeypatch.setattr(prepared.Prepared, "motion", moved)
    scene = load_scene("fourbar-lecture-1")
    for engine in ("pymunk", "mujoco"):
        assert not check(of_turns(scene, engine, 720, converge=True)).convergence.faults
    assert counts == {"prepared": 1, 1: 1, 721: 4}
