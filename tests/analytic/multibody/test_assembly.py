"""Constraint equations and their derivatives, against differences."""

from __future__ import annotations

import numpy as np
import pytest

from analytic.kinematics import solve
from analytic.multibody.assembly import Assembly
from models.files import load_scene, shipped
from tests.analytic.chain import coordinates

STEP = 1e-6


@pytest.mark.parametrize("name", [*shipped(), *shipped("forces")])
def test_derivatives_are_those_of_the_equations(name: str) -> None:
    scene = load_scene(name)
    assembly = Assembly(scene)
    at = 0.3 * scene.driver.law.period_s
    q = np.array(coordinates(scene, solve(scene, np.array([at]), bound=False), 0))
    rates = np.cos(np.arange(len(q)))  # no rates that joints allow: what they are open counts too
    sides = [assembly.at_rates((q + e * rates)[None], rates[None]) for e in (-STEP, STEP)]
    now = assembly.at_rates(q[None], rates[None])
    assert np.abs(assembly.joints.gaps(now)).max() < 1e-13
    slope = (assembly.joints.gaps(sides[1]) - assembly.joints.gaps(sides[0]))[0] / (2 * STEP)
    rows = assembly.joints.jacobian(now)[0]
    assert slope == pytest.approx(rows @ rates, abs=1e-8)
    # d/dt (Phi_q q') = Phi_q q'' - gamma, and here q'' is 0.
    flow = [(assembly.joints.jacobian(side)[0] @ rates) for side in sides]
    assert (flow[1] - flow[0]) / (2 * STEP) == pytest.approx(
        -assembly.joints.gamma(now)[0], abs=1e-7
    )
    places = (sides[1].place - sides[0].place) / (2 * STEP)
    assert places == pytest.approx(now.velocity, abs=1e-8)
    drift = (sides[1].velocity - sides[0].velocity) / (2 * STEP)
    assert drift == pytest.approx(now.drift, abs=1e-8)


def test_samples_at_once_are_those_one_by_one() -> None:
    scene = load_scene("shaper")
    assembly = Assembly(scene)
    motion = solve(scene, np.linspace(0.0, 0.5, 3), bound=False)
    q = np.array([coordinates(scene, motion, i) for i in range(3)])
    whole = assembly.at_rates(q, np.ones_like(q))
    for i in range(3):
        one = assembly.at_rates(q[i : i + 1], np.ones((1, assembly.size)))
        assert np.array_equal(assembly.joints.jacobian(whole)[i], assembly.joints.jacobian(one)[0])
        assert np.array_equal(assembly.joints.gamma(whole)[i], assembly.joints.gamma(one)[0])
