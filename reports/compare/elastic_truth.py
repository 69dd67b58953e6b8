"""The reference of a scene with elastic links: the beam, and the exact chain that engines simulate.

An engine of rigid bodies gets each elastic link as a chain of segments. Its error has two parts
with different remedies: the exact chain against the beam (more segments), and the engine against
the exact chain (another step, other settings). Both references are free of engines. An engine with
beams of its own may get these: its only reference is the beam.
"""

from __future__ import annotations

import math
import pickle
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache
from typing import ClassVar

from analytic.elastic.discretisation import Segments
from analytic.elastic.elastic_motion import fastest_rad_s
from analytic.elastic.engine_start import node_start, segment_start
from analytic.kinematics import solve
from models.array import Array
from models.errors import CrankcheckError, EngineError, ReachError
from models.motion import Forces, Motion, State
from models.scene import Scene, as_bytes
from models.scene.cut_links import CutScene
from models.scene.cut_scenes import BeamedScene, SegmentedScene
from reports.compare.beam_theory import LEAST, BeamTheory, ExactChain, shape_of
from reports.compare.compare import Beside, Truth, kept
from sim.engine import Run


def cut(scene: Scene, count: int, springs: str) -> CutScene:
    """Return the links of a scene in ``count`` segments, with springs "plain" or "corrected"; or in
    as many elements of a "beam". Raises CrankcheckError as these do."""
    if springs == "beam":
        return BeamedScene(scene, count)
    return SegmentedScene(scene, count, springs == "corrected")


Apart = dict[str, float]
STEADY = 1.5
"""Limit of the step times the fastest frequency of the chain: explicit methods come apart from 2
on, or from 2.8."""


def elastic_truth(scene: Scene, count: int, springs: str, until_s: float) -> ElasticTruth:
    """Return the reference of a scene that is driven until then [s], its elastic links in ``count``
    segments, or elements of a beam.

    Raises EngineError where they are impossible: fewer than two, segments of a stretching link.
    """
    if shape_of(scene) == "periodic":  # however long a run is, the truth is one
        until_s = scene.driver.law.period_s
    return _truth(as_bytes(scene), count, springs, until_s)


def chain_truth(scene: Scene, count: int, until_s: float) -> ChainTruth:
    """Return `elastic_truth` for segments with plain springs."""
    truth = elastic_truth(scene, count, "plain", until_s)
    assert isinstance(truth, ChainTruth)
    return truth


@lru_cache(maxsize=4)
def _truth(pickled: bytes, count: int, springs: str, until_s: float) -> ElasticTruth:
    theory = kept_theory(pickled, until_s)
    pieces = cut_scene(theory.scene, count, springs)
    kind = ChainTruth if isinstance(pieces, SegmentedScene) else ElasticTruth
    return kind(theory.scene, cut=pieces, theory=theory)


def cut_scene(scene: Scene, count: int, springs: str) -> CutScene:
    """Return a scene with its elastic links in pieces. Raises EngineError if impossible."""
    try:
        pieces = cut(scene, count, springs)
        assert pieces.given  # made now, to be refused now
    except CrankcheckError as error:
        raise EngineError(str(error)) from None
    return pieces


@lru_cache(maxsize=2)
def kept_theory(pickled: bytes, until_s: float, kind: type[BeamTheory] = BeamTheory) -> BeamTheory:
    """Return the beam of a scene, maybe of another process, for any number of segments."""
    return kind(pickle.loads(pickled), until_s)


@dataclass(frozen=True)
class ElasticTruth(Truth):
    """The stiffened beam of ``theory`` as the reference; an engine gets the scene as ``cut``: beams
    of its own, unless it is a `ChainTruth`."""

    cut: CutScene = field(kw_only=True)
    theory: BeamTheory = field(kw_only=True)

    @property
    def springs(self) -> str:
        """The connection between the pieces."""
        return "beam"

    @property
    def given(self) -> Scene:
        return self.cut.given

    @property
    def is_exact(self) -> bool:
        """True if the motion of the pieces is cheap to compute without an engine."""
        return False

    def apart(self, by_name: Callable[[Motion, Motion], Apart]) -> Apart:
        """Return the distance of the pieces from the beam, as a pure number by quantity,
        ``by_name`` for two motions; an estimate from the elements' locking, where not exact."""
        largest = self.theory.largest_m
        off = (one.locked(largest) + one.between() for one in self.given.beams.values())
        return {"deflection": max(off)}

    @property
    def doubt(self) -> float:
        """Uncertainty of the beam, as a share of its largest deflection. Its slopes are small:
        elements, whose slopes are not, show the terms in their squares."""
        largest = self.theory.largest_m
        beams = self.given.beams.values()
        slopes = max((math.pi * largest / one.length_m) ** 2 for one in beams)
        return max(self.theory.doubt_m / largest, slopes)

    @property
    def pushed(self) -> float:
        """Acceleration error of the pieces at the start, over the square of the driver's speed."""
        start = self.theory.looked.elastic
        most = max(
            one.pushed(abs(float(start[name].middle[0]))) for name, one in self.given.beams.items()
        )
        return most / self.scene.pace_rad_s**2

    @cached_property
    def start(self) -> State:
        """The start of the beam's nodes."""
        assert isinstance(self.cut, BeamedScene)
        return node_start(self.cut, self.theory.shape)

    def look(self) -> None:
        """Find the start of the beam. Raises CrankcheckError where there is none."""
        assert self.theory.beam.begun

    def _solved(self, time_s: Array) -> Motion:
        rigid = solve(self.scene, time_s, links=(), points=(), sliders=(), bound=False)
        motion = self.theory.beam.at(time_s)
        return replace(motion, conditioning=rigid.conditioning, crossings=rigid.crossings)

    def with_forces_at(self, time_s: Array) -> Motion:
        return self.at(time_s)

    def exact_at(self, time_s: Array) -> Motion | None:
        """Return the exact chain at times (T,) [s]; None for a beam."""
        return None

    def logged(self, run: Run) -> Run:
        """Return a run with links, points and pins of the scene; the pins between pieces show in
        the deflection, which is off where they come apart."""
        if run.motion is None:
            return run
        cut, folded = self.cut, self.cut.folded(run.motion)
        inner = {node for name in cut.scene.elastic for node in cut.nodes(name)[1:-1]}
        if folded.forces is not None:
            links = {part: name for name in cut.scene.elastic for part in cut.bodies(name)}
            folded = replace(folded, forces=_without(folded.forces, inner, links))
        gaps = {name: gap for name, gap in run.gaps.items() if name not in inner}
        return replace(run, motion=folded, gaps=gaps)

    def _beside(self, run: Run, motion: Motion) -> Beside:
        return ElasticBeside(self, run, motion, elastic=self)


