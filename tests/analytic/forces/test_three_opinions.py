"""Forces by groups, by multipliers of all constraints, and by power: three computations. And forces
of a mechanism that is turned, moved, mirrored, scaled or sped up are those of before, carried."""

import random
from dataclasses import replace

import numpy as np
import pytest

from analytic.forces import kinetostatics
from analytic.forces.virtual_power import torque_by_power
from analytic.kinematics import solve
from analytic.prepared import prepared
from analytic.structure.mobility import sides_of
from models.files.reading import load_scene, parse_scene, shipped
from models.motion import Forces
from models.scene import Scene, moved
from models.scene.characteristics import Characteristic, Constant, Polynomial, Sine
from models.scene.loads import ConstantFriction, CoulombFriction
from models.scene.tabulated import Tabulated
from tests.analytic.assur.triad_scenes import KINDS, triad
from tests.analytic.forces.beside import AGREED, agreed, apart, out_of_balance, turn, unlocked
from tests.analytic.test_bounds import SIX
from tests.second_opinions import multipliers
from tests.second_opinions.test_second_opinions import reached
from tests.worlds.loading import loaded, sprung
from tests.worlds.other_way import MOVES, Change, faster
from tests.worlds.tiers import few, slowly

CYLINDER = """
name = "cylinder"
source = "test"
ground = { points = { A = [0.0, 0.0], D = [0.6, -0.05], G = [0.45, 0.6] } }
sliders = { S = { link = "piston", point = "P", on = "barrel" } }
[links]
barrel = { points = { A = [0.0, 0.0], K = [0.15, 0.0] } }
piston = { points = { P = [0.0, 0.0], C = [0.15, 0.01] } }
leg2 = { bar = ["D", "E"], length_m = 0.3 }
leg3 = { bar = ["G", "F"], length_m = 0.3 }
plate = { points = { C = [0.0, 0.0], E = [0.25, -0.05], F = [0.12, 0.18] } }
[driver]
slider = "S"
law = "oscillating"
centre_m = 0.17
amplitude_m = 0.04
frequency_rad_s = 10.0
"""
DRIVEN = {name: load_scene(name) for name in shipped("structure")}
DRIVEN["cylinder in a leg"] = parse_scene(CYLINDER, "test")
SCENES = few([*shipped(), *shipped("forces")], [*SIX, *shipped("forces")], "the same dyads")


@pytest.mark.parametrize("name", SCENES)
def test_three_computations_agree_over_a_turn(name: str) -> None:
    scene = load_scene(name)
    if not scene.loads:
        scene = sprung(loaded(scene, random.Random(name)), random.Random(0))
    found, other = agreed(scene, unlocked(scene, turn(scene)))
    assert not np.array_equal(found.torque, other.torque), "bit for bit: the same computation?"


@pytest.mark.parametrize(
    "name", few(DRIVEN, shipped("structure"), "0.7 s: as a triad of the others")
)
def test_whatever_drives_has_the_forces_of_the_multipliers(name: str) -> None:
    scene = DRIVEN[name]
    time_s = np.linspace(0.0, 0.9 * scene.driver.law.period_s, 7)
    found = kinetostatics.forces(scene, time_s)
    assert apart(found, multipliers.forces(scene, solve(scene, time_s))) <= AGREED
    ((_, chunk),) = kinetostatics.chunks(scene, time_s, bound=True)
    free = kinetostatics.free_bodies(scene, chunk)
    kinetostatics.apply_loads(scene, chunk, time_s, free)
    unit = kinetostatics.unit_chunk(scene, chunk.theta, bound=True)
    torque = torque_by_power(free, unit, chunk)
    assert np.all(np.abs(found.torque - torque.value) <= found.bound.torque + torque.error)


QUICK = {("RR", "PR", "RP"), ("PR", "PR", "PP")}


@pytest.mark.parametrize(
    "kinds", few(KINDS, QUICK, "legs of each kind are among the few"), ids="-".join
)
def test_every_kind_of_triad_has_the_forces_of_the_multipliers(kinds: tuple[str, str, str]) -> None:
    scene, _ = triad(kinds, 4, crank_m=0.05)
    ends = prepared(scene).stretched(np.linspace(-0.3, 0.3, 61) + prepared(scene).start)
    short = np.ravel(ends.shortage["platform"])
    time_s = np.linspace(0.0, 0.02, 3) if short.max() > 0.0 else np.linspace(0.0, 0.25, 5)
    found = kinetostatics.forces(scene, time_s)
    assert apart(found, multipliers.forces(scene, solve(scene, time_s))) <= AGREED


def test_no_computation_imports_another() -> None:
    assert not any("opinions" in name for name in reached("analytic.forces.kinetostatics"))
    for opinion in ("tests.second_opinions.multipliers", "tests.second_opinions.power"):
        rooms = {".".join(name.split(".")[:2]) for name in reached(opinion)}
        assert rooms <= {"tests.second_opinions", "analytic.multibody"}
    assert "tests.second_opinions.constraints" not in reached("tests.second_opinions.power")


def test_a_fault_in_one_of_them_makes_them_disagree() -> None:
    scene = load_scene("shaper")
    time_s = turn(scene)
    wrong = kinetostatics.forces(replace(scene, gravity_m_s2=(0.0, 1e-8)), time_s)
    assert apart(wrong, multipliers.forces(scene, solve(scene, time_s))) > AGREED
    assert out_of_balance(scene, time_s, wrong) > AGREED


CLOSE = 1e-11
CHANGES = MOVES | {"faster": faster(50.0), "the other way": faster(-1.0)}
LOADED = ("shaper", "tangent", "scotch-yoke")


@pytest.mark.parametrize(
    "name", few(shipped("forces"), [*shipped("forces")][::3], "the same dyads")
)
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
