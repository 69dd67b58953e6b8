"""The bounds of forces with friction: held against fifty digits, and they change no number."""

from __future__ import annotations

import math
import random

import numpy as np
import pytest

from analytic.forces import kinetostatics
from analytic.kinematics import solve
from tests.analytic.chain import Chain, coordinates
from tests.analytic.forces.beside import series
from tests.analytic.forces.exact_friction import exact_rubbed
from tests.worlds.rubbing import rubbed_mechanism
from tests.worlds.tiers import slowly

PARTS = [range(250 * part, 250 * (part + 1)) for part in range(4)]


def hold(number: int) -> tuple[int, int, float]:
    """How many forces of a mechanism have a finite bound, of how many; no bound is broken."""
    scene, near = rubbed_mechanism(number)
    far = random.Random(number).uniform(-1.0, 1.0) * scene.driver.law.period_s
    time_s = np.array([0.0 if near else far])
    found = kinetostatics.forces(scene, time_s, skip_dead_points=True)
    if not np.isfinite(found.bound.torque[0]):
        return 0, 1, 1.0
    motion = solve(scene, time_s)
    solved = Chain(scene).solve(float(time_s[0]), coordinates(scene, motion, 0))
    told = exact_rubbed(scene, float(time_s[0]), solved)
    assert told is not None, f"mechanism {number}: a bound where nothing settles"
    exact, friction = told
    pairs = [(abs(found.torque[0] - exact.torque), found.bound.torque[0])]
    for joint, size in friction.items():
        pairs.append((abs(found.friction[joint][0] - size), found.bound.friction[joint][0]))
    for point, held in exact.pins.items():
        for body, (x, y) in held.items():
            one = found.pins[point][body][0]
            pairs.append((math.hypot(one[0] - x, one[1] - y), found.bound.pins[point][body][0]))
    for name, (normal, moment) in exact.sliders.items():
        one, most = found.sliders[name], found.bound.sliders[name]
        pairs.append((abs(one.normal[0] - normal), most.normal[0]))
        pairs.append((abs(one.moment[0] - moment), most.moment[0]))
    broken = [(float(e), float(b)) for e, b in pairs if not e <= b + 1e-38 * exact.largest]
    assert not broken, f"mechanism {number}: {broken[:3]}"
    tight = [float(b / e) for e, b in pairs if e > 1e-30 * exact.largest and np.isfinite(b)]
    return sum(bool(np.isfinite(b)) for _, b in pairs), len(pairs), float(np.median(tight or [1.0]))


@pytest.mark.parametrize(
    "numbers",
    [range(6), *(slowly(part, reason="one in a hundred is near locking") for part in PARTS)],
    ids=str,
)
def test_no_bound_is_broken_against_fifty_digits(numbers: range) -> None:
    rows = [hold(number) for number in numbers]
    finite, total, tight = (np.array(column) for column in zip(*rows, strict=True))
    assert finite.sum() > 0.7 * total.sum(), "bounds that are not finite say nothing"
    assert np.median(tight) < 4e4


def test_bounds_change_no_number() -> None:
    for number in (2, 4, 8):
        scene, _ = rubbed_mechanism(number)
        time_s = np.linspace(0.01, 1.0, 9) * scene.driver.law.period_s
        with_ = kinetostatics.forces(scene, time_s, skip_dead_points=True)
        bare = kinetostatics.forces(scene, time_s, bound=False, skip_dead_points=True)
        for (name, a), (_, b) in zip(series(with_), series(bare), strict=True):
            np.testing.assert_array_equal(a, b, err_msg=name)
