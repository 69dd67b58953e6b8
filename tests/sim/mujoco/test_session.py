"""How a session of MuJoCo comes about."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from analytic.kinematics import solve
from models import mjcf_friction, tree
from models.files import load_scene
from sim.mujoco import session
from sim.registry import engine
from sim.settings import resolved


def test_the_tree_is_planned_once(monkeypatch: pytest.MonkeyPatch) -> None:
    plans: list[object] = []

    def counted(*args: Any, **options: Any) -> tree.Tree:
        plans.append(args)
        return tree.plan(*args, **options)

    for module in (mjcf_friction, session):
        monkeypatch.setattr(module, "plan", counted)
    scene, mujoco = load_scene("fourbar-lecture-1"), engine("mujoco")
    settings = resolved(mujoco.profiles["tuned"], {"close": "B"})
    mujoco.open(scene, solve(scene, np.zeros(1)).state(), settings, 1e-3, "prescribed")
    assert len(plans) == 1
