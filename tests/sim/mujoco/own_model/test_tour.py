"""A model held in the poses of its closed form: what MuJoCo sees there is what was read."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from analytic.kinematics import solve
from models.scene import Scene
from sim.mujoco.own_model.fault import ModelError
from sim.mujoco.own_model.read import ReadModel, read_model
from sim.own_models import Tour
from tests.worlds.own_four_bar import HEALTHY


def held(own: ReadModel, scene: Scene) -> Tour:
    motion = solve(scene, np.linspace(0.0, 6.28, 9), bound=False)
    return own.tour(scene, [motion.state(index) for index in range(9)])


def test_a_model_that_was_misread_is_not_run(tmp_path: Path) -> None:
    path = tmp_path / "model.xml"
    path.write_text(HEALTHY, encoding="utf-8")
    own = read_model(path, "A")
    assert held(own, own.scene) == Tour({}, [])
    coupler = own.scene.links["coupler"]
    (x, y) = coupler.points["C"]
    longer = replace(coupler, points={**coupler.points, "C": (x + 1e-5, y)})
    other = replace(own.scene, links={**own.scene.links, "coupler": longer})
    with pytest.raises(ModelError, match=r"loop C: closed in the closed form .* misread"):
        held(own, other)
