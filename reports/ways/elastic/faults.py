"""Faults of elastic links, as segments and as an engine's own beams."""

from collections.abc import Collection, Mapping, Sequence

from models.scene import Scene
from reports.judge.cell import Cell
from reports.selftest import elastic_faults
from reports.selftest.elastic_changes import BEAM_RUNS, BENT, ELASTIC_RUNS, ElasticRun, elastic_cell
from reports.selftest.fault import STEPS, FaultRuns, FaultSet, RunKind, Unseen
from reports.selftest.unseen import UNSEEN_ELASTIC

GROUPS = {
    "segments": "elastic links, of another chain",
    "vibration": "elastic links, wrong inside the engine",
    "deflection": "elastic links, wrong in the log",
}


def _runs(
    kind: RunKind,
    groups: Mapping[str, str],
    own: Mapping[str, ElasticRun],
    unseen: Sequence[Unseen],
    *also: RunKind,
) -> FaultRuns:
    def cell(scene: Scene, engine: str, steps: int, converge: bool) -> Cell:
        return elastic_cell(scene.name, engine, steps / STEPS, own)

    def words(scenes: Collection[str]) -> Sequence[str]:
        return [f"{scene} in {run.words}" for scene, run in own.items() if scene in scenes]

    settings = {kind: {scene: vars(run) for scene, run in own.items()}}
    return FaultRuns(groups, cell, words, settings, BENT, unseen, also)


FAULTS = FaultSet(
    elastic_faults.FAULTS,
    {
        "elastic": _runs("elastic", GROUPS, ELASTIC_RUNS, UNSEEN_ELASTIC, "beam"),
        "beam": _runs("beam", {"beam": "elastic links, by an engine's own beam"}, BEAM_RUNS, ()),
    },
)
