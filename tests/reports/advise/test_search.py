"""The search for the fewest sub-steps, on errors whose law is known; its runs and their prices."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, cast, get_args

import numpy as np
import pytest

from models.files.reading import load_scene
from reports.advise.advice import ROUNDS, Prices, prices, timings
from reports.advise.demand import Choice, MeasuredSteps, MeasuredStudy, choices, demanded
from reports.advise.search import WORDS, SearchResult, TriedRun, Worst, _reached, _seen, look
from reports.compare.compare import Truth, compare
from reports.compare.errors import Departure
from reports.judge.cell import Cell
from reports.quantities import named
from reports.stability.error_series import ErrorSeries
from reports.sweep.measured import Repeats
from reports.workers.isolated import Isolated, Lost
from sim.engine import Status
from sim.run import run

DEMAND = demanded(
    [load_scene("fourbar-lecture-1"), load_scene("slider-crank-central")], 10.0, 1 / 60, 1e-3, 10.0
)
FIRST, SECOND = (scene.name for scene in DEMAND.scenes)
FRAMES = DEMAND.frames_per_turn
NOTHING = MeasuredStudy()
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
    law: Law, known: MeasuredStudy = NOTHING, **changes: Any
) -> tuple[SearchResult, Child]:
    demand = replace(DEMAND, **changes)
    child = Child(law, demand.frame_s)
    isolated = cast("Isolated[TriedRun]", child)
    return _reached(demand, known, isolated, CHOICE), child


def studied(law: Callable[[str, float], float]) -> MeasuredStudy:
    """A study of both scenes, from one step in a frame to 400."""
    steps = [FRAMES * 400 ** (k / 8) for k in range(9)]
    measured = {
        (name, CHOICE.key): MeasuredSteps(tuple((n, law(name, n)) for n in steps))
        for name in (FIRST, SECOND)
    }
    return MeasuredStudy(measured=measured)


def second_order(exact: float) -> Callable[[str, float], float]:
    """The second scene is the worse one, and reaches the target with so many."""
    return lambda name, n: (1.0 if name == SECOND else 0.2) * 1e-3 * (exact / n) ** 2


@pytest.mark.parametrize("exact", [0.5, 1.0, 4.5, 60.0])
def test_finds_the_fewest_sub_steps_of_the_worst_scene(exact: float) -> None:
    found, child = searched(second_order(exact))
    assert found.promise.substeps == max(1, math.ceil(exact))
    assert found.promise.scene == SECOND
    assert found.promise.error <= DEMAND.target
    assert found.at_frame.error == pytest.approx(1e-3 * exact**2)
    assert found.nearest is None
    assert len(child.asked) == found.runs < 30


def test_all_scenes_are_run_for_a_promise_and_else_the_worst_alone() -> None:
    found, child = searched(second_order(4.0))
    assert found.promise is not None
    ran = {(name, n) for name, n, _ in child.asked}
    for n in (1, 4, *found.held_at):
        assert {(FIRST, n), (SECOND, n)} <= ran
    assert {6, 8} <= set(found.held_at)
    _, child = searched(second_order(30.0))
    assert not [n for name, n, _ in child.asked if name == FIRST and 1 < n < 30]


def test_luck_is_no_promise_nor_what_breaks_later_and_else_the_nearest_is_told() -> None:
    """Two errors cancel with 3 sub-steps."""
    found, _ = searched(lambda _, n: 1e-5 if n == 3 else 1e-3 * (8.0 / n) ** 2)
    assert found.promise.substeps == 8
    breaks = TriedRun(math.inf, "diverged", "")
    found, _ = searched(lambda _, n: breaks if n > 9 else 1e-3 * 7.0 / n)
    assert found.promise is None
    assert found.unsteady
    assert max(found.unsteady) <= 9
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
        long = child.asked[-1][2] > 11.0
        return TriedRun((3e-3 if long else 1e-3) * 2.0 / n, growth=1.0 if long else 1.3)

    child = Child(law)
    found = _reached(DEMAND, NOTHING, cast("Isolated[TriedRun]", child), CHOICE)
    assert found.promise.substeps == 6
    assert any(turns == pytest.approx(80.0, rel=0.01) for _, _, turns in child.asked)


def test_a_run_that_no_step_mends_is_the_last_and_one_that_comes_apart_is_not() -> None:
    for end, status in (
        (Lost("timeout", "no end within 30 s"), "timeout"),
        (TriedRun(math.inf, "unsupported", "no such pin"), "unsupported"),
    ):
        found, child = searched(lambda _, n, end=end: end)
        assert len(child.asked) == 1
        assert (found.ended.status, found.ended.reason) == (status, end.reason)
        assert found.at_frame is not None
        assert (found.promise, found.nearest, found.held_at) == (None, None, ())
    apart = TriedRun(math.inf, "diverged", "came apart")
    found, _ = searched(lambda _, n: apart if n < 5 else 1e-3 * (6.0 / n) ** 2)
    assert found.at_frame.seen.status == "diverged"
    assert found.promise.substeps == 6


def test_what_a_study_covers_is_not_run_but_its_promise_is_and_else_it_is_left() -> None:
    law = second_order(4.9)
    found, child = searched(law, studied(lambda name, n: law(name, n / FRAMES)))
    assert found.promise.substeps == 5
    assert not found.promise.seen.studied
    assert {(name, n) for name, n, _ in child.asked} == {(FIRST, 5), (SECOND, 5)}
    assert found.runs == 2
    assert found.at_frame.seen.studied
    found, child = searched(second_order(5.0), studied(lambda name, n: 1e-4))
    assert found.promise.substeps == 5
    assert not found.at_frame.seen.studied
    assert {n >= 6 for _, n, _ in child.asked} == {True, False}


FAST = demanded([load_scene("slider-crank-central")], 50.0, 0.002, 1e-3, 4.0)


def series(place: np.ndarray, turns: float = 4.0) -> ErrorSeries:
    time_s, none = np.linspace(0.0, turns, place.size), np.zeros_like(place)
    return ErrorSeries("ok", "", time_s, time_s, place, none, none, none, 1.0, 1.0)


@pytest.mark.parametrize("choice", choices(["mujoco", "pymunk"], ()), ids=lambda each: each.label)
def test_the_error_of_a_run_is_that_of_a_comparison(choice: Choice) -> None:
    (scene,) = FAST.scenes
    cell, truth = FAST.cell(scene, choice, 2), Truth(scene)
    options = {"dt_s": cell.dt_s, "steps": cell.steps, "settings": choice.settings}
    done = run(scene, truth.start, choice.engine, choice.profile, **options)
    errors = compare(truth.beside(done))
    places = [worst.pure for name in named("place") if (worst := errors.worst(name))]
    assert look(cell).error == pytest.approx(max(places), rel=1e-9)


def test_an_error_that_grows_is_seen_and_what_did_not_end_well_has_none() -> None:
    turn = np.linspace(0.0, 4.0, 401)
    steady = _seen(series(1e-3 * np.abs(np.sin(math.tau * turn))))
    assert (steady.error, steady.grows) == (pytest.approx(1e-3), False)
    creeps = _seen(series(1e-3 * turn))
    assert (creeps.error, creeps.grows) == (pytest.approx(4e-3), True)
    assert creeps.growth == pytest.approx(2.0, rel=0.02)
    only = _seen(series(np.linspace(0.0, 1.0, 50), turns=1.0))  # a single turn tells none
    assert math.isnan(only.growth)
    assert not only.grows
    for change, status in (
        ({"status": "diverged", "reason": "came apart"}, "diverged"),
        ({"departure": Departure("rod", 0.1, 0.2)}, "branch-changed"),
        ({"incomplete": "3 samples, not the 4"}, "crashed"),
    ):
        found = _seen(replace(series(np.zeros(9)), **change))  # type: ignore[arg-type]
        assert (found.error, found.status) == (math.inf, status)
        assert found.reason
    wrong = Choice("mujoco", "tuned", "tuned", {"close": "nowhere"})
    found = look(FAST.cell(FAST.scenes[0], wrong, 1))
    assert (found.error, found.status) == (math.inf, "unsupported")
    assert "nowhere" in found.reason
    assert {*WORDS, "ok"} == {*get_args(Status)}


def promised(name: str, substeps: int | None) -> SearchResult:
    promise = Worst(substeps, FIRST, TriedRun(5e-4)) if substeps else None
    return SearchResult(Choice("fake", name, "tuned", {}), None, promise, None)


def priced(
    taken: Sequence[tuple[Repeats, Repeats] | None], *found: SearchResult
) -> tuple[Prices, list[Cell]]:
    """Prices where cells take so many microseconds, and the cells that were timed."""
    asked: list[Cell] = []

    def timed(_: object, cells: Sequence[tuple[Cell, float]], rounds: int, *__: object) -> object:
        assert rounds == ROUNDS
        asked.extend(cell for cell, _ in cells)
        return taken

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("reports.advise.advice.timed_in_turns", timed)
        return prices(DEMAND, found), asked


def test_the_dearest_scene_counts_and_the_noise_is_how_far_two_halves_lie_apart() -> None:
    every = [promised("a", 4), promised("none", None), promised("b", 1)]
    taken = [((3.0, 9.0), (2.0, 8.0)), ((5.0,), (4.0,)), ((1.0,), (1.0,)), ((1.5,), (1.5,))]
    found, asked = priced(taken, *every)
    first, none, last = found.each
    assert (first.scene, first.us_per_step) == (SECOND, 4.0)
    assert first.s_per_s == pytest.approx(4e-6 * 4 / DEMAND.frame_s)
    assert none is None
    assert last.s_per_s == pytest.approx(1.5e-6 / DEMAND.frame_s)
    assert [(cell.scene.name, cell.dt_s, cell.profile) for cell in asked] == [
        (name, DEMAND.frame_s / n, "tuned") for n in (4, 1) for name in (FIRST, SECOND)
    ]
    assert timings(DEMAND, every) == ROUNDS * 4
    half = ((2.0,), (2.2,))
    assert priced([half, half], promised("a", 1))[0].noise == pytest.approx(0.1)
    assert priced([half, None], promised("a", 1))[0].each == (None,)
    nothing, _ = priced([], promised("none", None))
    assert nothing.each == (None,)
    assert math.isnan(nothing.noise)
