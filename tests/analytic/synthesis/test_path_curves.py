"""Coupler curves: their derivatives, limits, cognates, and the order of angles."""

from __future__ import annotations

import math

import numpy as np
import pytest

from analytic.kinematics import solve_driven
from analytic.synthesis.path.candidate import in_order
from analytic.synthesis.path.coupler_curve import CouplerCurve, assembled, cognates
from analytic.synthesis.path.fit import Fitted, _Problem, placed
from analytic.synthesis.path.path_draft import drafted
from analytic.synthesis.path.spread import spread
from analytic.synthesis.path.task import UnitPath
from analytic.synthesis.path.timed_starts import _costs, timed_starts
from analytic.synthesis.path.unit_four_bar import (
    BOUNDS,
    FULL,
    Family,
    closes_between,
    direction,
    family_of,
    least_sine,
    lengths,
)
from models.array import Array
from tests.analytic.synthesis.random_paths import random_curve, random_path

FAMILIES: tuple[Family, ...] = (*FULL, "limited")


def shapes(family: Family, count: int) -> Array:
    low, high = np.array(BOUNDS[family]).T
    return np.asarray(low[:, None] + (high - low)[:, None] * spread(count, 3, seed=1).T)


@pytest.mark.parametrize("family", FAMILIES)
@pytest.mark.parametrize("timed", [True, False])
def test_the_derivatives_are_those_of_the_residuals(family: Family, timed: bool) -> None:
    rng = np.random.default_rng(2)
    for _ in range(8):
        points = rng.normal(size=7) + 1j * rng.normal(size=7)
        path = UnitPath(points, np.linspace(0.0, 3.0, 7) if timed else None)
        problem = _Problem(family, path, transmission_rad=0.7)
        z = np.concatenate([0.4 * rng.normal(size=9), 6.0 * rng.random(1 if timed else 7)])
        step = 1e-6
        rows = [
            (problem.residuals(z + step * e) - problem.residuals(z - step * e)) / (2.0 * step)
            for e in np.eye(len(z))
        ]
        exact = problem.jacobian(z)
        near = np.abs(exact) < 1e3  # near a limit they are boundless
        assert exact.shape == (len(rows[0]), len(z))
        assert np.array(rows).T[near] == pytest.approx(exact[near], rel=1e-5, abs=2e-5)


@pytest.mark.parametrize("family", FULL)
def test_the_numbers_of_a_shape_keep_a_crank_that_turns_fully(family: Family) -> None:
    a, b, c = lengths(family, shapes(family, 500))
    for each in zip(a.tolist(), b.tolist(), c.tolist(), strict=True):
        assert family_of(*each) == family
        short, long_ = min(*each, 1.0), max(*each, 1.0)
        assert short in (each[0], 1.0)
        assert 2.0 * (short + long_) < sum(each) + 1.0  # Grashof's rule


def test_limits_and_transmission_angles_are_those_of_many_looks() -> None:
    rng = np.random.default_rng(5)
    seen = [0, 0]
    for _ in range(300):
        a, b, c = np.exp(rng.uniform(-1.5, 1.5, 3)).tolist()
        low = rng.uniform(-7.0, 7.0)
        high = low + rng.uniform(0.1, 5.0)
        look = np.linspace(low, high, 4001)
        rho = np.abs(1.0 - a * np.exp(1j * look))
        closes = bool(np.all((rho > abs(b - c)) & (rho < b + c)))
        assert closes_between((a, b, c), low, high) == closes
        seen[closes] += 1
        if closes:
            cosine = (b**2 + c**2 - rho**2) / (2.0 * b * c)
            least = float(np.sqrt(np.min(1.0 - cosine**2)))
            assert least_sine((a, b, c), low, high) == pytest.approx(least, abs=2e-3)
    assert min(seen) > 40


@pytest.mark.parametrize("seed", range(6))
def test_a_coupler_curve_is_that_of_the_reference(seed: int) -> None:
    one = random_curve(np.random.default_rng(seed))
    draft = drafted("curve", "a test", one).driven({"link": "input", "speed_rad_s": 1.0})
    found = []
    for sign in (1, -1):
        scene = draft.scene
        key = next(iter(scene.branch), "B")
        scene = draft.with_branch({key: sign}).scene
        angles = np.linspace(0.0, 6.0, 25)
        motion = solve_driven(scene, angles, np.ones(1), np.zeros(1), bound=False)
        place = motion.points["P"].position
        found.append(float(np.max(np.abs(place[:, 0] + 1j * place[:, 1] - one.at(angles)))))
    assert min(found) < 1e-12 * max(1.0, one.size) < max(found)


