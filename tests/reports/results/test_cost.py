"""Noise, time to a target, fronts and profiles: on errors and costs that are known."""

import math
from collections.abc import Sequence
from dataclasses import replace
from io import StringIO

import pandas as pd
import pytest
from rich.console import Console

from models.files.reading import load_scene
from reports.judge.cell import Cell
from reports.results.candidates import (
    candidates,
    costs_of,
    equal,
    front,
    front_over_all,
    noise,
    performance_profile,
    reached,
    time_to,
)
from reports.results.lines import Line, lines
from reports.results.recommend import noise_line, recommendation_table, recommendations
from reports.sweep.measured import timed
from tests.reports.results.made import Row, cell, stored, table, untimed

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
    assert noise(stored(rows)) == pytest.approx(0.095)
    swapped = [r | {"us_per_step_a": r["us_per_step_b"], "us_per_step_b": 1.0} for r in rows]
    assert noise(stored(swapped)) == pytest.approx(0.095)


def test_noise_is_that_of_the_machine_whose_times_are_compared() -> None:
    rows = [
        cell("a", "x", 90, 1e-3, 1.0, us_per_step_b=2.0, processor="old", made="2025-01-01"),
        cell("a", "x", 180, 1e-3, 1.0, us_per_step_b=1.01),
    ]
    assert noise(stored(rows)) == pytest.approx(0.01)
    assert math.isnan(noise(stored([untimed(rows[0])])))


def test_equal_is_a_difference_within_the_noise_whichever_comes_first() -> None:
    cases = (1.0, 1.04, 0.05), (1.04, 1.0, 0.05), (1.0, 1.06, 0.05), (1.0, 1.0, math.nan)
    assert [equal(*each) for each in cases] == [True, True, False, True]
    assert not equal(1.0, 1.01, math.nan)


def test_the_time_to_a_target_is_taken_along_the_fit_and_not_extrapolated() -> None:
    """1e-4 at 90 * sqrt(10) steps a turn of 2 us each."""
    rows = second_order("a", "x", 1e-3, 2.0)
    line = line_of(rows)
    # 1e-3 at the coarsest step, 1.6e-5 at the finest
    for target, steps, rel in ((1e-4, 90 * math.sqrt(10), 1e-3), (1e-2, 90, 1e-6)):
        assert time_to(line, target) == pytest.approx(2e-6 * steps, rel=rel)
        assert reached(line, target).steps_per_turn == pytest.approx(steps, rel=rel)
    assert (time_to(line, 1e-6), reached(line, 1e-6)) == (None, None)
    failed = line_of([rows[0] | {"status": "diverged"}, *rows[1:]])
    assert reached(failed, 1e-2).steps_per_turn == pytest.approx(180)
    unknown = line_of([untimed(row) for row in rows])
    assert reached(unknown, 1e-4) is not None
    assert time_to(unknown, 1e-4) is None


def test_costs_are_means_over_scenes_of_the_least_and_the_median_repeat() -> None:
    rows = second_order("a", "x", 1e-3, 2.0) + second_order("b", "x", 1e-3, 8.0)
    rows += second_order("a", "y", 1e-2, 1.0) + second_order("b", "y", 1e-5, 1.0)
    x, y = costs_of(lines(stored(rows)), [1e-4])
    assert (x.us_per_step, x.us_per_step_median) == pytest.approx((4.0, 4.4))
    assert x.s_to[1e-4] == pytest.approx(4e-6 * 90 * math.sqrt(10), rel=1e-3)
    assert (x.reached[1e-4], y.reached[1e-4]) == (2, 1)
    assert math.isnan(y.s_to[1e-4])
    assert (x.part(x.reached[1e-4]), y.part(y.reached[1e-4])) == ("", "1/2")


def test_costs_say_on_how_many_scenes_they_were_timed() -> None:
    rows = second_order("a", "x", 1e-3, 2.0)
    rows += [untimed(row) for row in second_order("b", "x", 1e-3, 2.0)]
    (x,) = costs_of(lines(stored(rows)), [1e-4])
    assert (x.timed, x.part(x.timed), x.us_per_step) == (1, "1/2", pytest.approx(2.0))
    assert x.reached[1e-4] == 2
    assert math.isnan(x.s_to[1e-4])
    (none,) = costs_of(lines(stored(rows[4:])), [1e-4])
    assert none.timed == 0
    assert math.isnan(none.us_per_step)


