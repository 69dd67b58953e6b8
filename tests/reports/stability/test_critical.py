"""The value up to which a case is held: the first that is not, from the easy end, closed in on."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import pytest

from models.files import load_scene
from reports.stability.case import Case, Trial
from reports.stability.critical import critical, line
from reports.stability.matrix import Critical, Graded, Outcome, label


def case(
    values: tuple[float, ...], scale: str = "log", good: tuple[Outcome, ...] = ("ok",)
) -> Case:
    words = dict.fromkeys(("group", "title", "source", "truth", "expected"), "words")
    return Case(
        name="made-up",
        parameter="margin",
        unit="m",
        values=values,
        trial=lambda _: Trial(load_scene("fourbar-lecture-1")),
        scale=scale,  # type: ignore[arg-type]
        good=good,
        **words,
    )


def held(given: Case, good: Callable[[float], bool]) -> tuple[Critical, list[Graded]]:
    """The runs of an engine that holds some values, and is off its branch at the others."""

    def grade(value: float, grid: bool) -> Graded:
        ending: Outcome = "ok" if good(value) else "branch-changed"
        return Graded(
            given.name, "mujoco", "tuned", value, label(value), ending, "", error=1e-3, grid=grid
        )

    runs = list(line(given, grade))
    return critical(given, runs), runs


@pytest.mark.parametrize(
    ("values", "scale", "at"),
    [
        ((1e-2, 1e-3, 1e-4, 1e-5), "log", 3.3e-4),
        ((1.0, 1e3, 1e6), "log", 3.3e4),
        ((0.0, 30.0, 90.0, 180.0), "linear", 71.0),
    ],
)
def test_bisection_closes_in_on_the_value_at_which_it_breaks(
    values: tuple[float, ...], scale: str, at: float
) -> None:
    falling = values[-1] < values[0]
    found, runs = held(case(values, scale), lambda v: v >= at if falling else v <= at)
    low, high = sorted((found.holds, found.fails))
    assert low <= at <= high
    near = 0.06 * max(values) if scale == "linear" else 0.1 * at
    assert high - low <= near
    assert found.outcome == "branch-changed"
    assert ("down to" if falling else "up to") in found.words
    assert [run.value for run in runs if run.grid] == list(values)


def test_whole_numbers_are_told_apart_one_by_one() -> None:
    found, runs = held(case((100.0, 10.0, 1.0), "whole"), lambda v: v >= 7)
    assert (found.holds, found.fails) == (7.0, 6.0)
    assert all(run.value == round(run.value) for run in runs)


def test_the_command_repeats_the_value_as_it_is_told() -> None:
    found, runs = held(case((1e-2, 1e-4)), lambda v: v >= 7.77e-4)
    told = found.command.rpartition(" ")[2]
    assert float(told) == found.fails
    assert all(float(run.label) == run.value for run in runs)
    assert found.command.startswith("crankcheck stability made-up --engine mujoco --profile tuned")


def test_a_line_that_holds_everywhere_is_not_bisected() -> None:
    found, runs = held(case((1.0, 0.1)), lambda _: True)
    assert len(runs) == 2
    assert (found.holds, math.isnan(found.fails)) == (0.1, True)
    assert "holds all" in found.words


def test_a_line_that_holds_nowhere_says_so() -> None:
    found, runs = held(case((1.0, 0.1)), lambda _: False)
    assert len(runs) == 2
    assert math.isnan(found.holds)
    assert found.fails == 1.0
    assert found.words == "branch-changed at once"


def test_only_the_values_before_the_first_failure_count_as_held() -> None:
    found, _ = held(case((8.0, 4.0, 2.0, 1.0)), lambda v: v not in (4.0,) and v != 5.66)
    assert found.fails >= 4.0
    assert found.holds > found.fails


def test_a_line_that_fails_at_the_easiest_value_alone_says_that_others_hold() -> None:
    found, _ = held(case((8.0, 4.0, 2.0)), lambda v: v != 8.0)
    assert math.isnan(found.holds)
    assert found.words == "branch-changed at 8, holds 2 of 3"


def test_a_line_that_holds_tells_its_worst_error_wherever_it_is() -> None:
    given = case((1.0, 0.1, 0.01))
    _, runs = held(given, lambda _: True)
    uneven = [replace(run, error=e) for run, e in zip(runs, (1e-4, 7e-3, 1e-5), strict=True)]
    assert "error up to 7e-03" in critical(given, uneven).words


def test_a_value_of_0_ends_the_search_where_the_grid_does() -> None:
    found, runs = held(case((1.0, 1e-3, 0.0)), lambda v: v > 0.0)
    assert len(runs) == 3
    assert (found.holds, found.fails) == (1e-3, 0.0)


def test_a_good_end_is_the_one_that_the_case_names() -> None:
    given = case((1.0, 0.1), good=("branch-changed",))
    found, _ = held(given, lambda v: v < 0.5)
    assert found.holds == pytest.approx(0.5, rel=0.05)
    assert found.fails < 0.5 <= found.holds
    assert found.outcome == "ok"
