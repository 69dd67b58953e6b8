"""Forces by groups, by multipliers of all constraints, and by power: three computations."""

from __future__ import annotations

import random
from dataclasses import replace

import numpy as np
import pytest

from analytic.check import multipliers
from analytic.check.constraints import Constraints
from analytic.forces import kinetostatics
from analytic.kinematics import solve
from models.array import Array
from models.files import load_scene, shipped
from tests.analytic.forces.beside import AGREED, apart, out_of_balance, turn, unlocked
from tests.analytic.imported import reached
from tests.worlds.loading import loaded, loaded_mechanism
from tests.worlds.tiers import slowly


@pytest.mark.parametrize("heavy", [False, True], ids=["as shipped", "loaded"])
@pytest.mark.parametrize("name", [*shipped(), *shipped("forces")])
def test_three_computations_agree_over_a_turn(name: str, heavy: bool) -> None:
    scene = load_scene(name)
    if heavy:
        scene = loaded(scene, random.Random(name))
    time_s = unlocked(scene, turn(scene))
    found = kinetostatics.forces(scene, time_s)
    other = multipliers.forces(scene, solve(scene, time_s))
    assert apart(found, other) <= AGREED
    assert out_of_balance(scene, time_s, found) <= AGREED
    assert not np.array_equal(found.torque, other.torque), "bit for bit: the same computation?"


@pytest.mark.parametrize("count", [16, slowly(200, reason="random mechanisms")])
def test_random_mechanisms_agree_with_the_multipliers(count: int) -> None:
    """Off their dead points."""
    for number in range(0, count, 2):
        scene, _ = loaded_mechanism(number)
        time_s = np.linspace(0.01, 1.0, 5) * scene.driver.law.period_s
        found = kinetostatics.forces(scene, time_s)
        assert apart(found, multipliers.forces(scene, solve(scene, time_s))) <= AGREED, number
        assert out_of_balance(scene, time_s, found) <= AGREED, number


def test_no_computation_imports_another() -> None:
    assert not any(".check" in name for name in reached("analytic.forces.kinetostatics"))
    for opinion in ("analytic.check.multipliers", "analytic.check.power"):
        rooms = {name.split(".")[1] for name in reached(opinion)}
        assert rooms <= {"check", "multibody"}
    assert "analytic.check.constraints" not in reached("analytic.check.power")


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
    heavier = replace(scene, gravity_m_s2=(0.0, 1e-8))
    wrong = kinetostatics.forces(heavier, time_s)
    assert apart(wrong, multipliers.forces(scene, motion)) > AGREED
    assert out_of_balance(scene, time_s, wrong) > AGREED
