"""Where loops are closed: at heavy bodies where masses are unequal, else as ever, or as asked."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from analytic.kinematics import solve
from models import tree
from models.closings import closings
from models.files import load_scene, shipped
from models.motion import State
from models.scene import Scene
from models.tree import UNEQUAL, plan


def start_of(scene: Scene) -> State:
    return solve(scene, np.zeros(1), bound=False).state()


def weighed(name: str, **masses: float) -> Scene:
    """A scene with some of its links and blocks of other masses [kg]."""
    scene = load_scene(name)
    links = {n: replace(x, mass_kg=masses.get(n, x.mass_kg)) for n, x in scene.links.items()}
    sliders = {n: replace(x, mass_kg=masses.get(n, x.mass_kg)) for n, x in scene.sliders.items()}
    return replace(scene, links=links, sliders=sliders)


def closed(scene: Scene, *close: str) -> list[str]:
    return [closure.point for closure in plan(scene, start_of(scene), close).closures]


@pytest.mark.parametrize(("name", "masses", "point"), [
    ("slider-crank-offset", {}, "C"),
    ("slider-crank-offset", {"rod": 1e3}, "B"),  # between the crank, which is driven, and it
    ("slider-crank-offset", {"C": 1e3}, "B"),
    ("slider-crank-offset", {"crank": 1e3}, "B"),
    ("fourbar-lecture-1", {"rocker": 1e3}, "D"),
    ("fourbar-lecture-1", {"coupler": 1e3}, "B"),
    ("fourbar-lecture-1", {"coupler": 1e3, "rocker": 1e4}, "D"),
])  # fmt: skip
def test_a_loop_closes_where_its_bodies_are_heaviest(
    name: str, masses: dict[str, float], point: str
) -> None:
    assert closed(weighed(name, **masses)) == [point]


def test_a_pin_that_is_asked_for_is_closed_whatever_the_masses() -> None:
    assert closed(weighed("slider-crank-offset", rod=1e3), "C") == ["C"]


@pytest.mark.parametrize("name", sorted(shipped()))
def test_no_shipped_scene_is_closed_by_its_masses(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    scene = load_scene(name)
    before = plan(scene, start_of(scene))
    monkeypatch.setattr(tree, "UNEQUAL", math.inf)
    assert plan(scene, start_of(scene)) == before
    assert math.inf > UNEQUAL


def test_the_other_closings_are_each_another_and_none_is_the_default() -> None:
    fourbar, sixbar = load_scene("fourbar-lecture-1"), load_scene("sixbar-watt")
    assert set(closings(fourbar, start_of(fourbar))) == {("B",), ("D",)}
    found = [frozenset(closed(sixbar, *close)) for close in closings(sixbar, start_of(sixbar))]
    assert len(set(found)) == len(found) > 2
    assert frozenset(closed(sixbar)) not in found
