"""Which settings are recommended, and what is said where none are, on made-up stores."""

from __future__ import annotations

import math

import pytest

from reports.results.recommend import Recommendation, recommendations
from tests.reports.results.made import Row, cell, stored, untimed

TARGET = 1e-3


def of(*rows: Row) -> Recommendation:
    """The one recommendation of a store with one engine."""
    (found,) = recommendations(stored(rows), [TARGET])
    return found


def on(
    scenes: str, variant: str, steps: float, error: float, us: float, **more: object
) -> list[Row]:
    """The same cell on each of these scenes."""
    return [cell(scene, variant, steps, error, us, **more) for scene in scenes]


def variant(found: Recommendation) -> str | None:
    """The variant that is recommended, if any."""
    return None if found.reason else found.best.variant


def test_the_cheapest_that_reaches_the_target_on_every_scene_is_chosen() -> None:
    found = of(
        cell("a", "cheap", 90, 5e-4, 1.0),
        cell("b", "cheap", 90, 2e-3, 1.0),  # misses on one scene
        cell("a", "good", 90, 5e-4, 4.0),
        cell("b", "good", 90, 9e-4, 9.0),
        *on("ab", "dear", 90, 1e-4, 9.0),
    )
    assert variant(found) == "good"
    assert found.best.steps_per_turn == 90
    assert (found.best.worst_error, found.best.worst_scene, found.best.scenes) == (9e-4, "b", 2)
    assert found.best.us_per_step == pytest.approx(6.0)  # the geometric mean of 4 and 9
    assert found.best.s_per_turn == pytest.approx(6e-6 * 90)
    assert found.best.settings == {"name": "good"}


def test_fewer_steps_at_a_dear_step_may_be_cheaper() -> None:
    found = of(
        cell("a", "euler", 90, 4e-3, 1.0),
        cell("a", "euler", 900, 4e-4, 1.0),
        cell("a", "rk4", 90, 1e-4, 4.0),
    )
    assert (variant(found), found.best.steps_per_turn) == ("rk4", 90)


def test_an_error_equal_to_the_target_reaches_it() -> None:
    assert variant(of(cell("a", "x", 90, TARGET, 1.0))) == "x"
    assert variant(of(cell("a", "x", 90, math.nextafter(TARGET, 1.0), 1.0))) is None


@pytest.mark.parametrize("status", ["diverged", "branch-changed", "unsupported", "timeout"])
def test_a_cell_that_did_not_end_well_disqualifies_with_its_status(status: str) -> None:
    rows = [cell("a", "x", 90, 1e-4, 1.0), cell("b", "x", 90, 1e-4, 1.0, status=status)]
    assert variant(of(*rows, *(cell(scene, "y", 90, 1e-4, 7.0) for scene in "ab"))) == "y"
    reason = f"nearest is x at 90 steps a turn: on 1 of 2 scenes; b {status}"
    assert of(*rows).reason == reason


def test_a_missing_cell_disqualifies() -> None:
    found = of(
        cell("a", "x", 90, 1e-4, 1.0), cell("a", "y", 90, 1e-4, 7.0), cell("b", "y", 90, 1e-4, 7.0)
    )
    assert variant(found) == "y"
    found = of(cell("a", "x", 90, 1e-4, 1.0), cell("b", "y", 90, 1.0, 7.0))
    assert found.reason == "nearest is x at 90 steps a turn: on 1 of 2 scenes; b not run"


def test_other_settings_under_the_same_name_are_not_the_same_variant() -> None:
    """Scene b was swept with another study, whose `x` is another."""
    found = of(
        cell("a", "x", 90, 1e-4, 1.0, asked={"iterations": 10}),
        cell("b", "x", 90, 1e-4, 1.0, asked={"iterations": 20}),
    )
    assert variant(found) is None
    assert "not run" in found.reason


def test_an_error_that_is_no_number_disqualifies() -> None:
    found = of(cell("a", "x", 90, math.nan, 1.0))
    assert (variant(found), found.best.worst_scene) == (None, None)
    assert found.reason == "nearest is x at 90 steps a turn: on 0 of 1 scenes; a error is no number"


def test_what_comes_nearest_is_named_where_nothing_does() -> None:
    found = of(
        cell("a", "x", 90, 5e-4, 1.0),
        cell("b", "x", 90, 5e-1, 1.0),
        cell("a", "y", 180, 5e-4, 1.0),
        cell("b", "y", 180, 4e-3, 1.0),
        *on("ab", "z", 180, 2e-3, 1.0),
    )
    assert variant(found) is None
    assert (found.best.variant, found.best.steps_per_turn) == ("y", 180)
    assert (found.best.worst_error, found.best.worst_scene) == (4e-3, "b")
    assert found.reason == "nearest is y at 180 steps a turn: on 1 of 2 scenes; b 4.0e-3"
    assert found.snippet() == ""
    found = of(cell("a", "z", 180, 2e-3, 1.0), cell("b", "z", 180, 2e-3, 1.0))
    assert found.reason == "nearest is z at 180 steps a turn: on no scene, 2.0e-3 on a at best"


def test_settings_without_a_cost_are_said_to_be_so() -> None:
    found = of(untimed(cell("a", "x", 90, 1e-4, 1.0)))
    assert variant(found) is None
    assert found.reason.startswith("x would do, but no cost is known")
    found = of(untimed(cell("a", "x", 90, 1e-4, 1.0)), cell("a", "y", 90, 1e-4, 9.0))
    assert variant(found) == "y"


