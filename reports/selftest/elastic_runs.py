"""The runs of elastic links that faults are planted in: what engines are given of them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache, lru_cache

from models.files import load_scene
from models.scene import Scene
from reports.compare.elastic.elastic_truth import ElasticTruth
from reports.judge.cell import Cell
from reports.selftest.fault import PROFILE, Items
from sim.engine import Drive, Run
from sim.run import run

BENT, LOOSE = "fourbar-elastic", "fourbar-elastic-pulse"
"""Driven on its periodic motion; and let go."""


@dataclass(frozen=True)
class ElasticRun:
    """Segments of each elastic link, and steps of the one turn, or of a time [s]."""

    segments: int
    steps: int
    lasts_s: float | None = None

    @property
    def words(self) -> str:
        """Segments, steps and length."""
        told = "a turn, 1 turn" if self.lasts_s is None else f"in {self.lasts_s:g} s, let go"
        return f"{self.segments} segments, {self.steps} steps {told}"


ELASTIC_RUNS: dict[str, ElasticRun] = {
    BENT: ElasticRun(4, 2880),
    LOOSE: ElasticRun(4, 1440, 0.4),
}
"""By scene: few segments, whose exact chain is soon found, and steps so short that the limit of
what an engine may be off by (0.2 % of the largest deflection) is well below a hundredth."""


@cache
def _once(name: str) -> Scene:
    """The elastic scene of that name, one and the same: its truth is kept under the scene itself,
    and takes seconds."""
    return load_scene(name)


def elastic_cell(name: str, engine: str, finer: float = 1.0) -> Cell:
    """One turn of that scene, or some time; ``finer`` times as many steps."""
    scene, own = _once(name), ELASTIC_RUNS[name]
    steps = round(own.steps * finer)
    dt_s = (own.lasts_s or scene.driver.law.period_s) / steps
    drive: Drive = "free" if scene.is_free else "prescribed"
    return Cell(
        scene, engine, PROFILE, dt_s, steps, drive=drive, converge=False, segments=own.segments
    )


def truth_of_chain(given: Scene) -> ElasticTruth:
    """That of the elastic scene whose segments an engine is ``given``."""
    truth = elastic_cell(given.name, "").truth
    assert isinstance(truth, ElasticTruth)
    return truth


@lru_cache(maxsize=3)
def sound_run(scene: str, name: str, profile: str, options: Items) -> Run:
    """The run of the segments of that scene without any fault, the same for all sizes."""
    truth = truth_of_chain(_once(scene))
    return run(truth.given, truth.start, name, profile, **dict(options))
