"""Which lines of a store stand, and in which order; which settings are recommended, and what is
said where none are; noise, time to a target, fronts and profiles on errors and costs that are
known."""

import math
import re
from collections.abc import Sequence
from dataclasses import replace
from io import StringIO

import pandas as pd
import pytest
from rich.console import Console

from models.files.reading import load_scene
from reports.judge.cell import Cell
from reports.results import candidates
from reports.results.lines import Line, left_out, lines, machine
from reports.results.recommend import (
    Recommendation,
    noise_line,
    recommendation_table,
    recommendations,
)
from reports.sweep.measured import timed
from tests.reports.results.made import PERIOD_S, Row, cell, stored, table, untimed

BELOW, ABOVE = 1e-3, math.nextafter(1e-3, 1.0)
"""The target, which it is enough to equal, and an error that is as little above it as can be."""


def of(text: str, *rows: Row, **other: object) -> Recommendation:
    """The one recommendation of a store with one engine: cells of a table, and others."""
    (found,) = recommendations(stored([*table(text, **other), *rows]), [BELOW])
    return found


def variant(found: Recommendation) -> str | None:
    return None if found.reason else found.best.variant


def test_the_cheapest_that_reaches_the_target_on_every_scene_is_chosen() -> None:
    found = of(
        "a cheap 90 5e-4 1, b cheap 90 2e-3 1, a good 90 5e-4 4, b good 90 9e-4 9,"
        "a dear 90 1e-4 9, b dear 90 1e-4 9"
    )
    assert variant(found) == "good"
    best = found.best
    assert (best.steps_per_turn, best.settings) == (90, {"name": "good"})
    assert (best.worst_error, best.worst_scene, best.scenes) == (9e-4, "b", 2)
    assert best.us_per_step == pytest.approx(6.0)  # the geometric mean of 4 and 9
    assert best.s_per_turn == pytest.approx(6e-6 * 90)


X, Y = "a x 90 1e-4 1", "a y 90 1e-4 7, b y 90 1e-4 7"


@pytest.mark.parametrize(
    ("text", "chosen"),
    [
        ("a euler 90 4e-3 1, a euler 900 4e-4 1, a rk4 90 1e-4 4", "rk4 at 90"),
        (f"a x 90 {BELOW} 1", "x at 90"),
        (f"{X}, {Y}", "y at 90"),
        ("a soft 90 5e-3 1, a soft 180 4e-4 1, a soft 360 2e-3 1", "soft at 180"),
        (f"{X}, b x 90 1e-4 1, a x 180 1e-5 1", "x at 90"),
    ],
    ids=["fewer steps at a dear step", "the target itself", "a cell is missing", "a dip",
         "a finer step not run everywhere"],
)  # fmt: skip
def test_what_is_chosen(text: str, chosen: str) -> None:
    found = of(text)
    assert f"{variant(found)} at {found.best.steps_per_turn:g}" == chosen
    # Errors of two kinds may cancel at one step: a dip is no steady promise.
    assert found.caution == ("not at 360 steps a turn: a 2.0e-3" if "soft" in text else "")
    assert found.steadier is None


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        (f"a x 90 {ABOVE} 1", "nearest is x at 90 steps a turn: on no scene, 1.0e-3 on a at best"),
        (f"{X}, b y 90 1 7", "nearest is x at 90 steps a turn: on 1 of 2 scenes; b not run"),
        ("a z 180 2e-3 1, b z 180 2e-3 1",
         "nearest is z at 180 steps a turn: on no scene, 2.0e-3 on a at best"),
        ("a x 90 nan 1", "nearest is x at 90 steps a turn: on 0 of 1 scenes; a error is no number"),
    ],
)  # fmt: skip
def test_what_comes_nearest_is_named_where_nothing_does(text: str, reason: str) -> None:
    assert of(text).reason == reason


def test_a_cell_that_did_not_end_well_or_has_other_settings_disqualifies() -> None:
    failed = cell("b", "x", 90, 1e-4, 1.0, status="timeout")
    other = cell("b", "x", 90, 1e-4, 1.0, asked={"iterations": 20})  # by another study
    for bad, told in ((failed, "timeout"), (other, "not run")):
        assert variant(of(f"{X}, {Y}", bad)) == "y"
        assert of(X, bad).reason == (f"nearest is x at 90 steps a turn: on 1 of 2 scenes; b {told}")


def test_what_comes_nearest_is_that_which_is_enough_on_the_most_scenes() -> None:
    text = "a x 90 5e-4 1, b x 90 5e-1 1, a y 180 5e-4 1, b y 180 4e-3 1"
    found = of(f"{text}, a z 180 2e-3 1, b z 180 2e-3 1")
    assert variant(found) is None
    assert (found.best.variant, found.best.steps_per_turn) == ("y", 180)
    assert (found.best.worst_error, found.best.worst_scene) == (4e-3, "b")
    assert found.reason == "nearest is y at 180 steps a turn: on 1 of 2 scenes; b 4.0e-3"
    assert found.snippet() == ""
    assert of("a x 90 nan 1").best.worst_scene is None


