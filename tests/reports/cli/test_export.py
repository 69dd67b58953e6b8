"""`crankcheck export` of what is let go, or bends: a model that runs as it is."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest

from analytic.elastic.discretisation import Modes
from analytic.elastic.elastic_motion import DrivenElasticMotion
from analytic.free.release import release
from models.files import load_scene
from tests.worlds.command_line import crank


@pytest.mark.parametrize("name", ["fourbar-swing", "double-pendulum"])
def test_a_model_that_is_let_go_moves_as_its_masses_say(name: str) -> None:
    told = crank("export", name)
    assert told.exit_code == 0
    model = mujoco.MjModel.from_xml_string(told.output)
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    while data.time < 0.2:
        mujoco.mj_step(model, data)
    scene = load_scene(name)
    truth = release(scene, 0.21).at(np.array([data.time]))
    for link, moved in truth.links.items():
        rotation = data.body(link).xmat.reshape(3, 3)
        turn = np.arctan2(rotation[1, 0], rotation[0, 0]) - moved.theta[0]
        assert abs(np.remainder(turn + np.pi, 2.0 * np.pi) - np.pi) < 1e-4


def test_an_elastic_link_is_exported_as_the_segments_that_bend() -> None:
    told = crank("export", "fourbar-elastic")
    assert told.exit_code == 0
    model = mujoco.MjModel.from_xml_string(told.output)
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    assert model.nbody == 1 + 2 + 16  # the world, crank and rocker, segments
    while data.time < 0.02:
        mujoco.mj_step(model, data)
    by = DrivenElasticMotion(load_scene("fourbar-elastic"), 1.0, Modes(3), "periodic", True)
    truth = by.at(np.array([data.time])).links["rocker"]
    rotation = data.body("rocker").xmat.reshape(3, 3)
    turn = np.arctan2(rotation[1, 0], rotation[0, 0]) - truth.theta[0]
    assert abs(np.remainder(turn + np.pi, 2.0 * np.pi) - np.pi) < 1e-5


def test_elastic_links_that_are_let_go_are_exported_as_segments_at_rest() -> None:
    """What acts comes from outside, as the file says; without it the machine stays where it is."""
    told = crank("export", "fourbar-elastic-pulse")
    assert told.exit_code == 0
    model = mujoco.MjModel.from_xml_string(told.output)
    assert model.nbody == 1 + 2 + 16
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_step(model, data, 20)
    assert np.abs(data.qvel).max() < 1e-9
