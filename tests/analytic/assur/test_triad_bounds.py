"""Bounds of triads against the whole mechanism in fifty digits."""

from __future__ import annotations

import functools
import math
from dataclasses import replace

import numpy as np
import pytest

from analytic.assur.group_steps import prepare
from analytic.assur.step import AssurStep
from analytic.check.moved_scene import moved
from analytic.kinematics import solve
from analytic.structure.mobility import analyse
from models.errors import ReachError
from models.laws import ConstantSpeed
from models.scene import Scene
from tests.analytic.assur.triad_scenes import KINDS, on_branch, triad
from tests.analytic.test_bounds import shares
from tests.worlds.tiers import few, slowly

FEW_KINDS = [("RR", "RR", "RR"), ("RR", "PR", "RP"), ("PR", "RP", "PP"), ("RR", "RP", "RP")]
few_kinds = pytest.mark.parametrize(
    "kinds", few(KINDS, FEW_KINDS, "legs of each kind are among the few"), ids="-".join
)


def step_of(scene: Scene) -> AssurStep:
    """The step of the triad of a scene."""
    step = prepare(scene, analyse(scene))[-1]
    assert isinstance(step, AssurStep)
    return step


def start_of(scene: Scene) -> float:
    return float(scene.driver.law.at(np.zeros(1))[0][0])


@functools.cache
def as_drawn(kinds: tuple[str, str, str], seed: int) -> Scene:
    """A random triad on the assembly that it was drawn in."""
    scene, angle = triad(kinds, seed)
    found = [one.angle_rad for one in step_of(scene).assemblies(start_of(scene), {})]
    apart = [abs(math.remainder(one - angle, math.tau)) for one in found]
    assert min(apart) < 1e-6, "the assembly that was drawn is one of all"
    return on_branch(scene, 1 + int(np.argmin(apart)))


@pytest.mark.parametrize(
    "seeds", [range(1), slowly(range(1, 40), reason="random triads, some near a limit")], ids=len
)
@few_kinds
def test_error_stays_below_the_bound_in_every_kind_of_triad(
    kinds: tuple[str, str, str], seeds: range
) -> None:
    for seed in seeds:
        try:
            found = shares(as_drawn(kinds, 7 * seed + 1), np.array([0.0, 3e-3]))
        except ReachError:
            continue  # it ends within a hundredth of a turn
        assert found.max() <= 1.0
        assert np.median(found[0]) > 1e-4, "a bound of ten thousand errors says little"


def test_bounds_are_infinite_beside_a_limit_position_and_never_nan() -> None:
    scene = as_drawn(("RR", "RR", "RR"), 0)
    track = step_of(scene).track({})
    low, high = track.low, track.high
    law = ConstantSpeed(0.5 * (low.theta + high.theta), 1.0)
    start = replace(scene.driver, law=law)
    beside = high.theta - law.start_rad - np.array([1e-3, 1e-6, 1e-9, 1e-12])
    motion = solve(replace(scene, driver=start), beside)
    bound = motion.bound
    for name, one in bound.links.items():
        for level in (one.theta, one.omega, one.alpha):
            assert not np.isnan(level).any(), name
            assert (level >= 0.0).all(), name
    platform = bound.links["platform"]
    assert np.isfinite(platform.alpha[:2]).all()
    assert platform.omega[2] > 1e3 * platform.omega[1] > 1e3 * platform.omega[0]


@pytest.mark.parametrize(
    "kinds", few(KINDS, [("PR", "RP", "PP")], "one kind shows it"), ids="-".join
)
def test_error_stays_below_the_bound_a_million_lengths_away(kinds: tuple[str, str, str]) -> None:
    scene = moved(as_drawn(kinds, 1), (1e6, -7e5))
    assert shares(scene, np.array([0.0, 3e-3])).max() <= 1.0
