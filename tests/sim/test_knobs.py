"""The knobs of the engines."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest

from analytic.kinematics import solve
from models.files import load_scene
from sim.engine import SettingValue
from sim.registry import engine, offering
from sim.run import run
from sim.settings import profile_of, resolved
from sim.tuning import Knob, rungs, search_space
from tests.worlds.tiers import slowly

TUNABLE = offering("knobs")


def tuned(name: str) -> dict[str, SettingValue]:
    return resolved(profile_of(engine(name), "tuned"), None)


@pytest.mark.parametrize("name", TUNABLE)
def test_a_search_starts_at_the_profile_and_its_knobs_reach_every_start(name: str) -> None:
    space = search_space(name).around(tuned(name))
    assert space.settings(tuned(name), space.starts[0]) == tuned(name)
    assert len(space.starts) > 1
    for knob in space.knobs:
        assert all(start[knob.name] in knob.values for start in space.starts)
        assert len(set(knob.values)) == len(knob.values)
        if knob.ordered:
            assert list(knob.values) == sorted(knob.values, key=float)


@pytest.mark.parametrize("every", [4, slowly(1, reason="each of a hundred values of a knob")])
@pytest.mark.parametrize("name", TUNABLE)
def test_the_engine_takes_every_value_and_holds_it(name: str, every: int) -> None:
    scene = load_scene("fourbar-lecture-1")
    state = solve(scene, np.zeros(1)).state()
    space = search_space(name).around(tuned(name))
    for knob in space.knobs:
        for value in knob.values[::every]:
            settings = space.settings(tuned(name), {**space.starts[0], knob.name: value})
            done = run(scene, state, name, dt_s=1e-3, steps=1, settings=settings)
            assert [done.asked[each] for each in knob.targets] == [value] * len(knob.targets)
            assert all(
                math.isclose(float(done.settings[each]), float(value))
                for each in knob.targets
                if knob.ordered
            )


def test_values_of_several_settings_go_together() -> None:
    space = search_space("mujoco").around(tuned("mujoco"))
    found = space.settings(tuned("mujoco"), {**space.starts[0], "solimp": 0.95})
    assert found["solimp_dmin"] == found["solimp_dmax"] == 0.95


def test_a_knob_goes_through_values_that_it_has_not() -> None:
    assert Knob("n", (1, 5, 9)).through(7, 5).values == (1, 5, 7, 9)
    assert Knob("word", ("b", "a")).through("c").values == ("b", "a", "c")


def test_rungs_are_round_and_about_as_far_apart_as_asked() -> None:
    found = rungs(2.0, 20.0, 1.06)
    assert (found[0], found[-1]) == (2.0, 20.0)
    assert all(value == float(f"{value:.2g}") for value in found)
    assert all(1.0 < b / a < 1.12 for a, b in itertools.pairwise(found))
