"""What a scene holds cannot be changed, here or in another process."""

from __future__ import annotations

import copy
import operator
import pickle
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest

from models.files import load_scene


@pytest.mark.parametrize("change", [
    lambda mapping: operator.setitem(mapping, "E", (0.0, 0.0)),
    lambda mapping: operator.delitem(mapping, next(iter(mapping))),
    lambda mapping: operator.ior(mapping, {"E": (0.0, 0.0)}),
    lambda mapping: mapping.update(E=(0.0, 0.0)),
    lambda mapping: mapping.setdefault("E", (0.0, 0.0)),
    lambda mapping: mapping.pop(next(iter(mapping))),
    lambda mapping: mapping.popitem(),
    lambda mapping: mapping.clear(),
])  # fmt: skip
def test_a_scene_is_not_changed(change: Callable[[Any], object]) -> None:
    scene = load_scene("fourbar-lecture-1")
    for each in (scene, copy.deepcopy(scene), pickle.loads(pickle.dumps(scene))):
        assert each == scene
        rocker = each.links["rocker"].points
        for mapping in (each.ground, each.links, each.branch, rocker, each.pins):
            with pytest.raises(TypeError, match="make another one"):
                change(mapping)


def test_it_is_made_anew_and_what_it_was_made_of_is_its_own() -> None:
    given = {"A": (0.0, 0.0), "D": (0.2, 0.0)}
    scene = replace(load_scene("fourbar-lecture-1"), ground=given)
    given["D"] = (0.3, 0.0)
    assert scene.ground == {"A": (0.0, 0.0), "D": (0.2, 0.0)}
    moved = replace(scene, ground={**scene.ground, "D": (0.25, 0.0)})
    assert moved.ground["D"] == (0.25, 0.0)
