"""The truth of elastic links that are let go: the beam, and the exact chain, with all their swings.

Errors at the same time are judged over the sensitivity of the same mechanism with rigid links: by
so much a small change of the start grows, and what swings beside it adds little to that.
"""

from __future__ import annotations

import math
import pickle
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache

import numpy as np

from analytic.elastic.released import DoubtOverTime, ReleasedElasticMotion
from analytic.elastic.sampled import energies, sampled
from analytic.free.free_motion import FreeMotion, LimitPassage
from analytic.multibody.energy_balance import EnergyBalance
from models.array import Array
from models.errors import ReachError
from models.motion import Motion
from models.rigid import with_rigid_links
from models.scene import Scene
from reports.compare.beside import Beside
from reports.compare.elastic.elastic_truth import (
    STEADY,
    ElasticTruth,
    kept_theory,
    segmented_scene,
)
from reports.compare.elastic.released_beside import ReleasedElasticBeside
from reports.compare.free.free_truth import FreeTruth, free_truth
from reports.compare.free.some_samples import first_samples
from sim.engine import Run

MOST_EXACT = 32
"""Segments whose exact chain is integrated: of 32 a second of the shipped pulse takes some ten."""
MOST_DOUBT = 0.05
"""What the deflection of the beam may be off by, of the largest: samples beyond are not judged."""


def released_elastic_truth(
    scene: Scene,
    count: int,
    springs: str,
    steps: int,
    dt_s: float,
    tolerance: Mapping[str, float] | None = None,
) -> ReleasedElasticTruth:
    """The truth of a scene that is let go for so many steps of ``dt_s`` [s], its elastic links in
    so many segments. Raises EngineError as `elastic_truth`, and CrankcheckError for a scene that
    can not be let go."""
    given = tuple(sorted((tolerance or {}).items()))
    return _truth(pickle.dumps(scene), count, springs, steps, dt_s, given)


@lru_cache(maxsize=4)
def _truth(
    pickled: bytes,
    count: int,
    springs: str,
    steps: int,
    dt_s: float,
    tolerance: tuple[tuple[str, float], ...],
) -> ReleasedElasticTruth:
    # A step longer: some velocities belong to half a step after a run.
    theory = kept_theory(pickled, float(f"{dt_s * (steps + 1):.12g}"))
    scene = theory.scene
    rigid = free_truth(with_rigid_links(scene), steps, dt_s, dict(tolerance))
    paced = replace(scene, driver=rigid.scene.driver)
    chain = segmented_scene(scene, count, springs)
    return ReleasedElasticTruth(paced, chain=chain, theory=theory, rigid=rigid)


@dataclass(frozen=True)
class ReleasedElasticTruth(ElasticTruth):
    """``rigid`` is the truth of the same scene with rigid links, whose sensitivity errors are
    judged over, and whose ``scene`` has the largest speed of the driver."""

    rigid: FreeTruth = field(kw_only=True)

    @property
    def is_exact(self) -> bool:
        return self.chain.count <= MOST_EXACT

    @cached_property
    def beam(self) -> ReleasedElasticMotion:
        beam = self.theory.beam
        assert isinstance(beam, ReleasedElasticMotion)
        return beam

    def _solved(self, time_s: Array) -> Motion:
        rigid = self.rigid.at(time_s)
        motion = both_sides(self.beam, time_s)
        return replace(motion, conditioning=rigid.conditioning, crossings=rigid.crossings)

    @property
    def needed_step(self) -> str:
        return f"a step of {STEADY / self.fastest_rad_s:.3g} s"

    @cached_property
    def doubt(self) -> DoubtOverTime:
        """What the beam may be off by, at the instants at which theories are compared."""
        return DoubtOverTime.between(self.theory.looked, self.theory.other.at(self.theory.looks_s))

    @cached_property
    def known_s(self) -> float:
        """Until when the truth is known well enough to judge by."""
        doubt, time_s = self.doubt, self.theory.looks_s
        unsure = doubt.angle_rad / self.rigid.free.sensitivity(
            np.clip(time_s, 0.0, self.rigid.free.until_s)
        )
        known = (unsure <= self.rigid.known_rad) & (
            doubt.deflection_m <= MOST_DOUBT * self.theory.largest_m
        )
        return math.inf if known.all() else float(time_s[int(np.argmin(known))])

    @property
    def _works(self) -> ReleasedElasticMotion:
        """The motion whose energies an engine's are held to: that of its own chain, if it is
        known."""
        motion = self.exact.motion if self.is_exact else self.beam
        assert isinstance(motion, ReleasedElasticMotion)
        return motion

    def beside(self, run: Run) -> Beside | None:
        motion = run.motion
        if motion is None or not motion.time_s.size:
            return None
        known = int(np.searchsorted(motion.time_s, self.known_s))
        judged = first_samples(run, max(known, 1))
        assert judged.motion is not None
        return ReleasedElasticBeside(
            self,
            judged,
            judged.motion,
            elastic=self,
            whole_run=run,
            free=BentReference(self.rigid.free, self._works),
        )


def both_sides(motion: ReleasedElasticMotion, time_s: Array) -> Motion:
    """A motion at times in ascending order [s], (T,), some of which may be before its start."""
    early = time_s < 0.0
    if not early.any():
        return sampled(motion, time_s)
    parts = [motion.before(time_s[early])]
    return Motion.joined(parts if early.all() else [*parts, sampled(motion, time_s[~early])])


@dataclass(frozen=True)
class BentReference:
    """What errors of a run whose links bend are judged over (`FreeReference`): the sensitivity of
    the ``rigid`` mechanism, and the energies of the ``elastic`` one."""

    rigid: FreeMotion
    elastic: ReleasedElasticMotion
    by_dyads = False
    driver_tells = False
    passages: tuple[LimitPassage, ...] = ()

    @property
    def until_s(self) -> float:
        return self.elastic.until_s

    def energy(self, time_s: Array) -> EnergyBalance:
        return energies(self.elastic, time_s)

    def sensitivity(self, time_s: Array) -> Array:
        return self.rigid.sensitivity(np.clip(time_s, 0.0, self.rigid.until_s))

    def beside(self, logged: Motion) -> Motion:
        """Raises ReachError: where links bend the driver's angle does not say where they are."""
        raise ReachError("where links bend the driver's angle does not say where the others are")
