"""A redundant link in the engines: all its loops are closed, and it moves as the reference does."""

from __future__ import annotations

import numpy as np
import pytest

from analytic.kinematics import solve
from models.hard import double_parallelogram
from models.tree import plan
from sim.pymunk.space import build
from sim.registry import ENGINES
from sim.run import run

SCENE = double_parallelogram("double-parallelogram", source="test")
START = solve(SCENE, np.array([0.0])).state(0)


def test_every_loop_of_a_redundant_link_is_closed() -> None:
    """Six pins on four bodies: the tree keeps four, and closes two; pymunk has no pin at A."""
    assert [closure.point for closure in plan(SCENE, START).closures] == ["C", "F"]
    space = build(SCENE, START).space
    assert len(space.constraints) == 5


@pytest.mark.parametrize("name", ENGINES)
def test_engines_carry_a_redundant_link_along(name: str) -> None:
    """From 31 to 146 deg of the crank, between the flat positions."""
    result = run(SCENE, START, name, dt_s=1e-3, steps=200)
    assert (result.status, result.reason) == ("ok", "")
    exact = solve(SCENE, result.motion.time_s)
    assert result.motion.links["crank"].theta[-1] < np.pi
    for link in ("rocker", "third", "coupler"):
        off = result.motion.links[link].theta - exact.links[link].theta
        assert np.abs(off).max() < 1e-4
    assert set(result.gaps) == {"A", "B", "C", "D", "F", "G"}
    assert max(float(gap.max()) for gap in result.gaps.values()) < 2e-5
