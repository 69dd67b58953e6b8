"""The errors of elastic links: against the beam, against the exact chain, and of that itself."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from typing import ClassVar

import numpy as np

from models.motion import Motion
from reports.compare.beside import Beside
from reports.compare.elastic_truth import ElasticBeside
from reports.compare.error_rows import instants_of, whole_row
from reports.compare.errors import Error, Errors, LinkFacts, MotionFacts
from reports.compare.tracks import length
from reports.quantities import QUANTITIES, named
from reports.quantities.limits import BENDING
from reports.quantities.quantity import Tolerance

BENT = (
    "Elastic links: largest errors against the solved motion of the beam with foreshortening at "
    "the same time"
)


@dataclass(frozen=True, kw_only=True)
class ElasticFacts(LinkFacts):
    """Facts of elastic links: ``segments`` of each link, with a kind of ``springs``, or elements
    where that is "beam"; ``ratio`` is their lowest frequency over the driver's speed, and
    ``cycles`` the number of its swings over the run, 0 where the motion is periodic. ``slender`` is
    the longest link over the largest deflection.

    ``straight`` links start so, and ring with all their deflection; ``pushed`` is the error of the
    elements' acceleration at the start, over the square of the driver's speed.

    As shares of the largest deflection: ``doubt`` is the uncertainty of the beam, and ``linear``
    the error of the linear theory, without foreshortening. ``apart`` is the distance of the exact
    chain from the beam, as a pure number by quantity, for free motion with the uncertainty of the
    beam; for a driven motion that is not periodic it is ``estimated`` from a chain of a few
    segments, and for elements from their locking.
    """

    limits: ClassVar[Mapping[str, Tolerance]] = BENDING
    shut: ClassVar[Sequence[str]] = named("closure")
    followed: ClassVar[Sequence[Sequence[str]]] = (("segments",), ("deflection",))
    springs: str
    ratio: float
    cycles: float
    doubt: float
    linear: float
    apart: Mapping[str, float] = field(default_factory=dict)
    estimated: bool = False
    straight: bool = False

    @staticmethod
    def of(errors: Errors | None) -> ElasticFacts | None:
        """Return the facts of elastic links, None for rigid ones."""
        facts = errors.of_links if errors else None
        return facts if isinstance(facts, ElasticFacts) else None

    @property
    def of_beam(self) -> bool:
        """True if they are elements of a beam."""
        return self.springs == "beam"

    @property
    def pieces(self) -> str:
        """The number and kind of the pieces, in words."""
        return f"{self.segments} {'elements' if self.of_beam else 'segments'}"

    @property
    def chain(self) -> float:
        """Error of the segments in the deflection, as a share of the largest."""
        return self.apart.get("deflection", 0.0)

    @property
    def locked(self) -> float:
        return 2.0 * self.chain if self.of_beam else 0.0

    def beyond(self, name: str) -> float:
        """Return the model error of the segments (or beam elements), and of the beam theory."""
        if name == "segments":
            return 0.0
        own = self.apart.get(name.removesuffix("-differenced"), 0.0)
        own *= 2.0 if self.estimated else 1.0
        return own + (self.doubt if name == "deflection" else 0.0)

    def deflecting(self, budget: float, step: float) -> float:
        return budget * (1.0 if self.of_beam else self.slender) + self._swung(step)

    def _swung(self, step: float) -> float:
        """Return the error of the swings of springs; a step makes (r step)^2/24 of the phase.

        Links that start straight ring as under an even load: k half-waves, k odd, with 1/k^5 of the
        deflection, k^2 times as fast, and so with k^6 of the phase, up to their whole swing. The
        sum of these falls as the step to the power 4/3.
        """
        phase = (self.ratio * step) ** 2 * (1.0 + math.tau * self.cycles) / 12.0
        if not self.straight:
            return phase
        return sum(min(2.0, k**6 * phase) / k**5 for k in range(1, self.segments, 2))

    def compared_with(self, motion: MotionFacts, moved: str) -> str:
        parts = [BENT + ", segments against the exact chain of as many" * (not self.of_beam)]
        parts += [*motion.over_g, "D largest deflection, L longest link, w driver's peak speed."]
        return "; ".join(parts)


BEAM, CHAIN = ("deflection", "extension"), ("segments",)
"""Quantities compared with the beam, and with the exact chain."""


def compared(beside: Beside, errors: Errors | None) -> Errors:
    """Return the errors of a run as with rigid links, and those of its elastic links."""
    assert isinstance(beside, ElasticBeside)
    assert errors is not None
    return replace(errors, rows=(*errors.rows, *places(beside)), of_links=elastic_facts(beside))


def places(beside: Beside) -> list[Error]:
    """Return deflections and extensions against the beam: of the run, of kind "total", and of the
    exact chain, of kind "chain"."""
    assert isinstance(beside, ElasticBeside)
    at = instants_of(beside, beside.motion.time_s, beside.reference)
    rows = [whole_row(track, at) for track in beside.tracks(BEAM, beside.reference)]
    exact = beside.exact
    if exact is not None:
        rows += [whole_row(track, at) for track in beside.tracks(CHAIN, exact)]
        theirs = replace(beside, run=replace(beside.run, motion=exact), motion=exact, _own={})
        chain = theirs.tracks(BEAM, beside.reference)
        rows += [whole_row(track, at, kind="chain") for track in chain]
    return rows


def elastic_facts(beside: ElasticBeside) -> ElasticFacts:
    """Return the facts beside the errors."""
    truth, theory, time_s = beside.elastic, beside.elastic.theory, beside.motion.time_s
    apart = truth.apart(partial(_apart_by_name, beside))
    for other, looked in theory.doubted:
        off = _apart_by_name(beside, other, looked)
        apart |= {name: apart[name] + size for name, size in off.items() if name not in BEAM}
    return ElasticFacts(
        segments=truth.cut.count,
        springs=truth.springs,
        ratio=theory.lowest_rad_s / beside.scene.pace_rad_s,
        cycles=theory.cycles_per_s * float(time_s[-1] - time_s[0]),
        slender=beside.scene.longest_m / theory.largest_m,
        doubt=truth.doubt,
        linear=theory.linear_m / theory.largest_m,
        apart=apart,
        estimated=not truth.is_exact,
        straight=theory.shape == "straight",
        pushed=truth.pushed,
    )


def _apart_by_name(beside: ElasticBeside, chain: Motion, beam: Motion) -> dict[str, float]:
    """Return the largest differences of all compared quantities, as pure numbers by quantity."""
    found: dict[str, float] = {}
    for name in named("free", "place", "derived", "force", "elastic"):
        for measure in QUANTITIES[name].measures:
            ours, theirs = (measure.truth(beside.scene, each) for each in (beam, chain))
            if name in CHAIN or not ours:
                continue
            scale = measure.scale(beside.scene, beam)
            for body in ours.keys() & theirs.keys():
                off = float(np.max(length(theirs[body] - ours[body]))) / scale
                found[name] = max(found.get(name, 0.0), off)
    return found
