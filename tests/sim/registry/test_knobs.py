"""The knobs of the engines, and what they cost: the constants of that can be found again."""

import itertools
import math

import pytest

from benchmarks.step_cost import start
from models.files.reading import load_scene
from models.scene import Scene
from sim.exudyn import knobs as exudyn_knobs
from sim.exudyn.engine import ExudynSession
from sim.mujoco import knobs as mujoco_knobs
from sim.mujoco.knobs import EVALUATIONS
from sim.mujoco.settings import INTEGRATORS
from sim.pymunk import knobs as pymunk_knobs
from sim.pymunk.knobs import RAIL_US
from sim.registry import offering
from sim.registry.offers import Knob, Work, rungs, search_space
from tests.worlds.runs import ran, tuned

TUNABLE = offering("knobs")


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


@pytest.mark.parametrize("name", TUNABLE)
def test_the_engine_takes_the_values_and_holds_them(name: str) -> None:
    scene = load_scene("fourbar-lecture-1")
    space = search_space(name).around(tuned(name))
    for knob in space.knobs:
        for value in knob.values[::4]:
            settings = space.settings(tuned(name), {**space.starts[0], knob.name: value})
            done = ran(scene, name, dt_s=1e-3, steps=1, settings=settings)
            assert [done.asked[each] for each in knob.targets] == [value] * len(knob.targets)
            assert all(
                math.isclose(float(done.settings[each]), float(value))
                for each in knob.targets
                if knob.ordered
            )


def test_a_knob_goes_through_values_that_it_has_not() -> None:
    assert Knob("n", (1, 5, 9)).through(7, 5).values == (1, 5, 7, 9)
    assert Knob("word", ("b", "a")).through("c").values == ("b", "a", "c")


def test_rungs_are_round_and_about_as_far_apart_as_asked() -> None:
    found = rungs(2.0, 20.0, 1.06)
    assert (found[0], found[-1]) == (2.0, 20.0)
    assert all(value == float(f"{value:.2g}") for value in found)
    assert all(1.0 < b / a < 1.12 for a, b in itertools.pairwise(found))


MUJOCO, PYMUNK, EXUDYN = map(tuned, ("mujoco", "pymunk", "exudyn"))


def mujoco_work(scene: Scene) -> Work:
    return mujoco_knobs.work(scene, start(scene))


def pymunk_work(scene: Scene) -> Work:
    return pymunk_knobs.work(scene, start(scene))


def test_every_integrator_has_its_cost() -> None:
    assert set(EVALUATIONS) == set(INTEGRATORS)


def test_more_evaluations_bodies_and_loops_cost_more() -> None:
    four, six = (mujoco_work(load_scene(n)) for n in ("fourbar-lecture-1", "sixbar-watt"))
    assert six(MUJOCO) > four(MUJOCO) > 3.0 * four({**MUJOCO, "integrator": "implicitfast"})


def test_a_rail_costs_its_own_and_only_where_there_is_one() -> None:
    exact, groove = ({**PYMUNK, "iterations": 1, "lines": each} for each in ("exact", "groove"))
    fourbar, massless = (
        pymunk_work(load_scene(name)) for name in ("fourbar-lecture-1", "slider-crank-excel-210")
    )
    assert fourbar(exact) == fourbar(groove)
    assert massless(exact) - massless(groove) == pytest.approx(RAIL_US, rel=0.01)


def test_a_matrix_and_an_iteration_cost_as_much_as_the_mechanism_is_large() -> None:
    four, six = (
        exudyn_knobs.work(scene, start(scene))
        for scene in map(load_scene, ("fourbar-lecture-1", "sixbar-watt"))
    )
    assert four(EXUDYN) < four({**EXUDYN, "jacobian": "each-iteration"})
    assert four({**EXUDYN, "relative_tolerance": 1e-4}) < four(EXUDYN)
    assert 1.5 < six(EXUDYN) / four(EXUDYN) < 2.5


@pytest.mark.parametrize("name", ["fourbar-lecture-1", "slider-crank-excel-210", "shaper"])
def test_the_unknowns_are_those_of_the_engine(name: str) -> None:
    scene = load_scene(name)
    session = ExudynSession(scene, start(scene), EXUDYN, 1e-3, "prescribed")
    held = session._system.systemData
    assert exudyn_knobs.unknowns(scene) == held.ODE2Size() + held.AEsize()
