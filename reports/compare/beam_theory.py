"""The beam that is the reference of elastic links, and its uncertainty.

Polynomials describe it, with the shortening of a bent link. Its uncertainty follows from fewer or
more of them, and from the limit of exact chains of ever more segments, which need neither
polynomials nor foreshortening: their distance to it falls as 1/n^2, down to the effects that the
beam neglects.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import ClassVar

import numpy as np

from analytic.elastic import control, elastic_motion, engine_start, natural, released
from analytic.elastic.discretisation import REFERENCE, Polynomials
from models.array import Array
from models.motion import Motion
from models.scene import Scene
from models.scene.cut_scenes import SegmentedScene
from models.scene.elastic import Shape
from reports.quantities.free_and_elastic import largest_deflection

FEWER = Polynomials(REFERENCE.across - 2, REFERENCE.along - 1)
"""Polynomials that show how far the reference can be trusted."""
FINE, COARSE, LEAST = 8, 4, 4
"""Segments of the chains that are extrapolated to infinitely many; and of the chain that is
integrated where the motion is not periodic: the fastest frequency grows with the square of their
number, and the time with it."""
LOOKS = 400
"""Instants at which theories are compared with each other; none of them has a jump."""


def shape_of(scene: Scene) -> Shape:
    """Return the start of the elastic links of a scene; their quasi-static shape by default."""
    return scene.start.shape or "quasi-static"


@dataclass(frozen=True)
class BeamTheory:
    """Links as beams with foreshortening, until ``until_s`` [s]; without end if periodic."""

    others: ClassVar[Polynomials] = FEWER
    """Polynomials of another description of the beam."""
    looked_by: ClassVar[Polynomials] = REFERENCE
    """Polynomials of the linear theory."""
    scene: Scene
    until_s: float

    @property
    def doubted(self) -> Sequence[tuple[Motion, Motion]]:
        """Pairs of motions whose difference is an uncertainty of all quantities but deflections."""
        return ()

    @property
    def shape(self) -> Shape:
        return shape_of(self.scene)

    @property
    def is_periodic(self) -> bool:
        return self.shape == "periodic"

    @cached_property
    def beam(self) -> elastic_motion.ElasticHistory:
        return self._moved(REFERENCE)

    def _moved(self, by: Polynomials, *, stiffened: bool = True) -> elastic_motion.ElasticHistory:
        return control.elastic_history(
            self.scene, self.until_s, by, self.shape, stiffened=stiffened, tolerance=released.ROUGH
        )

    @cached_property
    def other(self) -> elastic_motion.ElasticHistory:
        """The motion by other polynomials."""
        return self._moved(self.others)

    @cached_property
    def lowest_rad_s(self) -> float:
        """The lowest angular frequency of the links, each alone."""
        return natural.lowest_rad_s(self.scene)

    @cached_property
    def looks_s(self) -> Array:
        """The instants at which theories are compared."""
        return np.linspace(0.0, self.until_s, LOOKS)

    @cached_property
    def looked(self) -> Motion:
        """The motion of the beam at these instants."""
        return self.beam.at(self.looks_s)

    @cached_property
    def looked_other(self) -> Motion:
        """The motion by the other polynomials at these instants."""
        return self.other.at(self.looks_s)

    @cached_property
    def largest_m(self) -> float:
        """The largest deflection."""
        return largest_deflection(self.scene, self.looked)

    @cached_property
    def linear_m(self) -> float:
        """Error of the linear theory, without foreshortening [m]."""
        linear = self._moved(self.looked_by, stiffened=False).at(self.looks_s)
        return deflections_apart(linear, self.looked)

    @cached_property
    def doubt_m(self) -> float:
        """Uncertainty of the beam [m]: its difference to other polynomials and, for cheap chains,
        their extrapolated distance from it."""
        off = deflections_apart(self.looked_other, self.looked)
        chained = self.is_periodic and not any(e.stretches for e in self.scene.elastic.values())
        return max(off, self._beside_chains()) if chained else off

    def _beside_chains(self) -> float:
        """Return the distance from the beam of two chains extrapolated by 1/n^2 [m]."""
        fine, coarse = (self.chain(count).at(self.looks_s) for count in (FINE, COARSE))
        gain = FINE**2 / (FINE**2 - COARSE**2)
        return max(
            float(np.abs(rough.middle + gain * (fine.elastic[name].middle - rough.middle)
                         - self.looked.elastic[name].middle).max())
            for name, rough in coarse.elastic.items()
        )  # fmt: skip

    def chain(self, count: int, *, corrected: bool = False) -> ExactChain:
        """Return the exact chain of ``count`` segments."""
        return ExactChain(SegmentedScene(self.scene, count, corrected), self.until_s, self.shape)

    @property
    def cycles_per_s(self) -> float:
        """Frequency of the swings of the links, 0 where their motion is periodic."""
        return 0.0 if self.is_periodic else self.lowest_rad_s / math.tau


class FreeBeamTheory(BeamTheory):
    """As `BeamTheory`, for free motion, in which the uncertainty of the whole beam grows."""

    others: ClassVar[Polynomials] = REFERENCE.finer
    looked_by: ClassVar[Polynomials] = FEWER  # at half the time

    @property
    def doubted(self) -> Sequence[tuple[Motion, Motion]]:
        return ((self.looked_other, self.looked),)


def deflections_apart(one: Motion, other: Motion) -> float:
    """Return the largest difference of the deflections of two motions [m]."""
    return max(
        float(np.abs(one.elastic[name].middle - other.elastic[name].middle).max())
        for name in other.elastic
    )


@dataclass(frozen=True)
class ExactChain:
    """A chain of segments as a multibody of our own, with its motion in the scene's terms."""

    chain: SegmentedScene
    until_s: float
    shape: Shape

    @cached_property
    def motion(self) -> elastic_motion.ElasticHistory:
        return engine_start.chain_motion(self.chain, self.shape, self.until_s)

    def at(self, time_s: Array) -> Motion:
        """Return the motion at times [s] (T,), with the links and points of the scene."""
        motion = self.motion.at(time_s)
        first = {
            self.chain.segments(name)[0]: motion.links[name] for name in self.chain.scene.elastic
        }
        return self.chain.folded(replace(motion, links={**motion.links, **first}))