@dataclass(frozen=True)
class ChainTruth(ElasticTruth):
    """As `ElasticTruth`, for an engine with chains of segments: their exact motion is known too."""

    _chains: dict[bytes, Motion] = field(default_factory=dict, repr=False, compare=False)

    @property
    def chain(self) -> SegmentedScene:
        """The scene of the engine."""
        assert isinstance(self.cut, SegmentedScene)
        return self.cut

    @property
    def springs(self) -> str:
        return "corrected" if self.chain.corrected else "plain"

    @cached_property
    def exact(self) -> ExactChain:
        """The engine's chain, without an engine."""
        return self.theory.chain(self.chain.count, corrected=self.chain.corrected)

    @property
    def is_exact(self) -> bool:
        """True if the motion is periodic, or the segments few: to integrate many takes minutes."""
        return self.theory.is_periodic or self.chain.count <= LEAST

    def apart(self, by_name: Callable[[Motion, Motion], Apart]) -> Apart:
        """Return the distance of the engine's chain, or estimate it from one of few segments."""
        few, share = self.exact, 1.0
        if not self.is_exact:
            few = self.theory.chain(LEAST, corrected=self.chain.corrected)
            share = (LEAST / self.cut.count) ** 2
        found = by_name(few.at(self.theory.looks_s), self.theory.looked)
        return {name: share * size for name, size in found.items()}

    @property
    def doubt(self) -> float:
        return self.theory.doubt_m / self.theory.largest_m

    @property
    def pushed(self) -> float:
        return 0.0

    @cached_property
    def start(self) -> State:
        """The start of the chain."""
        return segment_start(self.chain, self.theory.shape, self.exact.motion)

    @cached_property
    def fastest_rad_s(self) -> float:
        """The highest angular frequency of the chain."""
        return fastest_rad_s(self.theory.scene, Segments(self.chain.count, self.chain.corrected))

    def exact_at(self, time_s: Array) -> Motion:
        """Return the exact chain at times (T,) [s]."""
        return kept(self._chains, time_s, self.exact.at)

    def logged(self, run: Run) -> Run:
        """Return the run as one of the scene; if it came apart, its reason names a stable step."""
        done = super().logged(run)
        stiff = run.dt_s * self.fastest_rad_s
        if done.status != "diverged" or stiff <= STEADY:
            return done
        return replace(
            done,
            reason=f"{done.reason}; the fastest frequency of {self.chain.count} segments is "
            f"{self.fastest_rad_s:.4g} rad/s (times the step: {stiff:.2g}), and explicit "
            f"steps are stable up to about {STEADY}: use {self.needed_step}, or fewer "
            "segments",
        )

    @property
    def needed_step(self) -> str:
        """The longest stable step, in words."""
        period_s = self.scene.driver.law.period_s
        return f"{math.ceil(period_s * self.fastest_rad_s / STEADY)} steps a turn"


@dataclass(frozen=True)
class ElasticBeside(Beside):
    """As `Beside`, without errors at the logged angle: it determines no other of bent links."""

    compared_by: ClassVar[tuple[str, ...]] = (*Beside.compared_by, ".elastic_errors")
    elastic: ElasticTruth = field(kw_only=True)

    @cached_property
    def exact(self) -> Motion | None:
        """The exact chain at the logged instants, None where it takes too long."""
        truth = self.elastic
        return truth.exact_at(self.motion.time_s) if truth.is_exact else None

    @property
    def has_crank(self) -> bool:
        return False

    @cached_property
    def at_crank(self) -> Motion:
        raise ReachError("the driver's angle does not determine the others, as links are elastic")


def _without(forces: Forces, inner: set[str], links: Mapping[str, str]) -> Forces:
    def on_links(bodies: Mapping[str, Array]) -> dict[str, Array]:
        return {links.get(body, body): force for body, force in bodies.items()}

    pins = {point: on_links(own) for point, own in forces.pins.items() if point not in inner}
    friction = {joint: own for joint, own in forces.friction.items() if joint not in inner}
    return replace(forces, pins=pins, friction=friction)
