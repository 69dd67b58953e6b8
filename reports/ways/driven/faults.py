"""Faults of driven runs: of their motion, and of the forces in them."""

from __future__ import annotations

from collections.abc import Collection, Sequence

from models.scene import Scene
from reports.judge.cell import Cell
from reports.selftest import (
    clock,
    engines,
    forces,
    handed_back,
    mechanism,
    misplaced,
    missing,
    requests,
    values,
)
from reports.selftest.fault import PROFILE
from reports.selftest.fault_runs import STEPS, FaultRuns, FaultSet
from reports.selftest.unseen import UNSEEN

MOTION = (requests, handed_back, mechanism, engines, clock, values, misplaced, missing)


def turn(scene: Scene, engine: str, steps: int, converge: bool, *, forces: bool = False) -> Cell:
    """A turn of so many steps."""
    dt_s = scene.driver.law.period_s / steps
    return Cell(scene, engine, PROFILE, dt_s, steps, converge=converge, with_forces=forces)


def words(scenes: Collection[str]) -> Sequence[str]:
    """How long the runs are."""
    return [f"{STEPS} steps a turn, 1 turn"]


def loaded(scene: Scene, engine: str, steps: int, converge: bool) -> Cell:
    """As `turn`, with forces."""
    return turn(scene, engine, steps, converge, forces=True)


SETTINGS = {"steps_per_turn": STEPS, "turns": 1}
GROUPS = {
    "request": "another run than was asked for",
    "reference": "numbers that are the reference's",
    "scene": "another mechanism in the engine",
    "engine": "something wrong inside the engine",
    "clock": "another instant than the log says",
    "log": "wrong numbers in the log",
    "misplaced": "numbers of the log in a wrong place",
    "missing": "something missing from the log",
}
FAULTS = FaultSet(
    tuple(fault for module in (*MOTION, forces) for fault in module.FAULTS),
    {
        "motion": FaultRuns(GROUPS, turn, words, SETTINGS, unseen=UNSEEN),
        "forces": FaultRuns({"force": "a right motion with wrong forces"}, loaded, words, SETTINGS),
    },
)
