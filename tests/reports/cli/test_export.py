"""`crankcheck export` of what is let go, or bends: a model that runs as it is."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest

from analytic.elastic.discretisation import Modes
from analytic.elastic.elastic_motion import DrivenElasticMotion
from analytic.free.release import release
from models.files import load_scene
from models.motion import Motion
from tests.worlds.command_line import crank


def exported(name: str) -> tuple[mujoco.MjModel, mujoco.MjData]:
    """The model that is printed, as its keyframe has it."""
    told = crank("export", name)
    assert told.exit_code == 0
    model = mujoco.MjModel.from_xml_string(told.output)
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    return model, data


def off_rad(data: mujoco.MjData, link: str, truth: Motion) -> float:
    """How far a link is turned from the truth of one instant [rad]."""
    rotation = data.body(link).xmat.reshape(3, 3)
    turn = np.arctan2(rotation[1, 0], rotation[0, 0]) - truth.links[link].theta[0]
    return float(abs(np.remainder(turn + np.pi, 2.0 * np.pi) - np.pi))


@pytest.mark.parametrize("name", ["fourbar-swing", "double-pendulum"])
def test_a_model_that_is_let_go_moves_as_its_masses_say(name: str) -> None:
    model, data = exported(name)
    while data.time < 0.2:
        mujoco.mj_step(model, data)
    truth = release(load_scene(name), 0.21).at(np.array([data.time]))
    assert max(off_rad(data, link, truth) for link in truth.links) < 1e-4


def test_an_elastic_link_is_exported_as_the_segments_that_bend() -> None:
    model, data = exported("fourbar-elastic")
    assert model.nbody == 1 + 2 + 16  # the world, crank and rocker, segments
    while data.time < 0.02:
        mujoco.mj_step(model, data)
    by = DrivenElasticMotion(load_scene("fourbar-elastic"), 1.0, Modes(3), "periodic", True)
    assert off_rad(data, "rocker", by.at(np.array([data.time]))) < 1e-5


def test_elastic_links_that_are_let_go_are_exported_as_segments_at_rest() -> None:
    """What acts comes from outside, as the file says; without it the machine stays where it is."""
    model, data = exported("fourbar-elastic-pulse")
    assert model.nbody == 1 + 2 + 16
    mujoco.mj_step(model, data, 20)
    assert np.abs(data.qvel).max() < 1e-9
