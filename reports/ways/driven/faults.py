"""Faults of driven runs: of their motion, and of the forces in them."""

from collections.abc import Collection, Sequence
from dataclasses import replace
from functools import partial

from analytic.cams.outline import outlined
from models.scene import Scene
from reports.judge.cell import Cell
from reports.selftest import engines, forces, requests, worlds
from reports.selftest.fault import PROFILE, STEPS, FaultRuns, FaultSet
from reports.selftest.higher_pairs import FACETS, FINER, PAIRS
from reports.selftest.log_faults import CLOCK, MISSING, VALUES
from reports.selftest.mechanism import MECHANISM, MISPLACED
from reports.selftest.unseen import UNSEEN


def turn(scene: Scene, engine: str, steps: int, converge: bool, *, forces: bool = False) -> Cell:
    """A cell of one turn in so many steps."""
    dt_s = scene.driver.law.period_s / steps
    return Cell(scene, engine, PROFILE, dt_s, steps, converge=converge, with_forces=forces)


def contact(scene: Scene, engine: str, steps: int, converge: bool) -> Cell:
    """A cell of one turn of cams by contact, at finer steps."""
    return turn(outlined(scene, FACETS), engine, FINER * steps, converge)


def batch(scene: Scene, engine: str, steps: int, converge: bool) -> Cell:
    """A batch over one turn."""
    return replace(turn(scene, engine, steps, converge=False), worlds=worlds.WORLDS)


def words(scenes: Collection[str]) -> Sequence[str]:
    """The length of the runs, in words."""
    return [f"{STEPS} steps a turn, 1 turn"]


SETTINGS = {"steps_per_turn": STEPS, "turns": 1}
GROUPS = {
    "request": "another run than requested",
    "reference": "numbers that are the reference's",
    "scene": "another mechanism in the engine",
    "pair": "another gear or cam in the engine",
    "engine": "something wrong inside the engine",
    "clock": "another instant than the log says",
    "log": "wrong numbers in the log",
    "misplaced": "numbers of the log in a wrong place",
    "missing": "something missing from the log",
}
CONTACT = {"contact": f"another cam by contact, {FINER * STEPS} steps"}
FAULTS = FaultSet(
    (
        *requests.RUN_FAULTS,
        *requests.LOG_FAULTS,
        *MECHANISM,
        *PAIRS,
        *engines.FAULTS,
        *CLOCK,
        *VALUES,
        *MISPLACED,
        *MISSING,
        *forces.FAULTS,
        *worlds.FAULTS,
    ),
    {
        "motion": FaultRuns(
            GROUPS, turn, words, SETTINGS, unseen=UNSEEN, also=("contact", "batch")
        ),
        "contact": FaultRuns(CONTACT, contact, words, {}),
        "batch": FaultRuns({"batch": f"another world of {worlds.WORLDS}"}, batch, words, {}),
        "forces": FaultRuns(
            {"force": "a right motion with wrong forces"},
            partial(turn, forces=True),
            words,
            SETTINGS,
        ),
    },
)
