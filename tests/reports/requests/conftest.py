"""Runs that several tests look at: short ones, at a coarse step."""

import pytest

import crankcheck


@pytest.fixture(scope="session")
def ran() -> crankcheck.Simulation:
    return crankcheck.run("fourbar-lecture-1", "mujoco", steps_per_turn=180, turns=1)


@pytest.fixture(scope="session")
def lagging() -> crankcheck.Simulation:
    """Of an engine whose velocities belong to other instants, and that reports no accelerations."""
    return crankcheck.run("slotted-lever", "pymunk", steps_per_turn=180, turns=1)
