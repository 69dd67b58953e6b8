"""The search for the fewest sub-steps, on errors whose law is known."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any, cast

import pytest

from models.files import load_scene
from reports.advise.choices import Choice
from reports.advise.demand import demanded
from reports.advise.evidence import MeasuredSteps, MeasuredStudy
from reports.advise.look import TriedRun
from reports.advise.search import SearchResult, _reached
from reports.judge.cell import Cell
from reports.workers.isolated import Isolated, Lost

DEMAND = demanded(
    [load_scene("fourbar-lecture-1"), load_scene("slider-crank-central")], 10.0, 1 / 60, 1e-3, 10.0
)
FIRST, SECOND = (scene.name for scene in DEMAND.scenes)
CHOICE = Choice("fake", "tuned", "tuned", {})
Law = Callable[[str, int], TriedRun | Lost | float]
"""From scene and sub-steps to what a run gives."""


@dataclass
class Child:
    """What stands for the process that runs cells; keeps scene, sub-steps and turns of each."""

    law: Law
    frame_s: float = DEMAND.frame_s
    asked: list[tuple[str, int, float]] = field(default_factory=list)

    def call(self, function: object, cell: Cell) -> TriedRun | Lost:
        substeps = round(self.frame_s / cell.dt_s)
        self.asked.append((cell.scene.name, substeps, cell.turns))
        found = self.law(cell.scene.name, substeps)
        return TriedRun(found) if isinstance(found, float) else found


def searched(
    law: Law, known: MeasuredStudy | None = None, **changes: Any
) -> tuple[SearchResult, Child]:
    demand = replace(DEMAND, **changes)
    child = Child(law, demand.frame_s)
    isolated = cast("Isolated[TriedRun]", child)
    return _reached(demand, known or MeasuredStudy(), isolated, CHOICE), child


def studied(law: Callable[[str, float], float], low: float, high: float) -> MeasuredStudy:
    """A study of both scenes, from so many steps in a turn to so many."""
    steps = [low * (high / low) ** (k / 8) for k in range(9)]
    measured = {
        (name, CHOICE.key): MeasuredSteps(tuple((n, law(name, n)) for n in steps))
        for name in (FIRST, SECOND)
    }
    return MeasuredStudy(measured=measured)


def second_order(exact: float) -> Callable[[str, float], float]:
    """The second scene is the worse one, and reaches the target with so many."""
    return lambda name, n: (1.0 if name == SECOND else 0.2) * 1e-3 * (exact / n) ** 2


@pytest.mark.parametrize("exact", [0.5, 1.0, 3.0, 4.5, 7.0, 60.0])
def test_finds_the_fewest_sub_steps_of_the_worst_scene(exact: float) -> None:
    found, child = searched(second_order(exact))
    assert found.promise.substeps == max(1, math.ceil(exact))
    assert found.promise.scene == SECOND
    assert found.promise.error <= DEMAND.target
    assert found.at_frame.error == pytest.approx(1e-3 * exact**2)
    assert found.nearest is None
    assert len(child.asked) == found.runs < 30


def test_all_scenes_are_run_for_a_promise_and_at_larger_numbers_too() -> None:
    found, child = searched(second_order(4.0))
    assert found.promise is not None
    ran = {(name, n) for name, n, _ in child.asked}
    for n in (1, 4, *found.held_at):
        assert {(FIRST, n), (SECOND, n)} <= ran
    assert {6, 8} <= set(found.held_at)


def test_a_scene_that_is_over_the_target_spares_the_runs_of_the_others() -> None:
    _, child = searched(second_order(30.0))
    over = [n for name, n, _ in child.asked if name == FIRST and 1 < n < 30]
    assert over == []


def test_luck_is_no_promise() -> None:
    """Two errors that cancel with 3 sub-steps."""
    found, _ = searched(lambda _, n: 1e-5 if n == 3 else 1e-3 * (8.0 / n) ** 2)
    assert found.promise.substeps == 8


def test_settings_that_break_with_more_sub_steps_promise_nothing() -> None:
    found, _ = searched(
        lambda _, n: TriedRun(math.inf, "diverged", "") if n > 9 else 1e-3 * 7.0 / n
    )
    assert found.promise is None
    assert found.unsteady
    assert max(found.unsteady) <= 9


def test_where_nothing_reaches_the_nearest_is_told_for_all_scenes() -> None:
    found, child = searched(lambda name, n: 2e-3 + 1e-2 / n**2 + (name == FIRST) * 1e-4)
    assert found.promise is None
    assert found.nearest.error == pytest.approx(2.1e-3, rel=0.1)
    n = found.nearest.substeps
    assert {(FIRST, n), (SECOND, n)} <= {(name, each) for name, each, _ in child.asked}
    assert max(n for _, n, _ in child.asked) < DEMAND.most


def test_too_coarse_a_frame_is_not_run_and_sub_steps_mend_it() -> None:
    found, child = searched(second_order(2.0), frame_s=1 / 6)
    assert found.at_frame is None
    assert found.promise.substeps == replace(DEMAND, frame_s=1 / 6).least == 3
    assert min(n for _, n, _ in child.asked) == 3


def test_an_error_that_grows_has_to_stay_under_the_target_for_longer() -> None:
    """With 2 and 3 it does over ten turns, and not over eighty."""

    def law(name: str, n: int) -> TriedRun:
        long = child_turns() > 11.0
        return TriedRun((3e-3 if long else 1e-3) * 2.0 / n, growth=1.0 if long else 1.3)

    child = Child(law)

    def child_turns() -> float:
        return child.asked[-1][2]

    found = _reached(DEMAND, MeasuredStudy(), cast("Isolated[TriedRun]", child), CHOICE)
    assert found.promise.substeps == 6
    assert any(turns == pytest.approx(80.0, rel=0.01) for _, _, turns in child.asked)


@pytest.mark.parametrize(
    ("end", "status"),
    [
        (Lost("timeout", "no end within 30 s"), "timeout"),
        (Lost("crashed", "the engine ended its process"), "crashed"),
        (TriedRun(math.inf, "unsupported", "no such pin"), "unsupported"),
    ],
)
def test_a_run_that_no_step_mends_is_the_last(end: TriedRun | Lost, status: str) -> None:
    found, child = searched(lambda _, n: end)
    assert len(child.asked) == 1
    assert found.ended.status == status
    assert found.ended.reason
    assert (found.promise, found.nearest, found.held_at) == (None, None, ())
    assert found.at_frame is not None


def test_a_run_that_comes_apart_at_the_frame_is_not() -> None:
    found, _ = searched(
        lambda _, n: (
            TriedRun(math.inf, "diverged", "came apart") if n < 5 else 1e-3 * (6.0 / n) ** 2
        )
    )
    assert found.at_frame.seen.status == "diverged"
    assert found.promise.substeps == 6


def test_what_a_study_covers_is_not_run_but_its_promise_is() -> None:
    law = second_order(4.9)
    steps = DEMAND.frames_per_turn
    known = studied(lambda name, n: law(name, n / steps), steps, 400 * steps)
    found, child = searched(law, known)
    assert found.promise.substeps == 5
    assert not found.promise.seen.studied
    assert {(name, n) for name, n, _ in child.asked} == {(FIRST, 5), (SECOND, 5)}
    assert found.runs == 2
    assert found.at_frame.seen.studied


def test_a_study_that_says_otherwise_than_a_run_is_left() -> None:
    steps = DEMAND.frames_per_turn
    known = studied(lambda name, n: 1e-4, steps, 400 * steps)
    found, child = searched(second_order(5.0), known)
    assert found.promise.substeps == 5
    assert not found.at_frame.seen.studied
    assert {n >= 6 for _, n, _ in child.asked} == {True, False}


def test_what_a_study_lacks_is_run() -> None:
    """Of one scene it has nothing, and of the other nothing at the frame itself."""
    law = second_order(4.9)
    steps = DEMAND.frames_per_turn
    whole = studied(lambda name, n: law(name, n / steps), 2 * steps, 400 * steps)
    known = replace(
        whole, measured={key: each for key, each in whole.measured.items() if key[0] == SECOND}
    )
    found, child = searched(law, known)
    assert found.promise.substeps == 5
    assert {n for name, n, _ in child.asked if name == SECOND} == {1, 5}
