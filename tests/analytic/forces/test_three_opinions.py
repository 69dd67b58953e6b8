"""Forces by groups, by multipliers of all constraints, and by power: three computations."""

import random
from dataclasses import replace

import numpy as np
import pytest

from analytic.dyads.plane import EPS
from analytic.forces import kinetostatics
from analytic.forces.virtual_power import torque_by_power
from analytic.kinematics import solve
from analytic.prepared import prepared
from models.array import Array
from models.files.reading import load_scene, parse_scene, shipped
from models.motion import Forces, Motion
from models.scene import Driver, Scene
from models.scene.laws import Accelerating
from tests.analytic.assur.triad_scenes import KINDS, triad
from tests.analytic.forces.beside import (
    AGREED,
    agreed,
    apart,
    out_of_balance,
    series,
    turn,
    unlocked,
)
from tests.analytic.imported import reached
from tests.second_opinions import multipliers
from tests.second_opinions.constraints import Constraints
from tests.worlds.loading import loaded, loaded_mechanism, sprung
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


@pytest.mark.parametrize("heavy", [False, True], ids=["as shipped", "loaded"])
@pytest.mark.parametrize("name", [*shipped(), *shipped("forces")])
def test_three_computations_agree_over_a_turn(name: str, heavy: bool) -> None:
    scene = load_scene(name)
    if heavy:
        scene = loaded(scene, random.Random(name))
    found, other = agreed(scene, unlocked(scene, turn(scene)))
    assert not np.array_equal(found.torque, other.torque), "bit for bit: the same computation?"


@pytest.mark.parametrize(
    "seeds", [range(1), slowly(range(1, 6), reason="springs at random")], ids=len
)
@pytest.mark.parametrize("name", [*shipped(), *shipped("forces")])
def test_three_computations_agree_with_springs(name: str, seeds: range) -> None:
    for seed in seeds:
        scene = sprung(load_scene(name), random.Random(seed))
        time_s = unlocked(scene, turn(scene))
        plain = kinetostatics.forces(replace(scene, springs={}), time_s)
        assert apart(agreed(scene, time_s)[0], plain) > 1e3 * AGREED


@pytest.mark.parametrize("count", [16, slowly(200, reason="random mechanisms")])
@pytest.mark.parametrize("springs", [False, True], ids=["loads", "springs"])
def test_random_mechanisms_agree_with_the_multipliers(springs: bool, count: int) -> None:
    """Off their dead points; springs on moving guides and on blocks among them."""
    for number in range(0, count, 2):
        scene, _ = loaded_mechanism(number)
        if springs:
            scene = sprung(scene, random.Random(number))
        agreed(scene, np.linspace(0.01, 1.0, 5) * scene.driver.law.period_s, number)


def _by_power(scene: Scene, time_s: Array) -> tuple[Array, Array]:
    """Torque and its bound, of a few samples."""
    ((_, chunk),) = kinetostatics.chunks(scene, time_s, bound=True)
    unit = kinetostatics.unit_chunk(scene, chunk.theta, bound=True)
    free = kinetostatics.free_bodies(scene, chunk)
    kinetostatics.apply_loads(scene, chunk, time_s, free)
    torque = torque_by_power(free, unit, chunk)
    return torque.value, torque.error


@pytest.mark.parametrize("name", DRIVEN)
def test_whatever_drives_has_the_forces_of_the_multipliers(name: str) -> None:
    scene = DRIVEN[name]
    time_s = np.linspace(0.0, 0.9 * scene.driver.law.period_s, 7)
    found = kinetostatics.forces(scene, time_s)
    assert apart(found, multipliers.forces(scene, solve(scene, time_s))) <= AGREED
    torque, off = _by_power(scene, time_s)
    assert np.all(np.abs(found.torque - torque) <= found.bound.torque + off)


@pytest.mark.parametrize("name", ["shaper", "sixbar-watt", "tangent"])
def test_virtual_power_gives_the_torque_of_the_reactions(name: str) -> None:
    """Within the bounds of both; at rest too, where power says nothing."""
    scene = loaded(load_scene(name), random.Random(name))
    loads = {n: one for n, one in scene.loads.items() if one.stroke == "both"}
    driver = Driver(scene.driver.link, Accelerating(0.3, 0.0, 5.0))
    scene, time_s = replace(scene, driver=driver, loads=loads), np.linspace(0.0, 0.3, 7)
    found, (torque, off) = kinetostatics.forces(scene, time_s), _by_power(scene, time_s)
    assert np.all(np.abs(torque - found.torque) <= off + found.bound.torque)
    assert np.all(off < 1e-10 * np.abs(found.torque).max())


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