def test_settings_without_a_cost_on_every_scene_are_said_to_be_so_or_left() -> None:
    none, partly = (untimed(cell(scene, "x", 90, 1e-4, 1.0)) for scene in "ab")
    (found,) = recommendations(stored([none]), [BELOW])
    assert variant(found) is None
    assert found.reason.startswith("x would do, but costs of some scenes are unknown")
    assert variant(of("a y 90 1e-4 9", none)) == "y"
    assert variant(of(f"{X}, {Y}", partly)) == "y"


def test_costs_inside_the_noise_are_equal_and_the_more_accurate_is_chosen() -> None:
    text = "a fast 90 9e-4 10, a exact 90 1e-4 10.4, a slow 90 1e-5 10.9"
    found = of(text, us_per_step_a=10.0, us_per_step_b=10.5)  # 5 % between two of the same
    assert variant(found) == "exact"
    # Equal to what is chosen, if not to each other.
    assert found.equal_to == ("fast at 90 steps a turn", "slow at 90 steps a turn")
    quiet = of(text, us_per_step_a=10.0, us_per_step_b=10.0)
    assert (variant(quiet), quiet.equal_to) == ("fast", ())
    # However noisy the clock is, a shorter step of the same settings is dearer.
    text = "a x 90 9e-4 11, a x 180 1e-4 10, a x 360 1e-5 4"
    noisy = of(text, us_per_step_a=10.0, us_per_step_b=25.0)
    assert (noisy.best.steps_per_turn, noisy.equal_to) == (90, ())


def test_a_promise_that_a_finer_step_breaks_comes_with_caution_and_a_steadier_choice() -> None:
    found = of(
        "a wild 90 9e-4 1, a wild 180 2e-4 1, a steady 90 9e-4 3, a steady 720 1e-5 3",
        *table("a wild 360 9 1, a wild 720 9 1", status="diverged"),
    )
    assert variant(found) == "wild"
    assert found.caution == "not at 360 steps a turn: a diverged"
    assert (found.steadier.best.variant, found.steadier.best.steps_per_turn) == ("steady", 90)
    assert "Caution" not in found.steadier.snippet()
    assert "Caution: not at 360" in found.snippet()


def test_the_step_on_the_fit_lies_between_measured_ones_and_is_not_extrapolated() -> None:
    """Second order: 1e-3 at 100 steps a turn on one scene, at 140 on the other."""

    def line(scene: str, name: str, need: float, us: float, *steps: int) -> list[Row]:
        return [cell(scene, name, n, 1e-3 * (need / n) ** 2, us) for n in steps]

    rows = []
    for scene, need in (("a", 100.0), ("b", 140.0)):
        rows += line(scene, "x", need, 1.0, 90, 180, 360, 720)
        rows += line(scene, "late", 500.0, 9.0, 360, 720)
    (found,) = recommendations(stored(rows), [BELOW])
    assert found.best.steps_per_turn == 180
    assert found.least_steps == pytest.approx(140.0, rel=1e-3)
    (found,) = recommendations(stored(line("a", "x", 10.0, 1.0, 90, 180, 360)), [BELOW])
    assert found.least_steps == pytest.approx(90.0)


def test_another_drive_is_another_choice_and_named() -> None:
    found = of(X, cell("a", "x", 90, 1e-4, 2.0, drive="servo"))
    assert (variant(found), found.best.drive) == ("x", "prescribed")
    found = of("a x 90 1 2", drive="servo")
    assert found.reason.startswith("nearest is x, servo drive at 90 steps a turn: ")


def test_a_line_is_fitted_from_coarse_to_fine() -> None:
    steps = (360, 90, 720, 180)  # as they come out of a pool
    (line,) = lines(stored(cell("a", "x", n, 1e-3 * (90 / n) ** 2, 1.0) for n in steps))
    assert list(line.cells["steps_per_turn"]) == [90, 180, 360, 720]
    assert line.fit.order == pytest.approx(2.0, abs=1e-6)
    unseen = r"a floor below \S+ rad is not excluded by these steps"
    assert re.fullmatch(f"order 2.0; {unseen}", line.words)
    assert line.period_s == pytest.approx(PERIOD_S)
    assert line.settings == {"name": "x"}
    # Of another quantity it is that of its column.
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
    rows = [cell("a", "x", 90, 1e-3, 1.0, asked={"iterations": n}) for n in (9, 3)]
    assert [line.settings for line in lines(stored(rows))] == [{"iterations": 3}]  # the later


