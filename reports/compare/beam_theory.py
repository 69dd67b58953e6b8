"""The beam that engines are held to, and what it may be off by.

It is described by polynomials, with the shortening of a bent link. What it may be off by is seen
from fewer of them, or more, and from where exact chains of more and more segments go to, which know
nothing of polynomials or of foreshortening: their distance to it falls as 1/n^2, up to what the
beam neglects.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import ClassVar

import numpy as np

from analytic.elastic.control import elastic_history
from analytic.elastic.discretisation import REFERENCE, Polynomials
from analytic.elastic.elastic_motion import ElasticHistory
from analytic.elastic.engine_start import chain_motion
from analytic.elastic.natural import lowest_rad_s
from analytic.elastic.released import ROUGH
from models.array import Array
from models.motion import Motion
from models.scene import Scene
from models.scene.cut_scenes import SegmentedScene
from models.scene.elastic import Shape
from reports.quantities.by_kind import largest_deflection

FEWER = Polynomials(REFERENCE.across - 2, REFERENCE.along - 1)
"""What says how far the reference is to be trusted."""
FINE, COARSE, LEAST = 8, 4, 4
"""Segments of the chains that say where more and more of them go to; and of the one that is
integrated where the motion is not periodic: the fastest frequency grows with the square of their
number, and the time with it."""
LOOKS = 400
"""Instants at which theories are compared with each other; none of them has a jump."""


def shape_of(scene: Scene) -> Shape:
    """How the elastic links of a scene start; with their quasi-static shape if it does not say."""
    return scene.start.shape or "quasi-static"


@dataclass(frozen=True)
class BeamTheory:
    """The links of a scene as beams with foreshortening, from time 0 to ``until_s`` [s]; what is
    periodic goes on for ever."""

    others: ClassVar[Polynomials] = FEWER
    """Another description of the beam."""
    looked_by: ClassVar[Polynomials] = REFERENCE
    """Of the linear theory."""
    scene: Scene
    until_s: float

    @property
    def doubted(self) -> Sequence[tuple[Motion, Motion]]:
        """Motions whose difference is a doubt of all that is compared, but of deflections."""
        return ()

    @property
    def shape(self) -> Shape:
        return shape_of(self.scene)

    @property
    def is_periodic(self) -> bool:
        return self.shape == "periodic"

    @cached_property
    def beam(self) -> ElasticHistory:
        return self._moved(REFERENCE)

    def _moved(self, by: Polynomials, *, stiffened: bool = True) -> ElasticHistory:
        return elastic_history(
            self.scene, self.until_s, by, self.shape, stiffened=stiffened, tolerance=ROUGH
        )

    @cached_property
    def other(self) -> ElasticHistory:
        """By other polynomials."""
        return self._moved(self.others)

    @cached_property
    def lowest_rad_s(self) -> float:
        """The lowest angular frequency of the links, each alone."""
        return lowest_rad_s(self.scene)

    @cached_property
    def looks_s(self) -> Array:
        """The instants at which theories are compared."""
        return np.linspace(0.0, self.until_s, LOOKS)

    @cached_property
    def looked(self) -> Motion:
        """The beam there."""
        return self.beam.at(self.looks_s)

    @cached_property
    def looked_other(self) -> Motion:
        """The other description of it, there."""
        return self.other.at(self.looks_s)

    @cached_property
    def largest_m(self) -> float:
        """The largest deflection."""
        return largest_deflection(self.scene, self.looked)

    @cached_property
    def linear_m(self) -> float:
        """What the linear theory, without foreshortening, is off by."""
        linear = self._moved(self.looked_by, stiffened=False).at(self.looks_s)
        return deflections_apart(linear, self.looked)

    @cached_property
    def doubt_m(self) -> float:
        """What the beam may be off by: what other polynomials are off it by and, where chains are
        soon found, how far from it these go to."""
        off = deflections_apart(self.looked_other, self.looked)
        chained = self.is_periodic and not any(e.stretches for e in self.scene.elastic.values())
        return max(off, self._beside_chains()) if chained else off

    def _beside_chains(self) -> float:
        """How far from the beam two chains go to, without the part that falls as 1/n^2 [m]."""
        fine, coarse = (self.chain(count).at(self.looks_s) for count in (FINE, COARSE))
        gain = FINE**2 / (FINE**2 - COARSE**2)
        return max(
            float(np.abs(rough.middle + gain * (fine.elastic[name].middle - rough.middle)
                         - self.looked.elastic[name].middle).max())
            for name, rough in coarse.elastic.items()
        )  # fmt: skip

    def chain(self, count: int, *, corrected: bool = False) -> ExactChain:
        """The exact chain of so many segments."""
        return ExactChain(SegmentedScene(self.scene, count, corrected), self.until_s, self.shape)

    @property
    def cycles_per_s(self) -> float:
        """How often the links swing, 0 where their motion is periodic."""
        return 0.0 if self.is_periodic else self.lowest_rad_s / math.tau


class FreeBeamTheory(BeamTheory):
    """As `BeamTheory`, of free motion: small differences grow there, and the beam's own doubt of
    all of it with them."""

    others: ClassVar[Polynomials] = REFERENCE.finer
    looked_by: ClassVar[Polynomials] = FEWER  # at half the time

    @property
    def doubted(self) -> Sequence[tuple[Motion, Motion]]:
        return ((self.looked_other, self.looked),)


def deflections_apart(one: Motion, other: Motion) -> float:
    """The largest difference of the deflections of two motions [m]."""
    return max(
        float(np.abs(one.elastic[name].middle - other.elastic[name].middle).max())
        for name in other.elastic
    )


@dataclass(frozen=True)
class ExactChain:
    """A chain of segments as a multibody of our own, and its motion as one of the scene."""

    chain: SegmentedScene
    until_s: float
    shape: Shape

    @cached_property
    def motion(self) -> ElasticHistory:
        return chain_motion(self.chain, self.shape, self.until_s)

    def at(self, time_s: Array) -> Motion:
        """At times [s] (T,), with the links and points of the scene."""
        motion = self.motion.at(time_s)
        first = {
            self.chain.segments(name)[0]: motion.links[name] for name in self.chain.scene.elastic
        }
        return self.chain.folded(replace(motion, links={**motion.links, **first}))
