"""Coulomb's friction in several joints: one solution, none, or two, and what is said of it."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from analytic.forces.coulomb import (
    SOLVED,
    CoulombErrors,
    CoulombSystem,
    coulomb_bound,
    solve_coulomb,
    solve_small,
    weights,
)
from models.array import Array


def drawn(count: int, m: int, gain: float, *, pins: bool, seed: int) -> CoulombSystem:
    """Random equations whose gains have about that spectral radius."""
    chance = np.random.default_rng(seed)
    alone, influence = chance.normal(size=(count, m, 2)), chance.normal(size=(count, m, m, 2))
    if not pins:
        alone[..., 1], influence[..., 1] = 0.0, 0.0
    return CoulombSystem(alone, influence, np.full(m, gain / m))


@pytest.mark.parametrize(
    ("alone", "influence", "solutions", "g", "rel"),
    [
        (10.0, 1.0, 1, 10.0, 1e-14),  # 0.5 (10 + g)
        (-10.0, 1.0, 1, 10.0 / 3.0, 1e-14),  # 0.5 (10 - g)
        (10.0, 4.0, 0, np.nan, 1e-14),  # 0.5 (10 + 4 g) runs ahead of g
        (-10.0, 4.0, 2, 5.0 / 3.0, 1e-14),  # 0.5 (10 - 4 g), or 0.5 (4 g - 10) = 5
        (10.0, -4.0, 2, 5.0 / 3.0, 1e-14),
        (10.0, 2.0 - 1e-9, 1, 1e10, 1e-6),  # just short of contracting no more
        (np.inf, 1.0, 1, np.nan, 1e-14),  # where reactions are no numbers nothing is said of it
    ],
)
def test_a_slider_has_one_solution_none_or_two(
    alone: float, influence: float, solutions: int, g: float, rel: float
) -> None:
    """It rubs by g = 0.5 |alone + influence g|."""
    reactions = np.array([[[alone, 0.0]]]), np.array([[[[influence, 0.0]]]])
    found = solve_coulomb(CoulombSystem(*reactions, np.array([0.5])))
    assert found.solutions[0] == solutions
    assert found.g[0, 0] == pytest.approx(g, rel=rel, nan_ok=True)


def test_a_pin_has_as_many_solutions_as_its_quadratic_equation() -> None:
    """(1 - rho^2 c^2) g^2 - 2 rho^2 (R c) g - rho^2 R^2 = 0 with g > 0."""
    system = drawn(400, 1, 1.5, pins=True, seed=3)
    found, rho = solve_coulomb(system), float(system.mu[0])
    for i, (r, c) in enumerate(zip(system.alone[:, 0], system.influence[:, 0, 0], strict=True)):
        roots = np.roots([1.0 - rho**2 * (c @ c), -2.0 * rho**2 * (r @ c), -(rho**2) * (r @ r)])
        real = sorted(x.real for x in roots if abs(x.imag) < 1e-12 and x.real > 0.0)
        assert found.solutions[i] == len(real), i
        if real:
            assert found.g[i, 0] == pytest.approx(real[0], rel=1e-9)
    assert {0.0, 1.0, 2.0} == set(found.solutions)


@pytest.mark.parametrize("m", [2, 3])
def test_sliders_have_the_solutions_that_trying_all_signs_finds(m: int) -> None:
    system = drawn(300, m, 1.3, pins=False, seed=m)
    found = solve_coulomb(system)
    for i in range(300):
        alone, influence = system.alone[i, :, 0], system.influence[i, :, :, 0]
        right = []
        for signs in itertools.product((1.0, -1.0), repeat=m):
            factor = system.mu * signs
            g = np.linalg.solve(np.eye(m) - factor[:, None] * influence, factor * alone)
            if np.all(g >= 0.0):
                right.append(g)
        assert found.solutions[i] == min(len(right), 2), i
        if right:
            least = min(right, key=np.sum)
            np.testing.assert_allclose(found.g[i], least, rtol=1e-8)
    assert {0.0, 1.0, 2.0} == set(found.solutions)


@pytest.mark.parametrize("gain", [0.3, 0.7])
def test_where_they_contract_substitution_leads_to_the_same(gain: float) -> None:
    system = drawn(100, 4, gain, pins=True, seed=1)
    inside = np.all(weights(system.gains()) > 0.0, axis=1)
    system = system.at(inside)
    assert inside.sum() > 20
    found = solve_coulomb(system)
    g = np.zeros_like(found.g)
    for _ in range(1500):
        g = system.friction(g)
    np.testing.assert_allclose(found.g, g, rtol=1e-11)
    assert np.all(found.solutions == 1)
    assert np.all(found.change <= 1e-13)
    assert np.max(found.iterations) < 30


def test_a_singular_system_spoils_no_other() -> None:
    matrices = np.array([np.eye(2), np.ones((2, 2)), 2.0 * np.eye(2)])
    x = solve_small(matrices, np.ones((3, 2)))
    np.testing.assert_array_equal(x[[0, 2]], [[1.0, 1.0], [0.5, 0.5]])
    assert np.isnan(x[1]).all()


def bounded(gain: float, off: float, error: float) -> tuple[Array, Array]:
    """What random equations, wrong by ``error`` at most, change the friction by; and its bound."""
    chance = np.random.default_rng(7)
    system = drawn(60, 3, gain, pins=True, seed=5)
    found = solve_coulomb(system)
    errors = CoulombErrors(np.full((60, 3), error), np.full((60, 3, 3), error), np.zeros((60, 3)))
    sizes = np.hypot(system.influence[..., 0], system.influence[..., 1])
    bound = coulomb_bound(system, errors, found.g, sizes)
    most = np.zeros_like(found.g)
    for _ in range(12):
        angles = chance.uniform(-np.pi, np.pi, (2, 60, 3, 4))
        push = off * np.stack([np.cos(angles), np.sin(angles)], -1)
        alone, influence = system.alone + push[0, :, :, 0], system.influence + push[1, :, :, :3]
        wrong = solve_coulomb(CoulombSystem(alone, influence, system.mu))
        most = np.fmax(most, np.abs(wrong.g - found.g))
    return most, bound


@pytest.mark.parametrize("gain", [0.3, 0.8])
def test_no_bound_is_broken_by_equations_that_are_as_wrong_as_said(gain: float) -> None:
    most, bound = bounded(gain, 1e-3, 1e-3)
    assert np.all(most <= bound)
    told = np.isfinite(bound)
    assert told.mean() > 0.3
    assert np.median(bound[told] / most[told]) < 30.0


def test_a_bound_for_less_than_that_is_broken() -> None:
    most, bound = bounded(0.3, 1e-2, 1e-3)
    assert np.any(most > bound)


def test_what_is_searched_leaves_little_open() -> None:
    found = solve_coulomb(drawn(300, 3, 2.0, pins=True, seed=9))
    some = found.solutions > 0
    assert np.nanmax(found.change[some]) <= SOLVED
    assert np.isnan(found.g[~some]).all()
