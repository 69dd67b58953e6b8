"""The truth of a scene with elastic links: the beam, and the exact chain that engines are given.

An engine of rigid bodies is given each elastic link as a chain of segments. Its error is of two
parts, which different things mend: the exact chain beside the beam (more segments), and the engine
beside the exact chain (another step, other settings). Both truths have no engine in them.

The beam is described by sines across, with the shortening of a bent link. What it may be off by is
seen from fewer sines, and from where exact chains of more and more segments go to, which know
nothing of sines or of foreshortening: their distance to it falls as 1/n^2, up to what both neglect.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache

import numpy as np

from analytic.elastic.discretisation import Modes, Segments
from analytic.elastic.elastic_motion import DrivenElasticMotion
from analytic.elastic.segment_start import chain_motion, segment_start
from analytic.elastic.stiffness import fastest_rad_s, slowest_rad_s
from analytic.kinematics import solve
from models.array import Array
from models.elastic import Shape
from models.errors import CrankcheckError, EngineError
from models.motion import Motion, State
from models.scene import Same, Scene
from models.segmented import SegmentedScene
from reports.compare.beside import Beside, Truth
from reports.compare.elastic.elastic_beside import ElasticBeside
from reports.compare.elastic.folded_run import folded_run
from sim.engine import Run

PERIODIC, OTHER = Modes(7, 3), Modes(5, 2)
"""Sines of the beam: where it starts on its periodic motion, and where it is integrated, which
takes twenty times as long."""
FEW = 4
"""Segments of the chain that is integrated where the motion is not periodic: the fastest frequency
grows with the square of their number, and the time with it."""
LEAST = 16
"""Segments of the finer of two chains that say what the beam is off by."""
STEADY = 1.5
"""Of the step times the fastest frequency of the chain: explicit methods come apart from 2 on, or
from 2.8."""


@lru_cache(maxsize=2)
def elastic_truth(same: Same, count: int, springs: str, until_s: float) -> ElasticTruth:
    """The truth of a scene that is run until then [s], its elastic links in so many segments.

    Raises EngineError where there is no such chain: fewer than two segments, a link that stretches.
    """
    try:
        chain = SegmentedScene(same.scene, count, springs == "corrected")
        assert chain.rigid  # made now, to be refused now
    except CrankcheckError as error:
        raise EngineError(str(error)) from None
    return ElasticTruth(same.scene, chain=chain, until_s=until_s)


def shape_of(scene: Scene) -> Shape:
    """How the elastic links of a scene start; with their quasi-static shape if it does not say."""
    return scene.start.shape or "quasi-static"


@dataclass(frozen=True)
class ElasticTruth(Truth):
    """The stiffened beam as the reference; ``chain`` is what an engine is given, until ``until_s``
    [s]."""

    chain: SegmentedScene = field(kw_only=True)
    until_s: float = field(kw_only=True)
    _chains: dict[bytes, Motion] = field(default_factory=dict, repr=False, compare=False)

    @property
    def shape(self) -> Shape:
        return shape_of(self.scene)

    @property
    def is_periodic(self) -> bool:
        return self.shape == "periodic"

    @cached_property
    def _sines(self) -> Modes:
        return PERIODIC if self.is_periodic else OTHER

    @cached_property
    def _beam(self) -> DrivenElasticMotion:
        return self._moved(self._sines)

    @cached_property
    def _fewer_sines(self) -> DrivenElasticMotion:
        return self._moved(Modes(self._sines.across - 2, self._sines.along - 1))

    @cached_property
    def _linear(self) -> DrivenElasticMotion:
        return self._moved(OTHER, stiffened=False)

    def _moved(self, by: Modes, *, stiffened: bool = True) -> DrivenElasticMotion:
        return DrivenElasticMotion(self.scene, self.until_s, by, self.shape, stiffened)

    @cached_property
    def exact(self) -> ExactChain:
        """The chain that is given, without an engine."""
        return ExactChain(self.chain, self.until_s, self.shape)

    @cached_property
    def few(self) -> ExactChain:
        """The chain of a few segments, which is soon integrated, or of those that are given."""
        if self.chain.count <= FEW:
            return self.exact
        return ExactChain(replace(self.chain, count=FEW), self.until_s, self.shape)

    @cached_property
    def start(self) -> State:
        """That of the chain."""
        return segment_start(self.chain, self.shape, self.exact.motion)

    def look(self) -> None:
        """Find the start of the beam. Raises CrankcheckError where there is none."""
        assert self._beam.first

    @cached_property
    def fastest_rad_s(self) -> float:
        """The highest angular frequency of the chain."""
        return fastest_rad_s(self.scene, Segments(self.chain.count, self.chain.corrected))

    @cached_property
    def lowest_rad_s(self) -> float:
        """The lowest angular frequency of the links."""
        return slowest_rad_s(self.scene, OTHER)

    @property
    def ratio(self) -> float:
        """The lowest frequency of the links over the driver's."""
        return self.lowest_rad_s / self.scene.driver.law.peak_speed_rad_s

    def beam_at(self, time_s: Array) -> Motion:
        """As `at`, of instants that nothing is kept of."""
        return self._beam.at(time_s)

    def _solved(self, time_s: Array) -> Motion:
        rigid = solve(self.scene, time_s, links=(), points=(), sliders=(), bound=False)
        motion = self._beam.at(time_s)
        return replace(motion, conditioning=rigid.conditioning, crossings=rigid.crossings)

    def with_forces_at(self, time_s: Array) -> Motion:
        return self.at(time_s)

    def exact_at(self, time_s: Array) -> Motion:
        """The exact chain; of the last instants that were asked for it is kept."""
        instants = time_s.tobytes()
        if instants not in self._chains:
            motion = self.exact.at(time_s)
            self._chains.clear()
            self._chains[instants] = motion
        return self._chains[instants]

    def linear_at(self, time_s: Array) -> Motion:
        """By the linear theory, without foreshortening."""
        return self._linear.at(time_s)

    def fewer_sines_at(self, time_s: Array) -> Motion:
        """By two sines fewer."""
        return self._fewer_sines.at(time_s)

    def limit_of_chains_at(self, time_s: Array) -> dict[str, Array]:
        """Where the deflections of chains go to as segments grow in number, by link: those of two
        numbers of segments, without the part that falls as 1/n^2."""
        fine = self.chain.count if self.chain.count >= LEAST else LEAST
        coarse = fine // 2
        of_fine, of_coarse = (
            ExactChain(replace(self.chain, count=n), self.until_s, self.shape).at(time_s).elastic
            if n != self.chain.count
            else self.exact.at(time_s).elastic
            for n in (fine, coarse)
        )
        gain = fine**2 / (fine**2 - coarse**2)
        return {
            name: of_coarse[name].middle + gain * (of_fine[name].middle - of_coarse[name].middle)
            for name in of_fine
        }

    def logged(self, run: Run) -> Run:
        """A run of the chain as one of the scene."""
        done = folded_run(self.chain, run)
        stiff = run.dt_s * self.fastest_rad_s
        if done.status != "diverged" or stiff <= STEADY:
            return done
        needed = int(np.ceil(self.scene.driver.law.period_s * self.fastest_rad_s / STEADY))
        return replace(
            done,
            reason=f"{done.reason}; the fastest frequency of {self.chain.count} segments is "
            f"{self.fastest_rad_s:.4g} rad/s, {stiff:.2g} over the step, and explicit steps hold "
            f"up to about {STEADY}: take {needed} steps a turn, or fewer segments",
        )

    def beside(self, run: Run) -> Beside | None:
        """The run, with its elastic links as such, beside the beam; None where it logged
        nothing."""
        motion = run.motion
        if motion is None or not motion.time_s.size:
            return None
        return ElasticBeside(self, run, motion, elastic=self)


@dataclass(frozen=True)
class ExactChain:
    """A chain of segments as a multibody of our own, and its motion as one of the scene."""

    chain: SegmentedScene
    until_s: float
    shape: Shape

    @cached_property
    def motion(self) -> DrivenElasticMotion:
        return chain_motion(self.chain, self.shape, self.until_s)

    def at(self, time_s: Array) -> Motion:
        """At times [s] (T,), with the links and points of the scene."""
        motion = self.motion.at(time_s)
        first = {
            self.chain.segments(name)[0]: motion.links[name] for name in self.chain.scene.elastic
        }
        return self.chain.folded(replace(motion, links={**motion.links, **first}))
