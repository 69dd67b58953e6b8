"""Lines of a store: which one stands where there are several, and in which order."""

from __future__ import annotations

import math

import pytest

from reports.results.lines import lines
from reports.results.one_processor import left_out, machine
from tests.reports.results.made import PERIOD_S, cell, stored, table, untimed

STUDY = {
    "scenes": ["b", "a"],
    "variants": [
        {"engine": "pymunk", "profile": "tuned"},
        {"engine": "mujoco", "profile": "tuned", "settings": {"iterations": [1, 2]}},
    ],
    "steps_per_turn": [90],
}


def test_a_line_is_fitted_from_coarse_to_fine() -> None:
    steps = (360, 90, 720, 180)  # as they come out of a pool
    (line,) = lines(stored(cell("a", "x", n, 1e-3 * (90 / n) ** 2, 1.0) for n in steps))
    assert list(line.cells["steps_per_turn"]) == [90, 180, 360, 720]
    assert line.fit.order == pytest.approx(2.0, abs=1e-6)
    assert line.words == "order 2.0, no floor seen"
    assert line.period_s == pytest.approx(PERIOD_S)
    assert line.settings == {"name": "x"}


def test_a_line_of_another_quantity_is_that_of_its_column() -> None:
    rows = [cell("a", "x", n, 1e-9, 1.0, pin_gap_m=7e-4) for n in (90, 180, 360, 720, 1440)]
    (line,) = lines(stored(rows), "pin_gap_m")
    assert line.words == "converges to the wrong answer: floor 7.0e-4 m"
    assert line.fit.floor == pytest.approx(7e-4)


def test_a_crank_that_rounds_hides_what_is_behind_it() -> None:
    """Errors of the size that the crank's own rounding explains follow no order."""
    for drive, kind in ((1e-10, "at rounding"), (1e-5, "floor")):
        rows = [cell("a", "x", n, 4e-10, 1.0, drive_pure=drive) for n in (90, 180, 360, 720)]
        (line,) = lines(stored(rows))
        assert line.fit.kind == kind


def test_the_newest_version_stands_however_it_is_spelled_on_each_scene_by_itself() -> None:
    made = ("a", "4.0.0"), ("a", "4.0.10"), ("a", "4.0.9"), ("b", "4.0.0")
    rows = [cell(scene, "x", 90, 1e-3, 1.0, version=version) for scene, version in made]
    found = [(line.scene, line.version) for line in lines(stored(rows))]
    assert found == [("a", "4.0.10"), ("b", "4.0.0")]


def test_of_two_lines_of_one_version_the_later_stands() -> None:
    rows = [cell("a", "x", 90, 1e-3, 1.0, asked={"iterations": n}) for n in (9, 3)]
    assert [line.settings for line in lines(stored(rows))] == [{"iterations": 3}]


def test_lines_come_in_the_order_of_the_study() -> None:
    names = [("mujoco", "tuned, iterations=2"), ("mujoco", "tuned, iterations=1")]
    rows = [
        cell(scene, variant, 90, 1e-3, 1.0, engine=engine)
        for engine, variant in [*names, ("pymunk", "tuned"), ("pymunk", "other")]
        for scene in ("c", "a", "b")
    ]
    found = lines(stored(rows, scenes=("b", "a"), runs=({"study": STUDY}, {"study": {"old": 1}})))
    assert [line.scene for line in found] == ["b"] * 4 + ["a"] * 4 + ["c"] * 4
    in_order = [("pymunk", "tuned"), *reversed(names), ("pymunk", "other")]
    assert [(line.engine, line.variant) for line in found[:4]] == in_order


def test_times_of_two_machines_are_never_compared() -> None:
    store = stored([
        *table("a x 90 1e-3 1", processor="abacus", made="2026-01-01"),
        *table("a x 180 1e-3 2", processor="loom", made="2026-02-01"),
        *map(untimed, table("a x 360 1e-3 9")),
        *table("a x 720 1e-3 4", processor="abacus", made="2026-01-09"),
    ])  # fmt: skip
    assert machine(store.cells) == "loom"
    assert left_out(store.cells) == ("abacus",)
    (line,) = lines(store)
    for column in ("us_per_step", "us_per_step_median", "us_per_step_a", "s_per_turn"):
        known = [not math.isnan(value) for value in line.cells[column]]
        assert known == [False, True, False, False]


def test_a_store_that_was_never_timed_has_lines_all_the_same() -> None:
    row = cell("a", "x", 90, 1e-3, math.nan)
    times = ("processor", "made", "s_per_turn", "us_per_step_a", "us_per_step_b")
    store = stored([{name: value for name, value in row.items() if name not in times}])
    assert machine(store.cells) is None
    assert left_out(store.cells) == ()
    (line,) = lines(store)
    assert math.isnan(line.cells["s_per_turn"].iloc[0])