def test_the_front_is_what_nothing_beats_in_both() -> None:
    rows = table(
        "a x 90 1e-2 1, a x 180 1e-3 1, a beaten 180 2e-3 1.5, a exact 90 1e-5 9,"
        "a twin 90 1e-5 9.5, a nan 90 nan 0.1"
    )
    rows.append(cell("a", "wrong", 90, 1e-9, 0.1, status="diverged"))
    rows.append(untimed(cell("a", "untimed", 90, 1e-9, 0.1)))
    cells = stored(rows).cells
    chosen = cells.set_index("key").loc[front(cells)]
    found = list(zip(chosen["variant"], chosen["steps_per_turn"], strict=True))
    assert found == [("exact", 90), ("x", 180), ("x", 90)]


def test_within_the_noise_a_saving_is_none() -> None:
    cells = stored(table("a x 90 1e-3 1, a y 90 1e-4 1.02")).cells
    variants = cells.set_index("key")["variant"]
    for noises, chosen in (((), ["y", "x"]), ((0.05,), ["y"]), ((math.nan,), ["y", "x"])):
        assert [variants[key] for key in front(cells, *noises)] == chosen


def test_over_all_scenes_an_error_is_the_worst_and_a_failure_bars() -> None:
    rows = table(
        "a x 90 1e-3 1, b x 90 1e-1 1, a y 90 1e-2 1.5, b y 90 1e-2 1.5, a z 90 1e-9 0.1,"
        "a late 90 2e-1 2, b late 90 1e-9 2"
    )
    rows.append(cell("b", "z", 90, 1e-9, 0.1, status="diverged"))
    found = front_over_all(candidates(lines(stored(rows))))
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
    found = performance_profile(lines(stored(rows)), 1e-4)
    assert [share(found, "x", f) for f in (1.0, 2.9, 3.1, 99.0)] == [0.25, 0.25, 0.5, 0.5]
    assert [share(found, "y", f) for f in (1.0, 1.9, 2.1, 99.0)] == [0.5, 0.5, 0.75, 0.75]
    assert share(found, "never", 99.0) == 0.0
    assert found.groupby("variant")["factor"].min().eq(1.0).all()


def test_a_performance_profile_calls_times_within_the_noise_equal() -> None:
    rows = second_order("a", "x", 1e-3, 1.0) + second_order("a", "y", 1e-3, 1.03)
    every = lines(stored(rows))
    assert share(performance_profile(every, 1e-4), "y", 1.0) == 0.0
    assert share(performance_profile(every, 1e-4, 0.05), "y", 1.0) == 1.0


@pytest.mark.parametrize("width", [60, 80, 120])
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


def test_the_noise_line_tells_share_number_and_machines() -> None:
    rows = [cell("a", "x", 90 + i, 1e-3, 1.0, us_per_step_b=1.02) for i in range(3)]
    rows.append(cell("a", "x", 99, 1e-3, 1.0, processor="loom", made="2025-01-01"))
    text = noise_line(stored(rows))
    assert "Noise of costs on abacus: 95% of 3 A/A pairs differ by less than 2.0%" in text
    assert "Times of loom are not compared" in text
    assert noise_line(stored([untimed(rows[0])])).startswith("No cell was timed")


def test_what_is_let_go_is_measured_over_a_second_however_long_it_lasts() -> None:
    swing, pulse, pendulum = (
        Cell(load_scene(name), "mujoco", "tuned", 1e-3, 500, drive="free")
        for name in ("fourbar-swing", "fourbar-pulse", "double-pendulum")
    )
    assert swing.steps_per_turn == pulse.steps_per_turn == pytest.approx(1000.0)
    assert replace(swing, steps=250).turns == pytest.approx(0.25)
    assert min(timed(pendulum, 10.0)) > 0.0, "of several freedoms"
