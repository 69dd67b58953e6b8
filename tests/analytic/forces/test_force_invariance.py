"""Forces of a mechanism turned, moved, mirrored, scaled or sped up are those of before, carried.

With them goes what acts on it: loads of every law, over time, angle and displacement, on one stroke
or on both.
"""

import random
from dataclasses import replace

import numpy as np
import pytest

from analytic.forces import kinetostatics
from analytic.structure.mobility import sides_of
from models.files.reading import load_scene, shipped
from models.motion import Forces
from models.scene import Scene, moved
from models.scene.characteristics import Characteristic, Constant, Polynomial, Sine
from models.scene.loads import ConstantFriction, CoulombFriction
from models.scene.tabulated import Tabulated
from tests.analytic.forces.beside import apart, turn, unlocked
from tests.worlds.loading import loaded, sprung
from tests.worlds.other_way import MOVES, Change, faster
from tests.worlds.tiers import slowly

CLOSE = 1e-11
CHANGES = MOVES | {"faster": faster(50.0), "the other way": faster(-1.0)}
LOADED = ("shaper", "tangent", "scotch-yoke")


@pytest.mark.parametrize("name", shipped("forces"))
@pytest.mark.parametrize("change", CHANGES)
def test_forces_go_with_the_scene(name: str, change: str) -> None:
    scene = load_scene(name)
    if CHANGES[change].fast < 0.0:
        scene = replace(scene, friction={})  # which turns round as well
    _goes_with(scene, CHANGES[change])


@pytest.mark.parametrize(
    "seeds", [range(1), slowly(range(1, 8), reason="loads at random")], ids=len
)
@pytest.mark.parametrize("change", CHANGES)
@pytest.mark.parametrize("name", LOADED)
def test_forces_of_any_loads_and_springs_go_with_the_scene(
    name: str, change: str, seeds: range
) -> None:
    for seed in seeds:
        _goes_with(loaded(load_scene(name), random.Random(seed)), CHANGES[change])
        if CHANGES[change].fast > 0.0:
            _goes_with(sprung(load_scene(name), random.Random(seed)), CHANGES[change])


def _goes_with(scene: Scene, change: Change) -> None:
    time_s = unlocked(scene, turn(scene))[::3]
    found = kinetostatics.forces(change.of(scene), time_s / change.fast)
    assert apart(_expected(kinetostatics.forces(scene, time_s), change), found) <= CLOSE


def _expected(old: Forces, by: Change) -> Forces:
    """The forces of the changed scene, from those of the scene."""
    force = by.grow**2 * by.fast**2
    couple = by.side * by.grow * force
    turned = old.each_series(lambda each: each if each.ndim == 1 else force * by.turned(each))
    sliders = {
        name: replace(one, normal=by.side * force * one.normal, moment=couple * one.moment)
        for name, one in old.sliders.items()
    }
    friction = {n: (force if n in sliders else couple) * one for n, one in old.friction.items()}
    return replace(turned, sliders=sliders, torque=couple * old.torque, friction=friction)


ROWS = (-2.0, -0.5, 1.0, 2.0), (1.0, -1.0, 4.0, 3.0)
CHARACTERISTICS = (
    Constant(3.0), Sine(2.0, 1.5, 0.4), Polynomial((1.0, -0.5, 0.25, 2.0)),
    Tabulated(*ROWS, "linear"), Tabulated(*ROWS, "pchip"),
    Tabulated((0.1, 0.5, 1.0), (1.0, -1.0, 4.0), "pchip", 1.3),
)  # fmt: skip


@pytest.mark.parametrize("own", CHARACTERISTICS, ids=lambda own: type(own).__name__)
@pytest.mark.parametrize(("stretch", "shift"), [(1.0, 0.7), (-1.0, 0.0), (0.1, 0.0), (-3.0, 0.2)])
def test_a_characteristic_is_carried(own: Characteristic, stretch: float, shift: float) -> None:
    x = np.linspace(-2.0, 2.0, 41)
    found = own.carried(-2.0, stretch=stretch, shift=shift).at(stretch * x + shift)
    np.testing.assert_allclose(found, -2.0 * own.at(x), rtol=1e-12, atol=1e-12)


def test_friction_grows_with_the_scene() -> None:
    """As forces and lengths do; what is over nothing stays."""
    constant = {"B": ConstantFriction("B", 3.0), "C": ConstantFriction("C", 5.0)}
    own = {"A": CoulombFriction("A", 0.1, 0.02), **constant}
    scene = replace(load_scene("slider-crank-central"), friction=own)
    grown = {"B": ConstantFriction("B", 3000.0), "C": ConstantFriction("C", 500.0)}
    larger = {"A": CoulombFriction("A", 0.1, 0.2), **grown}
    assert dict(moved.scaled(scene, 10.0).friction) == larger
    assert dict(moved.mirrored(scene, sides_of(scene)).friction) == own
