"""Runs of elastic links to plant faults in, and changes of their logs, or of engines' beams."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cache, lru_cache
from typing import Any

import numpy as np

from analytic.elastic.discretisation import REFERENCE, Discretisation
from analytic.elastic.elastic_motion import DrivenElasticMotion
from analytic.elastic.engine_start import node_start
from models.array import Array
from models.files.reading import load_scene
from models.motion import Motion, State
from models.scene import Scene
from models.scene.cut_links import CutScene
from models.scene.cut_scenes import BeamedScene
from models.scene.elastic import Beam, Shape
from reports.compare.elastic_truth import ChainTruth, ElasticTruth
from reports.judge.cell import Cell, CellRunner
from reports.selftest.fault import PROFILE, Items, Plant
from reports.selftest.log_edits import WHEN, moved
from reports.way.length import Springs
from reports.way.way import way_of
from sim.engine import Run
from sim.run import run

BENT, LOOSE = "fourbar-elastic", "fourbar-elastic-pulse"
"""Driven on its periodic motion; and in free motion."""


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
"""Runs by scene: few segments, whose exact chain is soon found, and steps so short that the limit
of the engine's error (0.2 % of the largest deflection) is well below a hundredth."""


BEAM_RUNS: dict[str, ElasticRun] = {BENT: ElasticRun(8, 2880, "beam")}
"""Runs by scene, for engines with their own beams: elements within the reference's own doubt."""


@cache
def _once(name: str) -> Scene:
    """Read the elastic scene of that name, once."""
    return load_scene(name)


def elastic_cell(
    name: str, engine: str, finer: float = 1.0, runs: Mapping[str, ElasticRun] = ELASTIC_RUNS
) -> Cell:
    """Return one turn of that scene, or some time; ``finer`` times as many steps."""
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
    """Return the reference of the elastic scene of the segments that an engine is ``given``."""
    truth = elastic_cell(given.name, "").truth
    assert isinstance(truth, ChainTruth)
    return truth


def truth_of_given(given: Scene) -> ElasticTruth:
    """Return the reference of the elastic scene of ``given`` segments, or beams."""
    return _truth(given.name, beams=bool(given.beams))


def _truth(scene: str, *, beams: bool) -> ElasticTruth:
    truth = elastic_cell(scene, "", runs=BEAM_RUNS if beams else ELASTIC_RUNS).truth
    assert isinstance(truth, ElasticTruth)
    return truth


def sound_run(given: Scene, name: str, profile: str, options: Items) -> Run:
    """Return the run of the given scene without any fault, the same for all sizes."""
    return _sound_run(given.name, bool(given.beams), name, profile, options)


@lru_cache(maxsize=3)
def _sound_run(scene: str, beams: bool, name: str, profile: str, options: Items) -> Run:
    truth = _truth(scene, beams=beams)
    return run(truth.given, truth.start, name, profile, **dict(options))


NodeChange = Callable[[ElasticTruth, Motion, float], Motion]


def in_chain_log(change: NodeChange) -> Plant:
    """Run the engine without a fault, and change its log afterwards."""

    def plant(size: float) -> CellRunner:
        def runner(scene: Scene, _: object, name: str, profile: str, **options: Any) -> Run:
            asked = {key: value for key, value in options.items() if key != "settings"}
            done = sound_run(scene, name, profile, tuple(sorted(asked.items())))
            if not size:
                return done
            return replace(done, motion=change(truth_of_given(scene), moved(done), size))

        return runner

    return plant


def bent_by(change: Callable[[Array, float], Array]) -> NodeChange:
    """Move all nodes to the changed distance from the line between the pins."""

    def changed(truth: ElasticTruth, motion: Motion, size: float) -> Motion:
        name = next(iter(truth.scene.elastic))
        nodes = truth.cut.nodes(name)
        first, across = _line(motion, nodes)
        for node in nodes[1:-1]:
            off = ((motion.points[node].position - first) * across).sum(axis=1)
            motion = _moved(motion, node, (change(off, size) - off)[:, None] * across)
        return motion

    return changed


def at_next_node(truth: ElasticTruth, motion: Motion, _: float) -> Motion:
    """Log the middle where the node before it is, with its deflection."""
    name = next(iter(truth.scene.elastic))
    nodes = truth.cut.nodes(name)
    first, across = _line(motion, nodes)
    middle = len(nodes) // 2
    off, near = (
        ((motion.points[nodes[k]].position - first) * across).sum(axis=1)
        for k in (middle, middle - 1)
    )
    return _moved(motion, nodes[middle], (near - off)[:, None] * across)


