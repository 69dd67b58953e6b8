"""How often the truth is worked out: preparations of a mechanism, and solutions of it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

import pytest

from analytic import prepared
from benchmarks.verify_overhead import LINKS, chain
from models.array import Array
from models.files import load_scene, parse_scene
from models.motion import Motion
from models.scene import Scene
from reports.judge.cell import Cell, check
from reports.plan.singular import refuse_singular

STEPS = 720
FULL = STEPS + 1
"""Samples of a whole log; the state at the start, the same for all cells, is a solution of one."""


@pytest.fixture
def worked(monkeypatch: pytest.MonkeyPatch) -> Counter[object]:
    """Preparations, as "prepared", and solutions by their number of samples."""
    counts: Counter[object] = Counter()
    analyse, motion = prepared.analyse, prepared.Prepared.motion

    def analysed(scene: Scene) -> object:
        counts["prepared"] += 1
        return analyse(scene)

    def moved(ready: object, names: object, time_s: Array, *args: object, **bound: bool) -> Motion:
        counts[len(time_s)] += 1
        return motion(ready, names, time_s, *args, **bound)

    monkeypatch.setattr(prepared, "analyse", analysed)
    monkeypatch.setattr(prepared.Prepared, "motion", moved)
    return counts


def run(scene: Scene, engines: Sequence[str]) -> None:
    for engine in engines:
        done = check(Cell(scene, engine, "tuned", scene.driver.law.period_s / STEPS, STEPS))
        assert not done.convergence.faults


@pytest.mark.parametrize(("engine", "solved"), [("mujoco", 2), ("pymunk", 3)])
def test_a_cell_prepares_once_and_solves_once_for_each_set_of_instants(
    worked: Counter[object], engine: str, solved: int
) -> None:
    """For the log, for the logged crank, and for velocities that belong to other instants; two more
    would be one for each finer run."""
    run(load_scene("fourbar-lecture-1"), [engine])
    assert worked == {"prepared": 1, 1: 1, FULL: solved}


def test_the_cells_of_a_scene_share_what_they_were_logged_at(worked: Counter[object]) -> None:
    run(load_scene("fourbar-lecture-1"), ["pymunk", "mujoco"])
    assert worked == {"prepared": 1, 1: 1, FULL: 4}


def test_a_scene_that_is_read_again_is_another_one(worked: Counter[object]) -> None:
    run(load_scene("fourbar-lecture-1"), ["pymunk"])
    run(load_scene("fourbar-lecture-1"), ["pymunk"])
    assert worked == {"prepared": 2, 1: 2, FULL: 6}


def test_a_long_chain_is_looked_over_in_one_preparation(worked: Counter[object]) -> None:
    """Its singular positions are looked for in all dyads at once: a look and five zooms."""
    scene = parse_scene(chain(), "chain")
    assert len(scene.links) == LINKS - 1
    refuse_singular(scene, scene.driver.law.period_s)
    assert worked.pop("prepared") == 1
    assert worked.total() == 6
