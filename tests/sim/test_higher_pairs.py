"""Gears and cams in the engines that crankcheck offers them in."""

import numpy as np
import pytest

from analytic.kinematics import solve
from models.files.reading import load_scene, shipped
from reports.judge.cell import check
from sim.run import run
from tests.worlds.engines import SIMPLE
from tests.worlds.runs import ran, start_of
from tests.worlds.tiers import few, slow
from tests.worlds.turns import of_turns

ENGINES = ("mujoco", "pymunk", "exudyn")
FEW = ("planetary", "sun-and-planet", "cam-rocker")


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize(
    "name", few([*shipped("gears"), *shipped("cams")], FEW, "the others are of the same kinds")
)
def test_a_tuned_engine_is_within_tolerance_with_forces(name: str, engine: str) -> None:
    found = check(of_turns(load_scene(name), engine, 360, with_forces=True))
    assert found.verdict == "within", found.failures


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("name", ["gear-train", "planetary"])
def test_loaded_gears_are_within_1e5_of_a_radian_at_a_millisecond(name: str, engine: str) -> None:
    scene = load_scene(name)
    motion = ran(scene, engine, dt_s=1e-3, steps=600).motion
    true = solve(scene, motion.time_s)
    for link, own in true.links.items():
        assert np.abs(motion.links[link].theta - own.theta).max() < 1e-5


@slow("three runs of each kind of law")
@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("name", ["cam-roller", "cam-rocker"])
def test_followers_are_within_1e4_of_the_stroke(name: str, engine: str) -> None:
    scene = load_scene(name)
    (pair,) = scene.cams.values()
    motion = ran(scene, engine, dt_s=scene.driver.law.period_s / 720, steps=1440).motion
    true = solve(scene, motion.time_s)
    if pair.slider:
        off = motion.sliders[pair.slider].displacement - true.sliders[pair.slider].displacement
    else:
        off = motion.links[pair.follower].theta - true.links[pair.follower].theta
    assert np.abs(off).max() < 1e-4 * pair.profile.law.stroke


@pytest.mark.parametrize("engine", SIMPLE)
@pytest.mark.parametrize(("name", "what"), [("planetary", "gears"), ("cam-flat", "cams")])
def test_other_engines_say_that_they_are_not_offered(engine: str, name: str, what: str) -> None:
    scene = load_scene(name)
    done = run(scene, start_of(scene), engine, dt_s=1e-3, steps=20)
    assert done.status == "unsupported"
    assert f"{what} (" in done.reason
    assert "not offered by crankcheck" in done.reason
