"""Lines that real engines made are read as what they are."""

from __future__ import annotations

import math

import pytest

from models.files import load_scene
from reports.judge.cell import Cell, check
from reports.results.fits.line import LineFit, fit_line
from reports.results.fits.words import words
from tests.reports.results.fits.measured import (
    DIPS,
    LEAVES_ITS_BRANCH,
    MUJOCO_AS_SHIPPED,
    ORDERS,
    STEPS,
    THIRD_THEN_SECOND,
)

PERIOD = 2.0 * math.pi / 10.0


def at_steps(errors: tuple[float, ...]) -> LineFit:
    return fit_line([PERIOD / n for n in STEPS], errors)


def fourbar_line(engine: str, profile: str) -> LineFit:
    scene = load_scene("fourbar-lecture-1")
    period = scene.driver.law.period_s
    runs = [
        check(Cell(scene, engine, profile, period / n, 2 * n, converge=False)) for n in STEPS
    ]  # fmt: skip
    worst = [run.errors and run.errors.worst("angle") for run in runs]
    return fit_line(
        [period / n for n in STEPS],
        [row.pure if row else math.nan for row in worst],
        statuses=[run.status for run in runs],
    )


@pytest.mark.parametrize(
    ("engine", "profile", "order", "near"),
    [("pymunk", "as-shipped", 1.0, 0.15), ("pymunk", "tuned", 2.0, 0.15),
     ("mujoco", "tuned", 2.0, 0.2)],
)  # fmt: skip
def test_engines_show_their_order_on_the_lecture_fourbar(
    engine: str, profile: str, order: float, near: float
) -> None:
    found = fourbar_line(engine, profile)
    assert found.kind == "order"
    assert found.order == pytest.approx(order, abs=near)
    assert words(found, "rad", PERIOD) == f"order {order:.1f}, no floor seen"
    if engine == "mujoco":
        assert found.finest_error < 1e-8
        assert found.floor_below < 1e-8


def test_mujoco_as_shipped_has_a_floor_on_the_lecture_fourbar() -> None:
    found = fourbar_line("mujoco", "as-shipped")
    assert found.kind == "floor"
    assert 5e-4 < found.floor - found.floor_error < found.floor + found.floor_error < 1e-3
    assert words(found, "rad", PERIOD).startswith("converges to the wrong answer: floor ")


@pytest.mark.parametrize("name", list(ORDERS))
def test_the_order_to_which_a_line_settles_is_found(name: str) -> None:
    errors, order = ORDERS[name]
    found = at_steps(errors)
    assert found.kind == "order"
    assert found.order == pytest.approx(order, abs=0.15)
    assert found.used[-3:] == (True, True, True)
    assert found.floor_below < errors[-1]


@pytest.mark.parametrize("scene", list(MUJOCO_AS_SHIPPED))
def test_a_floor_of_mujoco_as_shipped_is_what_much_finer_runs_converge_to(scene: str) -> None:
    errors, much_finer = MUJOCO_AS_SHIPPED[scene]
    found = at_steps(errors)
    assert found.kind == "floor"
    assert found.floor == pytest.approx(much_finer, rel=0.2)
    assert abs(found.floor - much_finer) < 3.0 * found.floor_error


def test_stated_uncertainties_of_floors_hold_two_times_in_three() -> None:
    fits = [(at_steps(errors), finer) for errors, finer in MUJOCO_AS_SHIPPED.values()]
    held = sum(abs(fit.floor - finer) <= fit.floor_error for fit, finer in fits)
    assert 7 <= held <= 10


def test_a_floor_that_works_against_the_step_is_told_from_the_dip_before_it() -> None:
    """The finest error of the slotted lever is half of the floor that it rises to."""
    found = at_steps(MUJOCO_AS_SHIPPED["slotted-lever"][0])
    assert found.curve.alignment < -0.5
    assert found.floor > 1.5 * found.finest_error
    assert found.order == pytest.approx(1.0, abs=0.1)


def test_coarse_points_before_the_order_settles_are_left_out() -> None:
    found = at_steps(ORDERS["shaper, pymunk as-shipped"][0])
    assert found.used[:2] == (False, False)


def test_an_order_that_gives_way_to_a_lower_one_is_no_floor() -> None:
    """Three steps of it alone would look like a floor of 1.1e-9, which the next step is below."""
    found = at_steps(THIRD_THEN_SECOND)
    assert found.kind == "order"
    assert abs(found.order - 2.0) < found.order_error


def test_a_dip_at_the_finest_steps_is_neither_an_order_nor_a_floor() -> None:
    found = at_steps(DIPS)
    assert found.kind == "irregular"
    assert words(found, "rad", PERIOD) == "irregular: falls to 7.0e-5 rad, then rises to 1.4e-4"


def test_steps_that_leave_the_branch_are_named_and_not_fitted() -> None:
    found = fit_line(
        [PERIOD / n for n in (45, *STEPS)],
        LEAVES_ITS_BRANCH,
        statuses=["branch-changed", *("ok" for _ in STEPS)],
    )
    assert not found.used[0]
    assert words(found, "rad", PERIOD) == (
        "converges to the wrong answer: floor 2.1e-1 rad; changes branch below 90 steps per turn"
    )