PARTS = [range(1000 * part, 1000 * (part + 1)) for part in range(8)]


@pytest.mark.parametrize(
    "numbers",
    [range(12), *(slowly(part, reason="one in a thousand is rarer") for part in PARTS)],
    ids=str,
)
def test_two_methods_are_nowhere_further_apart_than_their_bounds(numbers: range) -> None:
    """In random mechanisms of all dyads, on fixed and moving guides, half of them near a dead
    point."""
    for number in numbers:
        scene, near = loaded_mechanism(number)
        inside = np.linspace(0.05, 0.95, 3) * scene.driver.law.period_s
        time_s = np.array([0.0]) if near else inside
        motion, found = solve(scene, time_s), kinetostatics.forces(scene, time_s)
        other, rounded = (dict(series(each)) for each in _multipliers(scene, motion))
        bounds = dict(series(found.bound))
        for name, ours in series(found):
            off, rounding = _length(ours - other[name]), _length(rounded[name])
            ratio = float(np.max(off / (2.0 * bounds[name] + rounding)))
            assert ratio <= 1.0, f"mechanism {number}, {name}: {ratio:.3g} times what may be"


def _multipliers(scene: Scene, motion: Motion) -> tuple[Forces, Forces]:
    """The forces by multipliers, which carry no bounds, and what rounding may do to each: from the
    matrix of each sample, component by component (R. D. Skeel, Scaling for numerical stability in
    Gaussian elimination, J. ACM 26, 1979), eps |A^-1| (|A| |x| + |b|), which grows towards dead
    points as the bounds do."""
    system = multipliers.equations(scene, motion)
    turned = np.swapaxes(system.jacobian, 1, 2)
    q, x = system.accelerations()[:, :, None], system.multipliers()[:, :, None]
    by_q = EPS * _skeel(system.jacobian, q, system.gamma[:, :, None])
    inertia = np.abs(system.mass)
    right = np.abs(system.applied)[:, :, None] + inertia @ (np.abs(q) + by_q / EPS)
    off = EPS * (_skeel(turned, x, right) + np.abs(x).max(axis=1, keepdims=True))
    held, time_s = system.constraints, motion.time_s
    found = multipliers.reactions(held, time_s, -x[:, :, 0])
    return found, multipliers.reactions(held, time_s, off[:, :, 0])


def _skeel(matrix: Array, x: Array, right: Array) -> Array:
    return np.abs(np.linalg.inv(matrix)) @ (np.abs(matrix) @ np.abs(x) + np.abs(right))


def _length(series: Array) -> Array:
    """Of every sample (T,) of numbers or of vectors."""
    return np.abs(series) if series.ndim == 1 else np.hypot(*series.T)


def test_no_computation_imports_another() -> None:
    assert not any("opinions" in name for name in reached("analytic.forces.kinetostatics"))
    for opinion in ("tests.second_opinions.multipliers", "tests.second_opinions.power"):
        rooms = {".".join(name.split(".")[:2]) for name in reached(opinion)}
        assert rooms <= {"tests.second_opinions", "analytic.multibody"}
    assert "tests.second_opinions.constraints" not in reached("tests.second_opinions.power")


def test_a_fault_in_one_of_them_makes_them_disagree(monkeypatch: pytest.MonkeyPatch) -> None:
    scene = load_scene("shaper")
    time_s = turn(scene)
    motion = solve(scene, time_s)
    right = kinetostatics.forces(scene, time_s)
    jacobian = Constraints.jacobian

    def spoilt(self: Constraints, q: Array) -> Array:
        rows = jacobian(self, q)
        rows[:, 5] *= 1.0 + 1e-9  # the arms of the lever
        return rows

    with monkeypatch.context() as m:
        m.setattr(Constraints, "jacobian", spoilt)
        assert apart(right, multipliers.forces(scene, motion)) > AGREED
    wrong = kinetostatics.forces(replace(scene, gravity_m_s2=(0.0, 1e-8)), time_s)
    assert apart(wrong, multipliers.forces(scene, motion)) > AGREED
    assert out_of_balance(scene, time_s, wrong) > AGREED
