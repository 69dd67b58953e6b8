"""The reference of free motion with elastic links: the beam, and the exact chain, with all swings.

Errors at the same time are judged over the sensitivity of the same mechanism with rigid links: a
small change of the start grows by so much, and the swings add little to that.
"""

from __future__ import annotations

import math
import pickle
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache
from typing import ClassVar

import numpy as np

from analytic.elastic.discretisation import ElasticDoubt
from analytic.elastic.elastic_motion import energies, sampled
from analytic.elastic.released import ReleasedElasticMotion
from analytic.free.free_motion import FreeMotion, LimitPassage
from analytic.multibody.bodies import EnergyBalance
from models.array import Array
from models.errors import EngineError, ReachError
from models.motion import Motion
from models.scene import Scene, as_bytes, cut_links, cut_scenes
from reports.compare import beam_theory, compare, elastic_truth, free_truth
from reports.compare.free_truth import FreeBeside, FreeTruth
from reports.quantities.free_and_elastic import PHASE
from sim.engine import Run

MOST_EXACT = 32
"""Most segments of an integrated chain: with 32 a second of the shipped pulse takes some ten."""
MOST_DOUBT = 0.05
"""Uncertainty of the beam's deflection, over the largest, beyond which samples are not judged."""


def released_elastic_truth(
    scene: Scene,
    count: int,
    springs: str,
    steps: int,
    dt_s: float,
    tolerance: Mapping[str, float] | None = None,
) -> ReleasedElasticTruth:
    """Return the reference of a free scene for ``steps`` steps of ``dt_s`` [s], its elastic links
    in ``count`` segments. Raises EngineError as `elastic_truth`, and CrankcheckError for a scene
    without free motion."""
    limit = (tolerance or {}).get("phase", scene.tolerance.get("phase"))
    known_rad = free_truth.LEAST_KNOWN * (limit or PHASE.criteria[0].tolerance.cap)
    return _truth(as_bytes(scene), count, springs, steps, dt_s, known_rad)


@lru_cache(maxsize=4)
def _truth(
    pickled: bytes, count: int, springs: str, steps: int, dt_s: float, known_rad: float
) -> ReleasedElasticTruth:
    scene: Scene = pickle.loads(pickled)
    until_s = free_truth.long_enough_s(scene, dt_s * steps)
    theory = elastic_truth.kept_theory(pickled, until_s, beam_theory.FreeBeamTheory)
    chain = elastic_truth.cut_scene(scene, count, springs)
    if not isinstance(chain, cut_scenes.SegmentedScene):
        raise EngineError(
            f"{scene.name}: free motion with an engine's own beams has no reference yet; leave "
            "--springs beam out"
        )
    rigid = free_truth.free_truth(cut_links.with_rigid_links(scene), steps, dt_s)
    paced = replace(scene, driver=rigid.scene.driver)
    return ReleasedElasticTruth(paced, cut=chain, theory=theory, rigid=rigid, known_rad=known_rad)


@dataclass(frozen=True)
class ReleasedElasticTruth(elastic_truth.ChainTruth):
    """The reference of a free scene with elastic links. ``rigid`` is that with rigid links: errors
    are judged over its sensitivity, and its ``scene`` has the largest speed of the driver. Samples
    count as long as the uncertainty of the beam's angles, over the sensitivity, is at most
    ``known_rad``, and its deflection known to a part of the largest."""

    rigid: FreeTruth = field(kw_only=True)
    known_rad: float = field(kw_only=True)

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
        motion = at_any(self.beam, time_s)
        return replace(motion, conditioning=rigid.conditioning, crossings=rigid.crossings)

    @property
    def needed_step(self) -> str:
        return f"a step of {elastic_truth.STEADY / self.fastest_rad_s:.3g} s"

    @cached_property
    def known_s(self) -> float:
        """Time until which the reference is known well enough to judge by."""
        theory, time_s = self.theory, self.theory.looks_s
        doubt = ElasticDoubt.between(theory.looked, theory.looked_other).so_far
        turned = np.max(list(doubt.theta_rad.values()), axis=0)
        bent = np.max(list(doubt.middle_m.values()), axis=0)
        unsure = turned / self.rigid.free.sensitivity(np.minimum(time_s, self.rigid.free.until_s))
        known = unsure <= self.known_rad
        known &= bent <= MOST_DOUBT * theory.largest_m
        return math.inf if known.all() else float(time_s[int(np.argmin(known))])

    def _beside(self, run: Run, motion: Motion) -> compare.Beside:
        known = int(np.searchsorted(motion.time_s, self.known_s))
        judged = compare.first_samples(run, max(known, 1))
        assert judged.motion is not None
        # The reference energies are those of the engine's own chain, if known.
        works = self.exact.motion if self.is_exact else self.beam
        assert isinstance(works, ReleasedElasticMotion)
        return ReleasedElasticBeside(
            self,
            judged,
            judged.motion,
            elastic=self,
            whole_run=run,
            free=BentReference(self.rigid.free, works),
        )


def at_any(motion: ReleasedElasticMotion, time_s: Array) -> Motion:
    """Return a motion at ascending times [s], (T,), up to a step before its start and its end."""
    early, late = time_s < 0.0, time_s > motion.until_s
    if not (early.any() or late.any()):
        return sampled(motion, time_s)
    parts = [motion.outside(time_s[part]) for part in (early, late) if part.any()]
    within = time_s[~(early | late)]
    if within.size:
        parts.insert(int(early.any()), sampled(motion, within))
    return Motion.joined(parts)


@dataclass(frozen=True)
class BentReference:
    """Reference quantities for a run whose links bend (`FreeReference`): the sensitivity of the
    ``rigid`` mechanism, and the energies of the ``elastic`` one."""

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
        """Raise ReachError: where links bend, the driver's angle does not fix their positions."""
        raise ReachError("the driver's angle does not determine the others, as links are elastic")


@dataclass(frozen=True)
class ReleasedElasticBeside(elastic_truth.ElasticBeside, FreeBeside):
    """As `FreeBeside`, without a geometry at the driver's own angle."""

    compared_by: ClassVar[tuple[str, ...]] = (*FreeBeside.compared_by, ".elastic_errors")

    @property
    def no_geometry(self) -> str:
        return "no geometry: the driver's angle does not determine the others, as links are elastic"

    @property
    def tells_momentum(self) -> bool:
        return False