def test_lines_come_in_the_order_of_the_study() -> None:
    tuned = [
        {"engine": "pymunk", "profile": "tuned"},
        {"engine": "mujoco", "profile": "tuned", "settings": {"iterations": [1, 2]}},
    ]
    study = {"scenes": ["b", "a"], "variants": tuned, "steps_per_turn": [90]}
    names = [("mujoco", "tuned, iterations=2"), ("mujoco", "tuned, iterations=1")]
    rows = [
        cell(scene, variant, 90, 1e-3, 1.0, engine=engine)
        for engine, variant in [*names, ("pymunk", "tuned"), ("pymunk", "other")]
        for scene in ("c", "a", "b")
    ]
    found = lines(stored(rows, scenes=("b", "a"), runs=({"study": study}, {"study": {"old": 1}})))
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


STEPS = (90, 180, 360, 720)


def second_order(scene: str, variant: str, at_90: float, us: float) -> list[Row]:
    """Errors that fall as dt^2 from ``at_90``, every step for ``us``."""
    return [cell(scene, variant, n, at_90 * (90 / n) ** 2, us) for n in STEPS]


def line_of(rows: Sequence[Row]) -> Line:
    (line,) = lines(stored(rows))
    return line


def test_noise_is_what_95_of_100_pairs_stay_below() -> None:
    rows = [
        cell("a", "x", 90 + i, 1e-3, 1.0, us_per_step_a=1.0, us_per_step_b=1.0 + 0.001 * i)
        for i in range(101)
    ]
    assert candidates.noise(stored(rows)) == pytest.approx(0.095)
    swapped = [r | {"us_per_step_a": r["us_per_step_b"], "us_per_step_b": 1.0} for r in rows]
    assert candidates.noise(stored(swapped)) == pytest.approx(0.095)
    # Of a machine whose times are compared.
    rows = [
        cell("a", "x", 90, 1e-3, 1.0, us_per_step_b=2.0, processor="old", made="2025-01-01"),
        cell("a", "x", 180, 1e-3, 1.0, us_per_step_b=1.01),
    ]
    assert candidates.noise(stored(rows)) == pytest.approx(0.01)
    text = noise_line(stored(rows))
    assert "Noise of costs on abacus: 95% of 1 A/A pairs differ by less than 1.0%" in text
    assert "Times of old are not compared" in text
    assert math.isnan(candidates.noise(stored([untimed(rows[0])])))
    assert noise_line(stored([untimed(rows[0])])).startswith("No cell was timed")


def test_the_time_to_a_target_is_taken_along_the_fit_and_not_extrapolated() -> None:
    """1e-4 at 90 * sqrt(10) steps a turn of 2 us each."""
    rows = second_order("a", "x", 1e-3, 2.0)
    line = line_of(rows)
    # 1e-3 at the coarsest step, 1.6e-5 at the finest
    for target, steps, rel in ((1e-4, 90 * math.sqrt(10), 1e-3), (1e-2, 90, 1e-6)):
        assert candidates.time_to(line, target) == pytest.approx(2e-6 * steps, rel=rel)
        assert candidates.reached(line, target).steps_per_turn == pytest.approx(steps, rel=rel)
    assert (candidates.time_to(line, 1e-6), candidates.reached(line, 1e-6)) == (None, None)
    failed = line_of([rows[0] | {"status": "diverged"}, *rows[1:]])
    assert candidates.reached(failed, 1e-2).steps_per_turn == pytest.approx(180)
    unknown = line_of([untimed(row) for row in rows])
    assert candidates.reached(unknown, 1e-4) is not None
    assert candidates.time_to(unknown, 1e-4) is None


def test_costs_are_means_over_scenes_of_the_least_and_the_median_repeat() -> None:
    rows = second_order("a", "x", 1e-3, 2.0) + second_order("b", "x", 1e-3, 8.0)
    rows += second_order("a", "y", 1e-2, 1.0) + second_order("b", "y", 1e-5, 1.0)
    x, y = candidates.costs_of(lines(stored(rows)), [1e-4])
    assert (x.us_per_step, x.us_per_step_median) == pytest.approx((4.0, 4.4))
    assert x.s_to[1e-4] == pytest.approx(4e-6 * 90 * math.sqrt(10), rel=1e-3)
    assert (x.reached[1e-4], y.reached[1e-4]) == (2, 1)
    assert math.isnan(y.s_to[1e-4])
    assert (x.part(x.reached[1e-4]), y.part(y.reached[1e-4])) == ("", "1/2")
    (partly,) = candidates.costs_of(lines(stored([*rows[:4], *map(untimed, rows[4:8])])), [1e-4])
    assert (partly.timed, partly.reached[1e-4], partly.us_per_step) == (1, 2, pytest.approx(2.0))
    assert math.isnan(partly.s_to[1e-4])