def test_a_cost_that_is_missing_on_one_scene_is_no_cost() -> None:
    found = of(
        cell("a", "x", 90, 1e-4, 1.0),
        untimed(cell("b", "x", 90, 1e-4, 1.0)),
        *on("ab", "y", 90, 1e-4, 9.0),
    )
    assert variant(found) == "y"


def test_costs_inside_the_noise_are_equal_and_the_more_accurate_is_chosen() -> None:
    noisy = {"us_per_step_a": 10.0, "us_per_step_b": 10.5}  # 5 % between two of the same
    rows = [
        cell("a", "fast", 90, 9e-4, 10.0, **noisy),
        cell("a", "exact", 90, 1e-4, 10.4, **noisy),
        cell("a", "slow", 90, 1e-5, 10.9, **noisy),
    ]
    found = of(*rows)
    assert variant(found) == "exact"
    # Equal to what is chosen, if not to each other.
    assert found.equal_to == ("fast at 90 steps a turn", "slow at 90 steps a turn")
    quiet = of(*(row | {"us_per_step_b": 10.0} for row in rows))
    assert (variant(quiet), quiet.equal_to) == ("fast", ())


def test_a_shorter_step_of_the_same_settings_is_dearer_however_noisy_the_clock() -> None:
    noisy = {"us_per_step_a": 10.0, "us_per_step_b": 25.0}
    found = of(
        cell("a", "x", 90, 9e-4, 11.0, **noisy),
        cell("a", "x", 180, 1e-4, 10.0, **noisy),
        cell("a", "x", 360, 1e-5, 4.0, **noisy),
    )
    assert found.best.steps_per_turn == 90
    assert found.equal_to == ()


def test_a_promise_that_a_finer_step_breaks_comes_with_caution_and_a_steadier_choice() -> None:
    found = of(
        cell("a", "wild", 90, 9e-4, 1.0),
        cell("a", "wild", 180, 2e-4, 1.0),
        cell("a", "wild", 360, 9.0, 1.0, status="diverged"),
        cell("a", "wild", 720, 9.0, 1.0, status="diverged"),
        cell("a", "steady", 90, 9e-4, 3.0),
        cell("a", "steady", 720, 1e-5, 3.0),
    )
    assert variant(found) == "wild"
    assert found.caution == "not at 360 steps a turn: a diverged"
    assert (found.steadier.best.variant, found.steadier.best.steps_per_turn) == ("steady", 90)
    assert "Caution" not in found.steadier.snippet()
    assert "Caution: not at 360" in found.snippet()


def test_a_dip_of_the_error_is_no_steady_promise() -> None:
    """Errors of two kinds that cancel at one step."""
    found = of(
        cell("a", "soft", 90, 5e-3, 1.0),
        cell("a", "soft", 180, 4e-4, 1.0),
        cell("a", "soft", 360, 2e-3, 1.0),
    )
    assert (variant(found), found.best.steps_per_turn) == ("soft", 180)
    assert found.caution == "not at 360 steps a turn: a 2.0e-3"
    assert found.steadier is None


def test_a_finer_step_that_was_not_run_everywhere_gives_no_caution() -> None:
    found = of(
        cell("a", "x", 90, 1e-4, 1.0), cell("b", "x", 90, 1e-4, 1.0), cell("a", "x", 180, 1e-5, 1.0)
    )
    assert (variant(found), found.caution) == ("x", "")


def test_the_step_on_the_fit_lies_between_measured_ones() -> None:
    """Second order: 1e-3 at 100 steps a turn on one scene, at 140 on the other."""
    rows = [
        cell(scene, "x", steps, 1e-3 * (need / steps) ** 2, 1.0)
        for scene, need in (("a", 100.0), ("b", 140.0))
        for steps in (90, 180, 360, 720)
    ]
    other = [
        cell(scene, "late", n, 1e-3 * (500 / n) ** 2, 9.0) for scene in "ab" for n in (360, 720)
    ]
    found = of(*rows, *other)
    assert found.best.steps_per_turn == 180
    assert found.least_steps == pytest.approx(140.0, rel=1e-3)


def test_the_step_on_the_fit_is_not_extrapolated() -> None:
    rows = [cell("a", "x", steps, 1e-3 * (10 / steps) ** 2, 1.0) for steps in (90, 180, 360)]
    assert of(*rows).least_steps == pytest.approx(90.0)


def test_engines_are_compared_each_with_itself() -> None:
    rows = [cell("a", "x", 90, 1e-4, 1.0), cell("a", "x", 90, 1e-4, 9.0, engine="pymunk")]
    found = recommendations(stored(rows), [1e-2, 1e-3])
    assert [(r.best.engine, r.target, variant(r)) for r in found] == [
        ("mujoco", 1e-2, "x"),
        ("mujoco", 1e-3, "x"),
        ("pymunk", 1e-2, "x"),
        ("pymunk", 1e-3, "x"),
    ]


def test_another_drive_is_another_choice_and_named() -> None:
    found = of(cell("a", "x", 90, 1e-4, 1.0), cell("a", "x", 90, 1e-4, 2.0, drive="servo"))
    assert (variant(found), found.best.drive) == ("x", "prescribed")
    found = of(cell("a", "x", 90, 1.0, 2.0, drive="servo"))
    assert found.reason.startswith("nearest is x, servo drive at 90 steps a turn: ")
