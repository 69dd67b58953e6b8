"""Facts of a run of elastic links beside its errors; the theory of beams is not loaded for them."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import ClassVar

from reports.compare.errors import Errors, LinkFacts, MotionFacts
from reports.quantities import named
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
