"""A fault: the bead is elsewhere on its wire than its log says."""

from collections.abc import Collection, Sequence
from dataclasses import replace

from models.scene import Scene
from reports.judge.cell import Cell
from reports.selftest.fault import PROFILE, STEPS, Fault, FaultRuns, FaultSet, in_log
from sim.engine import Run
from tests.worlds.bead.cases import SCENE


def cell(scene: Scene, engine: str, steps: int, converge: bool) -> Cell:
    return Cell(scene, engine, PROFILE, 1e-3, 1000 * steps // STEPS, drive="free", converge=False)


def words(scenes: Collection[str]) -> Sequence[str]:
    return ["beads: 1 ms, 1 s"]


def shifted(scene: Scene, done: Run, size: float) -> Run:
    assert done.motion is not None
    links = done.motion.links
    ahead = {name: replace(link, theta=link.theta + size) for name, link in links.items()}
    return replace(done, motion=replace(done.motion, links=ahead))


FAULTS = FaultSet(
    (
        Fault(
            group="bead",
            name="bead-ahead",
            what="the bead is ahead on its wire",
            rule="CC127",
            plant=in_log(shifted),
            size=0.01,
            unit="rad",
            scenes=(str(SCENE),),
        ),
    ),
    {"bead": FaultRuns({"bead": "beads on wires"}, cell, words, {"bead": {"dt_s": 1e-3}})},
)
