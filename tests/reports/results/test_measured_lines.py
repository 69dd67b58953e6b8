"""Lines that real engines made are read as what they are; and what is said of any line.

Most are numbers: largest errors of a link angle [rad], each ``check(Cell(scene, engine, profile,
period / n, 2 n, converge=False)).errors.worst("angle").pure`` with mujoco 4.0.0 and pymunk 7.3.1,
over two turns with a prescribed drive.
"""

import math
import re
from collections.abc import Sequence

import numpy as np
import pytest

from models.files.reading import load_scene
from reports.judge.cell import Cell, check
from reports.results.line_fit import LineFit, fit_line, words
from tests.worlds.tiers import few, slow

PERIOD = 2.0 * math.pi / 10.0
STEPS = (90, 180, 360, 720, 1440, 2880)
"""Steps per turn of all tuples below."""

MUJOCO_AS_SHIPPED = {
    "fourbar-lecture-1": ((0.01029, 0.005021, 0.002231, 0.001027, 7.414e-4, 7.339e-4), 8.694e-4),
    "fourbar-lecture-2": ((0.01028, 0.005023, 0.002325, 0.00107, 4.909e-4, 3.93e-4), 4.896e-4),
    "fourbar-crossed": ((0.01073, 0.005079, 0.002222, 0.001087, 7.132e-4, 8.521e-4), 0.001155),
    "fourbar-double-crank": ((0.01789, 0.007313, 0.002784, 0.004069, 0.005208, 0.005853), 0.006362),
    "fourbar-double-rocker": ((0.003979, 0.00168, 0.001113, 9.698e-4, 9.082e-4, 8.79e-4), 8.541e-4),
    "shaper": ((0.02725, 0.03076, 0.03252, 0.0334, 0.03384, 0.03406), 0.03425),
    "sixbar-stephenson": ((0.01022, 0.004949, 0.002037, 0.001003, 0.001004, 0.001042), 0.001081),
    "sixbar-watt": ((0.01001, 0.00473, 0.002181, 0.001225, 0.001051, 0.001247), 0.001535),
    "slider-crank-central": ((0.004608, 0.002363, 0.00136, 9.076e-4, 6.964e-4, 5.925e-4), 5.026e-4),
    "slider-crank-offset": ((0.004639, 0.002369, 0.001406, 9.467e-4, 7.226e-4, 6.247e-4), 5.427e-4),
    "slotted-lever": ((0.006712, 0.003281, 0.001469, 5.827e-4, 2.154e-4, 2.399e-4), 4.201e-4),
    "whitworth": ((0.01474, 0.007613, 0.004164, 0.003677, 0.003768, 0.003891), 0.004043),
}
"""MuJoCo as shipped: the errors at `STEPS`, and that at 23040 steps per turn, eight times finer."""

ORDERS = {
    "lecture-1, mujoco tuned": ((6.383e-6, 1.496e-6, 3.734e-7, 9.345e-8, 2.333e-8, 5.827e-9), 2.0),
    "lecture-1, pymunk as-shipped": ((0.02415, 0.01182, 0.00585, 0.00291, 0.001451, 7.248e-4), 1.0),
    "shaper, pymunk as-shipped": ((0.1248, 0.01974, 0.005373, 0.002348, 0.001108, 5.415e-4), 1.0),
    "excel-210, mujoco tuned": ((3.735e-5, 1.159e-5, 3.48e-6, 9.529e-7, 2.459e-7, 6.199e-8), 2.0),
}
"""Errors at `STEPS`, and the order to which their slope settles (seen at 5760 steps per turn)."""


def at_steps(errors: tuple[float, ...]) -> LineFit:
    return fit_line([PERIOD / n for n in STEPS], errors)


@slow("half a second of runs; floors of lines that were measured are found below")
def test_mujoco_as_shipped_has_a_floor_on_the_lecture_fourbar() -> None:
    scene = load_scene("fourbar-lecture-1")
    steps_s = [scene.driver.law.period_s / n for n in STEPS]
    cells = [
        Cell(scene, "mujoco", "as-shipped", dt_s, 2 * n, converge=False)
        for n, dt_s in zip(STEPS, steps_s, strict=True)
    ]
    found = fit_line(steps_s, [check(one).errors.worst("angle").pure for one in cells])
    assert found.kind == "floor"
    assert 5e-4 < found.floor - found.floor_error < found.floor + found.floor_error < 1e-3
    assert words(found, "rad", PERIOD).startswith("converges to the wrong answer: floor ")


