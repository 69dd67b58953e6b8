"""The proof in engines: of what is met, and of what is not."""

import cmath
import functools
import itertools
import math
from dataclasses import replace

import numpy as np
import pytest

from analytic.lectures.synthesis.design import Asked
from analytic.lectures.synthesis.examine import Examined, passing_times
from analytic.lectures.synthesis.solutions import solutions_of
from models.lectures.shipped_tables import TaskTable
from models.lectures.tasks import load_task, shipped_tasks
from models.lectures.tasks.positions import CouplerTask
from reports.lectures.design.proof import by_reference, proven
from tests.analytic.lectures.synthesis.random_tasks import TASKS, proofs
from tests.worlds.tiers import slow, slowly

QUICK = ("three-positions", "by-angle", "isosceles", "slotted-lever", "whitworth",
         "power-4-points", "evans", "peaucellier")  # fmt: skip
EVERY = [
    (kind, name) if name in QUICK else slowly(kind, name, reason="one more of a kind")
    for kind, names in shipped_tasks().items()
    for name in names
]


@functools.cache
def best(kind: str, name: str) -> tuple[Examined, TaskTable]:
    task = load_task(kind, name)
    return solutions_of(task).examined[0], task


@pytest.mark.parametrize(("kind", "name"), EVERY)
def test_shipped_tasks_are_met_by_the_reference_and_the_engines(kind: str, name: str) -> None:
    one, task = best(kind, name)
    _hold(one, task, name)


@slow("0.7 s: a search; its positions are proven as those of other tasks")
def test_a_path_is_met_by_the_reference_and_the_engines() -> None:
    task = load_task("path", "oval").model_copy(update={"starts": 3})
    _hold(solutions_of(task).examined[0], task, "oval")


def _hold(one: Examined, task: TaskTable, name: str) -> None:
    if name in ("five-positions", "power-5-points"):
        assert one.defects, "the one mechanism that there is"
        return
    assert not one.defects
    exact = by_reference(one, task)
    assert max(met.off for met in exact) < 1e-12 + one.proposal.allowed * one.scene.longest_m
    for engine in ("mujoco", "pymunk"):
        every = proven(one, task, engine)
        assert len(every) == len(exact)
        assert all(met.within for met in every), engine
        assert max(met.off for met in every) > 1e-13, "an engine is not the reference"


@slow("five random tasks of each kind in three engines; benchmarks/synthesis.py has fifty")
@pytest.mark.parametrize("kind", TASKS)
def test_engines_lead_random_mechanisms_through_their_tasks(kind: str) -> None:
    off = dict(itertools.islice(proofs(kind), 5))
    assert max(max(each.values()) for each in off.values()) <= 1.0, off


def moved(one: Examined, by: float) -> Examined:
    """The same, asked for places and angles that it does not come to."""

    def shifted(asked: Asked) -> Asked:
        (name,) = {"place", "angle", "displacement"} & {*vars(asked)}
        return replace(asked, **{name: vars(asked)[name] + by})

    positions = [replace(p, asked=tuple(map(shifted, p.asked))) for p in one.positions]
    return replace(one, positions=tuple(positions))


@pytest.mark.parametrize(
    ("kind", "name"),
    [("coupler", "three-positions"), ("rocker", "by-angle"), ("stroke", "isosceles")],
)
def test_what_is_not_met_is_seen(kind: str, name: str) -> None:
    one, task = best(kind, name)
    other = moved(one, 0.01)
    for every in (by_reference(other, task), proven(other, task, "mujoco")):
        assert not any(met.within for met in every)
        assert [met.off for met in every] == pytest.approx([0.01] * len(every), rel=0.01)


def test_a_driver_off_and_too_long_a_step_are_seen_and_tolerances_are_of_the_task() -> None:
    one, task = best("coupler", "three-positions")
    by = math.radians(1.0)
    driver = replace(one.scene.driver, law=one.scene.driver.law.turned(by))
    positions = tuple(replace(p, driver_rad=p.driver_rad + by) for p in one.positions)
    late = replace(one, scene=replace(one.scene, driver=driver), positions=positions)
    assert not all(met.within for met in proven(late, task, "mujoco"))
    assert not all(met.within for met in proven(one, task, "pymunk", steps_per_turn=12.0))
    tight = task.model_copy(update={"tolerance_m": 1e-12, "tolerance_deg": 1e-12})
    assert all(met.limit <= 1e-12 for met in by_reference(one, tight))
    assert not all(met.within for met in proven(one, tight, "mujoco"))


def test_what_lies_before_the_first_sample_is_not_read() -> None:
    one, task = best("rocker", "by-angle")
    first, second = one.positions
    back = replace(second, driver_rad=2.0 * first.driver_rad - second.driver_rad)
    every = proven(replace(one, positions=(first, back)), task, "mujoco")
    assert [math.isnan(met.off) for met in every] == [False, True]


def test_a_parallelogram_is_driven_the_way_that_its_positions_lie() -> None:
    """Three translations on a circle: the coupler passes a change point between them."""
    turns = [cmath.rect(0.1, math.radians(angle)) for angle in (200.0, 170.0, 150.0)]
    points = [[turn.real, turn.imag] for turn in turns]
    named = {
        "name": "x",
        "source": "a test",
        "moving_m": [points[0], [0.3 + points[0][0], points[0][1]]],
    }
    positions = [{"point_m": point, "angle_deg": 0.0} for point in points]
    task = CouplerTask.model_validate({**named, "positions": positions})
    for one in solutions_of(task).sound:
        at_s = passing_times(one.scene.driver.law, [p.driver_rad for p in one.positions])
        assert np.all(np.diff(at_s) > 0.0)
        assert all(met.within for met in proven(one, task, "mujoco"))