def test_the_front_is_what_nothing_beats_in_both() -> None:
    rows = table(
        "a x 90 1e-2 1, a x 180 1e-3 1, a beaten 180 2e-3 1.5, a exact 90 1e-5 9,"
        "a twin 90 1e-5 9.5, a nan 90 nan 0.1"
    )
    rows.append(cell("a", "wrong", 90, 1e-9, 0.1, status="diverged"))
    rows.append(untimed(cell("a", "untimed", 90, 1e-9, 0.1)))
    cells = stored(rows).cells
    chosen = cells.set_index("key").loc[candidates.front(cells)]
    found = list(zip(chosen["variant"], chosen["steps_per_turn"], strict=True))
    assert found == [("exact", 90), ("x", 180), ("x", 90)]
    # A saving within the noise is none.
    cells = stored(table("a x 90 1e-3 1, a y 90 1e-4 1.02")).cells
    variants = cells.set_index("key")["variant"]
    for noises, chosen in (((), ["y", "x"]), ((0.05,), ["y"]), ((math.nan,), ["y", "x"])):
        assert [variants[key] for key in candidates.front(cells, *noises)] == chosen


def test_over_all_scenes_an_error_is_the_worst_and_a_failure_bars() -> None:
    rows = table(
        "a x 90 1e-3 1, b x 90 1e-1 1, a y 90 1e-2 1.5, b y 90 1e-2 1.5, a z 90 1e-9 0.1,"
        "a late 90 2e-1 2, b late 90 1e-9 2"
    )
    rows.append(cell("b", "z", 90, 1e-9, 0.1, status="diverged"))
    found = candidates.front_over_all(candidates.candidates(lines(stored(rows))))
    assert [(one.variant, one.worst_error) for one in found] == [("y", 1e-2), ("x", 1e-1)]


def share(profile: pd.DataFrame, variant: str, factor: float) -> float:
    own = profile[(profile["variant"] == variant) & (profile["factor"] <= factor)]
    return float(own["share"].iloc[-1])


def test_a_performance_profile_counts_scenes_within_a_factor_of_the_fastest() -> None:
    rows = second_order("a", "x", 1e-3, 1.0) + second_order("b", "x", 1e-3, 3.0)
    rows += second_order("a", "y", 1e-3, 2.0) + second_order("b", "y", 1e-3, 1.0)
    # On the third scene only y comes to the target, on the fourth, where y was not run, nothing.
    rows += [cell("c", "x", n, 0.5, 1.0) for n in STEPS] + second_order("c", "y", 1e-3, 1.0)
    rows += [cell("d", name, n, 0.5, 1.0) for name in ("x", "never") for n in STEPS]
    found = candidates.performance_profile(lines(stored(rows)), 1e-4)
    assert [share(found, "x", f) for f in (1.0, 2.9, 3.1, 99.0)] == [0.25, 0.25, 0.5, 0.5]
    assert [share(found, "y", f) for f in (1.0, 1.9, 2.1, 99.0)] == [0.5, 0.5, 0.75, 0.75]
    assert share(found, "never", 99.0) == 0.0
    assert found.groupby("variant")["factor"].min().eq(1.0).all()
    near = lines(stored(second_order("a", "x", 1e-3, 1.0) + second_order("a", "y", 1e-3, 1.03)))
    assert share(candidates.performance_profile(near, 1e-4), "y", 1.0) == 0.0
    assert share(candidates.performance_profile(near, 1e-4, 0.05), "y", 1.0) == 1.0


@pytest.mark.parametrize("width", [60, 120])
def test_the_table_fits_and_says_what_there_is_not(width: int) -> None:
    rows = second_order("a", "name [of] some length", 1e-3, 2.0)
    store = stored([*rows, cell("a", "name [of] some length", 1440, 9.0, 2.0, status="diverged")])
    console = Console(file=StringIO(), width=width)
    console.print(recommendation_table(recommendations(store), width))
    text = console.file.getvalue()
    assert max(map(len, text.splitlines())) <= width
    flat = " ".join(text.split())
    assert "not at 1440 steps a turn: a diverged" in flat
    assert "none [2]" in flat
    assert "nearest is name [of] some length at 720 steps a turn" in flat
    assert (" on scene " in flat) == (width == 120)


def test_what_is_let_go_is_measured_over_a_second_however_long_it_lasts() -> None:
    swing, pulse, pendulum = (
        Cell(load_scene(name), "mujoco", "tuned", 1e-3, 500, drive="free")
        for name in ("fourbar-swing", "fourbar-pulse", "double-pendulum")
    )
    assert swing.steps_per_turn == pulse.steps_per_turn == pytest.approx(1000.0)
    assert replace(swing, steps=250).turns == pytest.approx(0.25)
    assert min(timed(pendulum, 10.0)) > 0.0, "of several freedoms"