def at_quarter(truth: ElasticTruth, motion: Motion, share: float) -> Motion:
    """Move the first node, away from the middle, by a share of the deflection there, after the
    start has been looked at."""
    name = next(iter(truth.scene.elastic))
    nodes = truth.cut.nodes(name)
    first, across = _line(motion, nodes)
    off = ((motion.points[nodes[1]].position - first) * across).sum(axis=1)
    off[:WHEN] = 0.0
    return _moved(motion, nodes[1], share * off[:, None] * across)


def of_beam(*, stiffened: bool, by: Discretisation = REFERENCE) -> NodeChange:
    """Put links, points and the middle of another theory in the engine's place."""

    def changed(truth: ElasticTruth, motion: Motion, _: float) -> Motion:
        scene = truth.scene
        theory = DrivenElasticMotion(scene, 1.0, by, truth.theory.shape, stiffened)
        return _given_back(truth.cut, motion, theory.at(motion.time_s))

    return changed


def of_exact_chain(truth: ElasticTruth, motion: Motion, _: float) -> Motion:
    """Put the exact chain in the engine's place."""
    exact = truth.exact_at(motion.time_s)
    assert exact is not None
    return _given_back(truth.cut, motion, exact)


def _given_back(chain: CutScene, own: Motion, other: Motion) -> Motion:
    """Return the log with the links, the points and the deflections of another motion."""
    links = {**own.links, **{n: each for n, each in other.links.items() if n in own.links}}
    motion = replace(own, links=links, points={**own.points, **other.points})
    for name in chain.scene.elastic:
        nodes = chain.nodes(name)
        first, across = _line(motion, nodes)
        middle = nodes[chain.count // 2]
        off = ((motion.points[middle].position - first) * across).sum(axis=1)
        by = other.elastic[name].middle - off
        motion = _moved(motion, middle, by[:, None] * across)
    return motion


def _line(motion: Motion, nodes: tuple[str, ...]) -> tuple[Array, Array]:
    """Return the first pin, and the unit vector across the line from it to the last (T, 2)."""
    first, end = (motion.points[node].position for node in (nodes[0], nodes[-1]))
    way = end - first
    return first, np.stack([-way[:, 1], way[:, 0]], axis=1) / np.hypot(*way.T)[:, None]


def _moved(motion: Motion, node: str, by: Array) -> Motion:
    own = motion.points[node]
    return replace(motion, points={**motion.points, node: replace(own, position=own.position + by)})


BeamChange = Callable[[Beam, float], Beam]


def in_beam(change: BeamChange) -> Plant:
    """Give the engine another beam, which starts where the right one does."""

    def plant(size: float) -> CellRunner:
        def runner(scene: Scene, state: State, *args: Any, **options: Any) -> Run:
            beams = {name: change(beam, size) for name, beam in scene.beams.items()}
            links = dict(scene.links)
            for name, beam in beams.items():
                more = beam.density_kg_m / scene.beams[name].density_kg_m
                for node in beam.nodes:
                    links[node] = replace(links[node], mass_kg=more * links[node].mass_kg)
            return run(replace(scene, links=links, beams=beams), state, *args, **options)

        return runner

    return plant


def begun(shape: Shape) -> Plant:
    """Start the right beam with another shape, or as it should with a size of 0."""

    def plant(size: float) -> CellRunner:
        def runner(scene: Scene, state: State, *args: Any, **options: Any) -> Run:
            cut = truth_of_given(scene).cut
            assert isinstance(cut, BeamedScene)
            return run(scene, node_start(cut, shape) if size else state, *args, **options)

        return runner

    return plant


def stiffer_beam(beam: Beam, share: float) -> Beam:
    return replace(beam, flexural_n_m2=(1.0 + share) * beam.flexural_n_m2)


def stretchier(beam: Beam, share: float) -> Beam:
    return replace(beam, axial_n=beam.axial_n / (1.0 + share))


def heavier_beam(beam: Beam, share: float) -> Beam:
    return replace(beam, density_kg_m=(1.0 + share) * beam.density_kg_m)


def damped_beam(beam: Beam, time_s: float) -> Beam:
    return replace(beam, damping_s=beam.damping_s + time_s)
