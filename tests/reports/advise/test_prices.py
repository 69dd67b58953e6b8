"""What promises take: the dearest scene counts, and a lost process costs a price."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import pytest

from models.files import load_scene
from reports.advise.choices import Choice
from reports.advise.demand import demanded
from reports.advise.look import TriedRun
from reports.advise.prices import ROUNDS, prices, timings
from reports.advise.search import SearchResult, Worst
from reports.judge.cell import Cell
from reports.sweep.measured import Repeats

DEMAND = demanded(
    [load_scene("fourbar-lecture-1"), load_scene("slider-crank-central")], 10.0, 0.02, 1e-3, 10.0
)
FIRST, SECOND = (scene.name for scene in DEMAND.scenes)
Timed = Sequence[tuple[Repeats, Repeats] | None]


def found(name: str, substeps: int | None) -> SearchResult:
    promise = Worst(substeps, FIRST, TriedRun(5e-4)) if substeps else None
    return SearchResult(Choice("fake", name, "tuned", {}), None, promise, None)


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Callable[[Timed], list[Cell]]:
    """Sets what the cells take [microseconds]; gives those that were timed."""

    def stop_at(taken: Timed) -> list[Cell]:
        asked: list[Cell] = []

        def timed(
            _: object, cells: Sequence[tuple[Cell, float]], rounds: int, *__: object
        ) -> Timed:
            assert rounds == ROUNDS
            asked.extend(cell for cell, _ in cells)
            return taken

        monkeypatch.setattr("reports.advise.prices.timed_in_turns", timed)
        return asked

    return stop_at


def test_the_dearest_scene_counts_at_the_step_of_the_promise(
    clock: Callable[[Timed], list[Cell]],
) -> None:
    asked = clock([((3.0, 9.0), (2.0, 8.0)), ((5.0,), (4.0,)), ((1.0,), (1.0,)), ((1.5,), (1.5,))])
    every = [found("a", 4), found("none", None), found("b", 1)]
    priced = prices(DEMAND, every)
    first, none, last = priced.each
    assert (first.scene, first.us_per_step) == (SECOND, 4.0)
    assert first.s_per_s == pytest.approx(4e-6 * 4 / 0.02)
    assert none is None
    assert last.s_per_s == pytest.approx(1.5e-6 / 0.02)
    assert [(cell.scene.name, cell.dt_s, cell.profile) for cell in asked] == [
        (name, dt, "tuned") for dt in (0.005, 0.02) for name in (FIRST, SECOND)
    ]
    assert timings(DEMAND, every) == ROUNDS * 4


def test_the_noise_is_how_far_the_two_halves_lie_apart(
    clock: Callable[[Timed], list[Cell]],
) -> None:
    clock([((2.0,), (2.2,)), ((2.0,), (2.2,))])
    assert prices(DEMAND, [found("a", 1)]).noise == pytest.approx(0.1)


def test_where_a_scene_was_lost_there_is_no_price(clock: Callable[[Timed], list[Cell]]) -> None:
    clock([((2.0,), (2.0,)), None])
    priced = prices(DEMAND, [found("a", 1)])
    assert priced.each == (None,)


def test_of_nothing_there_is_no_noise(clock: Callable[[Timed], list[Cell]]) -> None:
    clock([])
    priced = prices(DEMAND, [found("none", None)])
    assert priced.each == (None,)
    assert math.isnan(priced.noise)
