"""Worlds of a batch beside each other: whose motion one holds, and its difference from a run."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from models.files.reading import load_scene
from reports.compare.worlds import MOST_ALONE, difference, evenly, holders
from sim.engine import Run
from sim.run.worlds import run_worlds
from tests.sim.run.test_worlds import starts

FOURBAR = load_scene("fourbar-lecture-1")
COUNT = 8


@cache
def worlds() -> tuple[Run, ...]:
    dt_s = FOURBAR.driver.law.period_s / 90
    return tuple(run_worlds(FOURBAR, starts(FOURBAR, COUNT), "mujoco", dt_s=dt_s, steps=45))


def with_motion_of(world: int, of: int) -> list[Run]:
    """The runs, one with the motion of another at its own times."""
    own, other = worlds()[world], worlds()[of]
    motion = replace(other.motion, time_s=own.motion.time_s)
    return [replace(own, motion=motion) if k == world else one for k, one in enumerate(worlds())]


@pytest.mark.parametrize(("world", "of"), [(3, 4), (0, 7), (6, 1)])
def test_a_world_with_the_motion_of_another_is_named_with_it(world: int, of: int) -> None:
    assert holders(FOURBAR, worlds()) == {}
    assert holders(FOURBAR, with_motion_of(world, of)) == {world: of}


def test_a_world_that_is_off_by_itself_holds_no_motion_of_others() -> None:
    own = worlds()[2]
    turned = own.motion.each_series(lambda series: series + 0.3)
    runs = [replace(own, motion=turned) if k == 2 else one for k, one in enumerate(worlds())]
    assert holders(FOURBAR, runs) == {}


def test_a_world_without_samples_is_left_out() -> None:
    runs = [replace(one, motion=None) if k == 1 else one for k, one in enumerate(worlds())]
    assert holders(FOURBAR, runs) == {}


def test_a_difference_of_rates_alone_is_none_of_place_and_not_to_the_bit() -> None:
    own = worlds()[0]
    rocker = own.motion.links["rocker"]
    later = replace(rocker, omega=np.nextafter(rocker.omega, np.inf))
    other = replace(own, motion=replace(own.motion, links={**own.motion.links, "rocker": later}))
    assert difference(FOURBAR, own, other) == (0.0, False)
    assert difference(FOURBAR, own, own) == (0.0, True)


def test_runs_of_other_lengths_differ_without_bound() -> None:
    own = worlds()[0]
    half = own.motion.each_series(lambda series: series[:20])
    short = replace(own, motion=replace(half, time_s=own.motion.time_s[:20]))
    for other in (short, replace(own, motion=None)):
        assert difference(FOURBAR, own, other) == (np.inf, False)


@pytest.mark.parametrize(("count", "chosen"), [(1, (0,)), (3, (0, 1, 2)), (16, tuple(range(16)))])
def test_few_worlds_are_all_run_alone(count: int, chosen: tuple[int, ...]) -> None:
    assert evenly(count) == chosen


def test_many_worlds_are_tried_alone_from_the_first_to_the_last() -> None:
    chosen = evenly(256)
    assert len(set(chosen)) == MOST_ALONE
    assert (chosen[0], chosen[-1]) == (0, 255)
    assert set(np.diff(chosen)) == {17}
