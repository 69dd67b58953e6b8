"""The runs of elastic links that faults are planted in: what engines are given of them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache, lru_cache

from models.files import load_scene
from models.scene import Scene
from reports.compare.elastic.elastic_truth import ChainTruth, chain_truth
from reports.judge.cell import Cell
from reports.selftest.fault import PROFILE, Items
from sim.engine import Run
from sim.run import run

BENT = "fourbar-elastic"


@dataclass(frozen=True)
class ElasticRun:
    """Segments of each elastic link, and steps of the one turn."""

    segments: int
    steps: int


ELASTIC_RUNS: dict[str, ElasticRun] = {BENT: ElasticRun(4, 2880)}
"""By scene: few segments, whose exact chain is soon found, and steps so short that the limit of
what an engine may be off by (0.2 % of the largest deflection) is well below a hundredth."""


@cache
def _once(name: str) -> Scene:
    """The elastic scene of that name, one and the same: its truth is kept under the scene itself,
    and takes seconds."""
    return load_scene(name)


def elastic_cell(name: str, engine: str, finer: float = 1.0) -> Cell:
    """One turn of that scene; ``finer`` times as many steps."""
    scene, own = _once(name), ELASTIC_RUNS[name]
    steps = round(own.steps * finer)
    dt_s = scene.driver.law.period_s / steps
    return Cell(scene, engine, PROFILE, dt_s, steps, converge=False, segments=own.segments)


def truth_of_chain(given: Scene) -> ChainTruth:
    """That of the elastic scene whose segments an engine is ``given``."""
    scene = _once(given.name)
    return chain_truth(scene, ELASTIC_RUNS[given.name].segments, 1.0)


@lru_cache(maxsize=3)
def sound_run(scene: str, name: str, profile: str, options: Items) -> Run:
    """The run of the segments of that scene without any fault, the same for all sizes."""
    truth = truth_of_chain(_once(scene))
    return run(truth.given, truth.start, name, profile, **dict(options))
