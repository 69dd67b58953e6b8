"""Runs of elastic links to plant faults in, and changes of their logs, or of engines' beams."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cache, cached_property, lru_cache
from typing import Any

import numpy as np

from analytic.elastic.discretisation import REFERENCE, Discretisation
from analytic.elastic.elastic_motion import DrivenElasticMotion
from analytic.elastic.engine_start import node_start, segment_start
from models.array import Array
from models.files.reading import load_scene
from models.motion import Motion, State
from models.scene import Scene, cut_links, cut_scenes
from models.scene.elastic import Beam, Shape
from reports.compare.elastic_truth import ChainTruth, ElasticTruth
from reports.judge.cell import Cell
from reports.protocol.length import Springs
from reports.protocol.way import way_of
from reports.selftest.fault import PROFILE, Items, Plant, SceneChange, in_scene, planting
from reports.selftest.log_faults import WHEN, moved
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
        told = "a turn, 1 turn" if self.lasts_s is None else f"in {self.lasts_s:g} s of free motion"
        return f"{self.segments} {pieces}, {self.steps} steps {told}"


ELASTIC_RUNS: dict[str, ElasticRun] = {
    BENT: ElasticRun(4, 2880),
    LOOSE: ElasticRun(4, 1440, lasts_s=0.4),
}
"""Runs by scene: few segments, whose exact chain is soon found, and steps so short that the limit
of the engine's error (0.2 % of the largest deflection) is well below a hundredth."""


BEAM_RUNS: dict[str, ElasticRun] = {BENT: ElasticRun(8, 2880, "beam")}
"""Runs by scene, for engines with their own beams: elements within the reference's own doubt."""


_once = cache(load_scene)


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


@lru_cache(maxsize=3)
def sound_run(scene: str, beams: bool, name: str, profile: str, options: Items) -> Run:
    """Return the run of an elastic scene without any fault, the same for all sizes."""
    truth = _truth(scene, beams=beams)
    return run(truth.given, truth.start, name, profile, **dict(options))


NodeChange = Callable[[ElasticTruth, Motion, float], Motion]


def in_chain_log(change: NodeChange) -> Plant:
    """Run the engine without a fault, and change its log afterwards."""

    @planting
    def runner(
        size: float, scene: Scene, _: object, name: str, profile: str, **options: Any
    ) -> Run:
        asked = tuple(sorted(item for item in options.items() if item[0] != "settings"))
        done = sound_run(scene.name, bool(scene.beams), name, profile, asked)
        if not size:
            return done
        return replace(done, motion=change(truth_of_given(scene), moved(done), size))

    return runner


def bent_by(change: Callable[[Array, float], Array]) -> NodeChange:
    """Move all nodes to the changed distance from the line between the pins."""

    def changed(truth: ElasticTruth, motion: Motion, size: float) -> Motion:
        bent = _first_link(truth, motion)
        for node in bent.nodes[1:-1]:
            off = bent.off(node)
            motion = bent.moved(motion, node, change(off, size) - off)
        return motion

    return changed


def at_next_node(truth: ElasticTruth, motion: Motion, _: float) -> Motion:
    """Log the middle where the node before it is, with its deflection."""
    bent = _first_link(truth, motion)
    before, middle = bent.nodes[len(bent.nodes) // 2 - 1 :][:2]
    return bent.moved(motion, middle, bent.off(before) - bent.off(middle))


def at_quarter(truth: ElasticTruth, motion: Motion, share: float) -> Motion:
    """Move the first node, away from the middle, by a share of the deflection there, after the
    start has been looked at."""
    bent = _first_link(truth, motion)
    off = bent.off(bent.nodes[1])
    off[:WHEN] = 0.0
    return bent.moved(motion, bent.nodes[1], share * off)


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


def _given_back(chain: cut_links.CutScene, own: Motion, other: Motion) -> Motion:
    """Return the log with the links, the points and the deflections of another motion."""
    links = {**own.links, **{n: each for n, each in other.links.items() if n in own.links}}
    motion = replace(own, links=links, points={**own.points, **other.points})
    for name in chain.scene.elastic:
        bent = _BentLink(motion, chain.nodes(name))
        middle = bent.nodes[chain.count // 2]
        motion = bent.moved(motion, middle, other.elastic[name].middle - bent.off(middle))
    return motion


@dataclass(frozen=True)
class _BentLink:
    """An elastic link in a log, by its ``nodes``."""

    motion: Motion
    nodes: tuple[str, ...]

    @cached_property
    def across(self) -> Array:
        """Unit vector across the line from the first pin to the last (T, 2)."""
        first, end = (self.motion.points[node].position for node in (self.nodes[0], self.nodes[-1]))
        way = end - first
        across = np.stack([-way[:, 1], way[:, 0]], axis=1)
        return np.asarray(across / np.hypot(*way.T)[:, None])

    def off(self, node: str) -> Array:
        """Return the distance of a node from that line (T,) [m]."""
        first = self.motion.points[self.nodes[0]].position
        return np.asarray(((self.motion.points[node].position - first) * self.across).sum(axis=1))

    def moved(self, motion: Motion, node: str, by_m: Array) -> Motion:
        """Return a motion with a node so much farther off the line (T,)."""
        own = motion.points[node]
        there = replace(own, position=own.position + by_m[:, None] * self.across)
        return replace(motion, points={**motion.points, node: there})


def _first_link(truth: ElasticTruth, motion: Motion) -> _BentLink:
    return _BentLink(motion, truth.cut.nodes(next(iter(truth.scene.elastic))))


BeamChange = Callable[[Beam, float], Beam]


def in_beam(change: BeamChange) -> Plant:
    """Give the engine another beam, which starts where the right one does."""

    def changed(scene: Scene, size: float) -> Scene:
        beams = {name: change(beam, size) for name, beam in scene.beams.items()}
        links = dict(scene.links)
        for name, beam in beams.items():
            more = beam.density_kg_m / scene.beams[name].density_kg_m
            for node in beam.nodes:
                links[node] = replace(links[node], mass_kg=more * links[node].mass_kg)
        return replace(scene, links=links, beams=beams)

    return in_given(changed)


def in_given(change: SceneChange) -> Plant:
    """Give the engine another chain or beam, which starts where the right one does."""
    return in_scene(change, lambda _wrong, state, _dt_s: state)


def started(shape: Shape) -> Plant:
    """Start the right chain or beam with another shape, or as it should with a size of 0."""

    @planting
    def runner(size: float, scene: Scene, state: State, *args: Any, **options: Any) -> Run:
        return run(scene, _start(scene, shape) if size else state, *args, **options)

    return runner


def _start(given: Scene, shape: Shape) -> State:
    cut = truth_of_given(given).cut
    if isinstance(cut, cut_scenes.BeamedScene):
        return node_start(cut, shape)
    assert isinstance(cut, cut_scenes.SegmentedScene)
    return segment_start(cut, shape)


def stiffer_beam(beam: Beam, share: float) -> Beam:
    return replace(beam, flexural_n_m2=(1.0 + share) * beam.flexural_n_m2)
