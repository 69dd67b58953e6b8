"""Faults of free motion."""

from collections.abc import Collection, Sequence

from models.scene import Scene
from reports.judge.cell import Cell
from reports.selftest.fault import PROFILE, STEPS, FaultRuns, FaultSet
from reports.selftest.free_faults import DYNAMICS, FREE_RUNS, RECORD, STEPPING, SWING
from reports.selftest.unseen import UNSEEN_FREE


def run(scene: Scene, engine: str, steps: int, converge: bool) -> Cell:
    """The run of `FREE_RUNS`, with a step as much finer as a turn of so many steps has."""
    dt_s, of_run = FREE_RUNS[scene.name]
    dt_s, steps = dt_s * STEPS / steps, of_run * steps // STEPS
    return Cell(scene, engine, PROFILE, dt_s, steps, drive="free", converge=converge)


def words(scenes: Collection[str]) -> Sequence[str]:
    """The lengths and steps of the runs, in words."""
    own = [
        f"{scene} {1e3 * dt_s:g} ms, {dt_s * steps:g} s"
        for scene, (dt_s, steps) in FREE_RUNS.items()
        if scene in scenes
    ]
    return [f"free motion: {', '.join(own)}"]


GROUPS = {
    "dynamics": "free motion, of another machine",
    "stepping": "free motion, wrong inside the engine",
    "record": "free motion, wrong in the log",
}
SETTINGS = {scene: {"dt_s": dt_s, "steps": steps} for scene, (dt_s, steps) in FREE_RUNS.items()}
FAULTS = FaultSet(
    (*DYNAMICS, *STEPPING, *RECORD),
    {"free": FaultRuns(GROUPS, run, words, {"free": SETTINGS}, SWING, UNSEEN_FREE)},
)