def test_cognates_draw_the_same_curve() -> None:
    rng = np.random.default_rng(8)
    full = 0
    for _ in range(20):
        one = random_curve(rng)
        for angle in (0.3, 2.0, 5.1):
            place = one.at(np.array([angle]))[0]
            found = cognates(one, angle)
            assert len(found) == 5
            for other, at in found:
                assert other.at(np.array([at]))[0] == pytest.approx(place, abs=1e-11)
        starts = cognates(one, 0.3)
        for k, (other, _) in enumerate(starts):
            again = cognates(one, 2.0)[k][0]
            assert again.size == pytest.approx(other.size)
            assert again.sign == other.sign or other.family == "limited"
            full += other.family != "limited"
    # Of the other two, one has a crank where the given one is a crank-rocker, driven at one pivot;
    # of a drag link all have, at both.
    assert full >= 20


def test_a_coupler_point_on_a_pin_has_no_cognates() -> None:
    assert not cognates(CouplerCurve(0j, 1.0 + 0j, 0.3, 0.8, 0.9, 0.8 + 0j, 1), 0.4)


def test_assembling_keeps_all_places() -> None:
    rng = np.random.default_rng(1)
    for _ in range(20):
        o2, a, b, o4, p = rng.normal(size=5) + 1j * rng.normal(size=5)
        one, angle = assembled(o2, a, b, o4, p)
        first, second = (pin[0] for pin in one.pins(np.array([angle])))
        assert [first, second] == pytest.approx([a, b])
        assert one.at(np.array([angle]))[0] == pytest.approx(p)


def test_angles_in_order_are_the_nearest_ones() -> None:
    grows = np.array([0.0, 0.5, 1.0, 2.0])
    assert in_order(grows) == pytest.approx(grows, abs=1e-5)
    assert in_order(-grows) == pytest.approx(-grows, abs=1e-5)
    mended = in_order(np.array([0.0, 1.0, 0.6, 2.0]))
    assert mended == pytest.approx([0.0, 0.8, 0.8, 2.0], abs=1e-5)
    assert np.all(np.diff(mended) > 0.0)


def test_the_look_at_timed_shapes_tells_the_least_sum_of_squares() -> None:
    _, _, task = random_path(3, 11, timed=True, closed=True, noise=0.1)
    path = task.unit
    assert path.turned is not None
    x, start = shapes("crank-rocker", 40), np.linspace(0.0, 6.0, 40)
    cost = _costs(path, "crank-rocker", x, start)
    told = 0
    for k in np.flatnonzero(np.isfinite(cost)):
        phi = start[k] + path.turned
        a, b, c = lengths("crank-rocker", x[:, k])
        origin, ground, arm = placed((a, b, c), phi, path.points)
        u, _ = direction((a, b, c), phi)
        off = origin + ground * a * np.exp(1j * phi) + arm * u - path.points
        assert cost[k] == pytest.approx(float(np.sum(np.abs(off) ** 2)), rel=1e-6)
        told += 1
    assert told > 20


def test_timed_starts_are_the_better_the_earlier_and_apart() -> None:
    _, _, task = random_path(3, 11, timed=True, closed=True)
    starts = timed_starts(task.unit, 10, 0, limited=False)
    costs = [start.cost for start in starts]
    assert costs == sorted(costs)
    assert isinstance(starts[0], Fitted)
    assert {start.family for start in starts} <= set(FULL)
    assert math.isfinite(costs[-1])


def test_numbers_are_spread_evenly() -> None:
    points = spread(4096, 2, seed=3)
    counts, _, _ = np.histogram2d(*points.T, bins=8, range=[[0, 1], [0, 1]])
    assert np.max(np.abs(counts - 64)) < 8  # of random ones it is over 20
    assert not np.allclose(points, spread(4096, 2, seed=4))
