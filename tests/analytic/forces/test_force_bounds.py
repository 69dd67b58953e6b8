"""Bounds of forces, against fifty digits: random mechanisms with loads, springs and friction, half
of them near a dead point."""

import math
import random
from dataclasses import dataclass, replace

import numpy as np
import pytest
from mpmath import mpf

from analytic.forces.force_elements import spring_lengths
from analytic.forces.kinetostatics import forces
from analytic.kinematics import chunks, solve
from models.array import Array
from models.files.reading import load_scene
from models.motion import Forces
from models.scene import Scene
from models.scene.moved import moved
from tests.analytic.chain import Chain, coordinates
from tests.analytic.forces.beside import series
from tests.analytic.forces.exact_forces import ExactForces, exact_forces, exact_rubbed, value_of
from tests.analytic.test_bounds import SIX
from tests.worlds import loading
from tests.worlds.tiers import few, slowly
from tests.worlds.wide_angles import made, times

NOTHING = 1e-38
"""What is left of an error of the oracle itself, over its largest force."""
LOOSE = 4000.0
"""What the median of bound over error may be: those of accelerations alone are a few hundred."""


@dataclass(frozen=True)
class Held:
    what: str
    error: float
    bound: float

    @property
    def loose(self) -> float:
        return self.bound / self.error


def held(found: Forces, exact: ExactForces, i: int, told: object) -> list[Held]:
    """Every force at a sample beside the exact one; no bound of them is broken."""
    ours, bounds, theirs = dict(series(found)), dict(series(found.bound)), dict(exact.series())
    assert ours.keys() == theirs.keys() == bounds.keys()
    least, rows = NOTHING * exact.largest, []
    for name, true in theirs.items():
        own = np.atleast_1d(ours[name][i])
        error = math.hypot(*(_apart(a, b) for a, b in zip(own, true, strict=True)))
        rows.append(Held(name, error if error > least else 0.0, float(bounds[name][i])))
    broken = [row for row in rows if not row.error <= row.bound]
    assert not broken, f"{told}: {broken[:3]}"
    return rows


def _apart(value: float, exact: object) -> float:
    return float(abs(float(value) - exact))  # type: ignore[operator]


def beside(scene: Scene, time_s: Array, told: object) -> list[Held]:
    """Every force at the times beside the exact one, no bound of them broken."""
    found, motion, chain, rows = forces(scene, time_s), solve(scene, time_s), Chain(scene), []
    for i, t in enumerate(time_s.tolist()):
        solved = chain.solve(t, coordinates(scene, motion, i))
        rows += held(found, exact_forces(scene, t, solved), i, told)
    return rows


def _at(scene: Scene, number: int, near: bool) -> Array:
    """The dead point that a mechanism is near, or a time at random."""
    far = random.Random(number).uniform(-1.0, 1.0) * scene.driver.law.period_s
    return np.array([0.0 if near else far])


@pytest.mark.parametrize("name", SIX)
def test_errors_stay_below_their_bounds_in_every_scene(name: str) -> None:
    # Bounds of friction are held below.
    scene = replace(load_scene(name), gravity_m_s2=(0.0, -9.81), friction={})
    times = np.random.default_rng(1).uniform(-1.0, 1.0, 2) * scene.driver.law.period_s
    rows = beside(scene, times * [1.0, 1e4], name)
    assert np.median([row.loose for row in rows if row.error > 0.0]) < LOOSE


@pytest.mark.parametrize(
    ("count", "springs"),
    [
        (6, False),
        (4, True),
        slowly(4000, False, reason="one mechanism in a thousand is nearer to a dead point"),
        slowly(100, True, reason="random mechanisms"),
    ],
)
def test_errors_stay_below_their_bounds_in_random_mechanisms(count: int, springs: bool) -> None:
    """Of all dyads, on fixed and moving guides."""
    rows = []
    for number in range(count):
        scene, near = loading.loaded_mechanism(number)
        scene = loading.sprung(scene, random.Random(number)) if springs else scene
        rows += beside(scene, _at(scene, number, near), f"mechanism {number}")
    assert sum(loading.loaded_mechanism(number)[1] for number in range(1, count, 2)) >= 0.4 * count
    finite = [row.loose for row in rows if row.error > 0.0 and row.bound < np.inf]
    assert len(finite) > 0.8 * len(rows), "bounds that are not finite say nothing"
    assert np.median(finite) < LOOSE


@pytest.mark.parametrize("number", few(range(10), range(4), "random mechanisms"))
def test_errors_stay_below_their_bounds_where_angles_hold_many_turns(number: int) -> None:
    """And far from the origin, at times of up to a million turns."""
    scene = loading.loaded(moved(made(number).scene, (1e4, -3e4)), random.Random(number))
    beside(scene, times(scene, number, 3), f"mechanism {number}")


@pytest.mark.parametrize(("rate", "damping"), [(1e7, 0.0), (1.0, 1e7)])
def test_bounds_hold_where_a_stiff_spring_is_all_but_slack(rate: float, damping: float) -> None:
    """After thousands of swings: then what its length, or its speed, may be wrong by is all of the
    error."""
    for number in range(0, 4, 2):
        scene = loading.sprung(loading.loaded_mechanism(number)[0], random.Random(number))
        time_s = np.array([3.1e4 * scene.driver.law.period_s])
        _, chunk = next(iter(chunks(scene, time_s, bound=False)))
        for spring, q, speed in spring_lengths(scene, chunk, counted=True):
            free = float(q[0]) + damping / rate * float(speed[0])
            slack = replace(spring, rate=rate, damping=damping, free=free)
            beside(replace(scene, springs={spring.name: slack}), time_s, (number, spring))


def test_magnitudes_of_loads_are_rounded_by_no_more_than_they_say() -> None:
    chance = random.Random(4)
    for _ in range(60):
        own = loading.characteristic(chance.choice(loading.OVER), chance)
        x = np.array([chance.uniform(-30.0, 30.0), chance.uniform(-1.0, 1.0)])
        for at, found, most in zip(x, own.at(x), own.rounding(x) + np.zeros(2), strict=True):
            assert _apart(found, value_of(own, mpf(float(at)))) <= most, own


def rubbing(number: int) -> tuple[int, int, float]:
    """How many forces of a mechanism with friction have a finite bound, of how many, and how loose
    these are; no bound is broken."""
    scene, near = loading.rubbed_mechanism(number)
    time_s = _at(scene, number, near)
    found = forces(scene, time_s, skip_dead_points=True)
    if not np.isfinite(found.bound.torque[0]):
        return 0, 1, 1.0
    at = coordinates(scene, solve(scene, time_s), 0)
    exact = exact_rubbed(scene, float(time_s[0]), Chain(scene).solve(float(time_s[0]), at))
    rows = held(found, exact, 0, f"mechanism {number}")
    finite = [row for row in rows if np.isfinite(row.bound)]
    loose = [row.loose for row in finite if row.error > 1e-30 * exact.largest]
    return len(finite), len(rows), float(np.median(loose or [1.0]))


PARTS = [range(250 * part, 250 * (part + 1)) for part in range(4)]


@pytest.mark.parametrize(
    "numbers",
    [range(4), *(slowly(part, reason="one in a hundred is near locking") for part in PARTS)],
    ids=str,
)
def test_no_bound_is_broken_with_friction(numbers: range) -> None:
    finite, total, loose = np.transpose([rubbing(number) for number in numbers])
    assert finite.sum() > 0.7 * total.sum(), "bounds that are not finite say nothing"
    assert np.median(loose) < 4e4
