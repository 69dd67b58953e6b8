"""Bounds of forces, against fifty digits: random mechanisms and loads, half near a dead point."""

from __future__ import annotations

import math
import random
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
import pytest
from mpmath import mpf

from analytic.check.moved_scene import moved
from analytic.forces.kinetostatics import forces
from analytic.kinematics import solve
from models.array import Array
from models.files import load_scene, shipped
from models.forces import Forces
from models.motion import Motion
from models.scene import Scene
from tests.analytic.chain import Chain, coordinates
from tests.analytic.forces.exact_forces import ExactForces, exact_forces, value_of
from tests.worlds.loading import OVER, characteristic, loaded, loaded_mechanism
from tests.worlds.tiers import few, slow
from tests.worlds.wide_angles import made, times

NOTHING = 1e-38
"""What is left of an error of the oracle itself, over its largest force."""
COUNT = 10
LOOSE = 4000.0
"""What the median of bound over error may be: those of accelerations alone are a few hundred."""


@dataclass(frozen=True)
class Held:
    """An error and its bound, over the largest force or moment of that kind at the sample."""

    what: str
    error: float
    bound: float


def _held(found: Forces, exact: ExactForces, i: int) -> Iterator[Held]:
    bound = found.bound
    assert found.pins.keys() == exact.pins.keys() == bound.pins.keys()
    assert found.sliders.keys() == exact.sliders.keys() == bound.sliders.keys()
    yield Held("torque", _apart(found.torque[i], exact.torque), bound.torque[i])
    for point, forces_ in exact.pins.items():
        assert found.pins[point].keys() == forces_.keys() == bound.pins[point].keys()
        for body, pair in forces_.items():
            own = found.pins[point][body][i]
            error = math.hypot(_apart(own[0], pair[0]), _apart(own[1], pair[1]))
            yield Held(f"pin {point} on {body}", error, bound.pins[point][body][i])
    for name, (normal, moment) in exact.sliders.items():
        one, most = found.sliders[name], bound.sliders[name]
        yield Held(f"normal {name}", _apart(one.normal[i], normal), most.normal[i])
        yield Held(f"moment {name}", _apart(one.moment[i], moment), most.moment[i])


def _apart(value: float, exact: object) -> float:
    return float(abs(float(value) - exact))  # type: ignore[operator]


def beside(scene: Scene, time_s: Array) -> list[Held]:
    """Every force at the times beside the exact one."""
    found, motion, chain = forces(scene, time_s), solve(scene, time_s), Chain(scene)
    rows: list[Held] = []
    for i, t in enumerate(time_s):
        exact = _exact(scene, chain, motion, i, float(t))
        least = NOTHING * exact.largest
        rows += [
            replace(row, error=row.error if row.error > least else 0.0)
            for row in _held(found, exact, i)
        ]
    return rows


def _exact(scene: Scene, chain: Chain, motion: Motion, i: int, t: float) -> ExactForces:
    return exact_forces(scene, t, chain.solve(t, coordinates(scene, motion, i)))


def _no_bound_broken(rows: list[Held], told: object) -> None:
    broken = [row for row in rows if not row.error <= row.bound]
    assert not broken, f"{told}: {broken[:3]}"


@pytest.mark.parametrize("name", [*shipped(), *shipped("forces")])
def test_errors_stay_below_their_bounds_in_every_scene(name: str) -> None:
    # Bounds of friction are held in test_friction_bounds.
    scene = replace(load_scene(name), gravity_m_s2=(0.0, -9.81), friction={})
    times = np.random.default_rng(1).uniform(-1.0, 1.0, 4) * scene.driver.law.period_s
    rows = beside(scene, times * [1.0, 1.0, 1.0, 1e4])
    _no_bound_broken(rows, name)
    known = [row.bound / row.error for row in rows if row.error > 0.0]
    assert np.median(known) < LOOSE


def hold(number: int) -> list[Held]:
    """The mechanism of a number at one time, no bound of its forces broken."""
    scene, near = loaded_mechanism(number)
    far = random.Random(number).uniform(-1.0, 1.0) * scene.driver.law.period_s
    rows = beside(scene, np.array([0.0 if near else far]))
    _no_bound_broken(rows, f"mechanism {number}")
    return rows


def test_errors_stay_below_their_bounds_in_random_mechanisms() -> None:
    """Of all dyads, on fixed and moving guides."""
    rows = [row for number in range(COUNT) for row in hold(number)]
    near = sum(loaded_mechanism(number)[1] for number in range(1, COUNT, 2))
    assert near >= 0.4 * COUNT
    finite = [row.bound / row.error for row in rows if row.error > 0.0 and row.bound < np.inf]
    assert len(finite) > 0.8 * len(rows), "bounds that are not finite say nothing"
    assert np.median(finite) < LOOSE


@pytest.mark.parametrize("number", few(range(10), range(4), "random mechanisms"))
def test_errors_stay_below_their_bounds_where_angles_hold_many_turns(number: int) -> None:
    """And far from the origin, at times of up to a million turns."""
    chance = random.Random(number)
    scene = loaded(moved(made(number).scene, (1e4, -3e4)), chance)
    _no_bound_broken(beside(scene, times(scene, number, 3)), f"mechanism {number}")


def test_magnitudes_of_loads_are_rounded_by_no_more_than_they_say() -> None:
    chance = random.Random(4)
    for _ in range(60):
        own = characteristic(chance.choice(OVER), chance)
        x = np.array([chance.uniform(-30.0, 30.0), chance.uniform(-1.0, 1.0)])
        for at, found, most in zip(x, own.at(x), own.rounding(x) + np.zeros(2), strict=True):
            assert _apart(float(found), value_of(own, mpf(float(at)))) <= most, own


@slow("one mechanism in a thousand is nearer to a dead point than to rounding")
@pytest.mark.parametrize("part", range(8))
def test_errors_stay_below_their_bounds_in_thousands_of_mechanisms(part: int) -> None:
    for number in range(500 * part, 500 * (part + 1)):
        hold(number)