@pytest.mark.parametrize("name", ORDERS)
def test_the_order_to_which_a_line_settles_is_found(name: str) -> None:
    errors, order = ORDERS[name]
    found = at_steps(errors)
    assert (found.kind, found.order) == ("order", pytest.approx(order, abs=0.15))
    assert found.used[-3:] == (True, True, True)
    if name == "shaper, pymunk as-shipped":
        assert found.used[:2] == (False, False), "coarse points before the order settles"
    assert found.floor_below < errors[-1]


@pytest.mark.parametrize(
    "scene", few(MUJOCO_AS_SHIPPED, [*MUJOCO_AS_SHIPPED][::4], "floors of other scenes")
)
def test_a_floor_of_mujoco_as_shipped_is_what_much_finer_runs_converge_to(scene: str) -> None:
    errors, much_finer = MUJOCO_AS_SHIPPED[scene]
    found = at_steps(errors)
    assert (found.kind, found.floor) == ("floor", pytest.approx(much_finer, rel=0.2))
    assert abs(found.floor - much_finer) < 3.0 * found.floor_error


@slow("0.7 s: a share of twelve fits; a floor's uncertainty is held above for some")
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


def test_an_order_that_gives_way_to_a_lower_one_is_no_floor() -> None:
    """fourbar-double-rocker, mujoco tuned: third order that becomes second; 6.6e-10 at 5760. Three
    steps of it alone would look like a floor of 1.1e-9, which the next step is below."""
    found = at_steps((3.356e-5, 4.104e-6, 4.954e-7, 5.747e-8, 1.044e-8, 2.614e-9))
    assert found.kind == "order"
    assert abs(found.order - 2.0) < found.order_error


DTS = 0.36 / np.array([45, 90, 180, 360, 720, 1440])


@pytest.mark.parametrize(
    ("errors", "statuses", "text"),
    [
        (DTS**2, "diverged", "order 2.0; BELOW; diverges below 90 steps per turn"),
        (DTS**2, "diverged locked", "order 2.0; BELOW; locks below 180 steps per turn"),
        (DTS**2, "ok ok ok ok ok branch-changed", "changes branch at 1440 steps per turn"),
        ([math.nan] * 6, " ".join(["crashed"] * 6), "crashes at every step"),
        ([math.nan] * 6, " ".join(["unsupported"] * 6), "unsupported"),
        ([0.0] * 6, "", "at rounding"),
        ([1e-3], "", "1 step: too few to tell"),
        (1e-9 / DTS, "", "does not shrink: grows to 4.0e-6 rad"),
        ([1e-3, 1e-5, 1e-3, 1e-5, 1e-3, 2e-5], "",
         "irregular: falls to 1.0e-5 rad, then rises to 2.0e-5"),
        ([1e-2, 1e-5, 1e-3, 1e-5, 1e-3, 1e-6], "",
         "irregular: follows no order, 1.0e-6 rad at the finest step"),
        ([8e-3, 1e-3, 2.2e-4], "", "order 2.6 +- 0.4; BELOW"),
        ([4e-3, 3e-3, 2.4e-3], "", "order 0.4: slower than any integrator, a floor may be near"),
    ],
)  # fmt: skip
def test_a_line_says_what_it_does(errors: Sequence[float], statuses: str, text: str) -> None:
    """``statuses``: those of the coarsest steps; the others are ok."""
    ended = [*statuses.split(), *["ok"] * len(errors)][: len(errors)]
    fit = fit_line(DTS[: len(errors)], errors, statuses=ended)
    below = f"a floor below {fit.floor_below:.1e} rad is not excluded by these steps"
    text = text.replace("BELOW", re.sub("e-0", "e-", below))
    assert words(fit, "rad", 0.36) == text
    of_time = text.replace("per turn", "per second")
    assert words(fit, "rad", 0.36, "second") == of_time
