"""The runs of elastic links that faults are planted in: what engines are given of them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache, lru_cache

from models.files.reading import load_scene
from models.scene import Scene
from reports.compare.elastic.elastic_truth import ChainTruth, ElasticTruth
from reports.judge.cell import Cell
from reports.selftest.fault import PROFILE, Items
from reports.way.length import Springs
from reports.way.way import way_of
from sim.engine import Run
from sim.run import run

BENT, LOOSE = "fourbar-elastic", "fourbar-elastic-pulse"
"""Driven on its periodic motion; and let go."""


@dataclass(frozen=True)
class ElasticRun:
    """Segments of each elastic link with ``springs``, or elements of a beam, and steps of the one
    turn, or of a time [s]."""

    segments: int
    steps: int
    springs: Springs = "plain"
    lasts_s: float | None = None

    @property
    def words(self) -> str:
        """Segments or elements, steps and length."""
        pieces = "elements of a beam" if self.springs == "beam" else "segments"
        told = "a turn, 1 turn" if self.lasts_s is None else f"in {self.lasts_s:g} s, let go"
        return f"{self.segments} {pieces}, {self.steps} steps {told}"


ELASTIC_RUNS: dict[str, ElasticRun] = {
    BENT: ElasticRun(4, 2880),
    LOOSE: ElasticRun(4, 1440, lasts_s=0.4),
}
"""By scene: few segments, whose exact chain is soon found, and steps so short that the limit of
what an engine may be off by (0.2 % of the largest deflection) is well below a hundredth."""


BEAM_RUNS: dict[str, ElasticRun] = {BENT: ElasticRun(8, 2880, "beam")}
"""By scene, of engines that have beams of their own: elements that are within the truth's own
doubt."""


@cache
def _once(name: str) -> Scene:
    """The elastic scene of that name, read once."""
    return load_scene(name)


def elastic_cell(
    name: str, engine: str, finer: float = 1.0, runs: Mapping[str, ElasticRun] = ELASTIC_RUNS
) -> Cell:
    """One turn of that scene, or some time; ``finer`` times as many steps."""
    scene, own = _once(name), runs[name]
    steps = round(own.steps * finer)
    dt_s = (own.lasts_s or scene.driver.law.period_s) / steps
    return Cell(
        scene,
        engine,
        PROFILE,
        dt_s,
        steps,
        drive=way_of(scene).drive,
        converge=False,
        segments=own.segments,
        springs=own.springs,
    )


def truth_of_chain(given: Scene) -> ChainTruth:
    """That of the elastic scene whose segments an engine is ``given``."""
    truth = elastic_cell(given.name, "").truth
    assert isinstance(truth, ChainTruth)
    return truth


def truth_of_given(given: Scene) -> ElasticTruth:
    """That of the elastic scene whose segments, or beams, an engine is ``given``."""
    return _truth(given.name, beams=bool(given.beams))


def _truth(scene: str, *, beams: bool) -> ElasticTruth:
    truth = elastic_cell(scene, "", runs=BEAM_RUNS if beams else ELASTIC_RUNS).truth
    assert isinstance(truth, ElasticTruth)
    return truth


def sound_run(given: Scene, name: str, profile: str, options: Items) -> Run:
    """The run of what an engine is given without any fault, the same for all sizes."""
    return _sound_run(given.name, bool(given.beams), name, profile, options)


@lru_cache(maxsize=3)
def _sound_run(scene: str, beams: bool, name: str, profile: str, options: Items) -> Run:
    truth = _truth(scene, beams=beams)
    return run(truth.given, truth.start, name, profile, **dict(options))
