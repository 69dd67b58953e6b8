"""What is known of a run of elastic links beside its errors."""

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
    """``segments`` were given for each link, with springs of a kind, or as many elements where that
    is "beam"; ``ratio`` is their lowest frequency over the driver's speed, and ``cycles`` how often
    they swing at it over the run, 0 where the motion is periodic. ``slender`` is the longest link
    over the largest deflection.

    ``straight`` says that they start so, and ring with all that they have; ``pushed`` is the
    acceleration that elements start off by, over the square of the driver's speed.

    As shares of the largest deflection: ``doubt`` is what the beam may be off by, and ``linear``
    what the linear theory, without foreshortening, is off it by. ``apart`` is how far the exact
    chain is from the beam, as a pure number by quantity, of what is let go with what the beam may
    be off by; of a driven motion that is not periodic it is ``estimated`` from the chain of a few
    segments, and of elements from what they lock by.
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
        """Those of elastic links, None of rigid ones."""
        facts = errors.of_links if errors else None
        return facts if isinstance(facts, ElasticFacts) else None

    @property
    def of_beam(self) -> bool:
        """Whether they are elements of a beam."""
        return self.springs == "beam"

    @property
    def pieces(self) -> str:
        """How many there are of what, in words."""
        return f"{self.segments} {'elements' if self.of_beam else 'segments'}"

    @property
    def chain(self) -> float:
        """What so many segments leave of the deflection, as a share of the largest."""
        return self.apart.get("deflection", 0.0)

    @property
    def locked(self) -> float:
        return 2.0 * self.chain if self.of_beam else 0.0

    def beyond(self, name: str) -> float:
        """Model error of the segments (or beam elements), and of the beam theory."""
        if name == "segments":
            return 0.0
        own = self.apart.get(name.removesuffix("-differenced"), 0.0)
        own *= 2.0 if self.estimated else 1.0
        return own + (self.doubt if name == "deflection" else 0.0)

    def deflecting(self, budget: float, step: float) -> float:
        return budget * (1.0 if self.of_beam else self.slender) + self._swung(step)

    def _swung(self, step: float) -> float:
        """What the swings of springs are off by, of which a step makes (r step)^2/24 of the phase.

        What starts straight rings as under an even load: k half-waves, k odd, with 1/k^5 of the
        deflection, k^2 times as fast, and so with k^6 of the phase, up to their whole swing. Of
        that the sum falls as the step to the power 4/3.
        """
        phase = (self.ratio * step) ** 2 * (1.0 + math.tau * self.cycles) / 12.0
        if not self.straight:
            return phase
        return sum(min(2.0, k**6 * phase) / k**5 for k in range(1, self.segments, 2))

    def compared_with(self, motion: MotionFacts, moved: str) -> str:
        parts = [BENT + ", segments against the exact chain of as many" * (not self.of_beam)]
        parts += [*motion.over_g, "D largest deflection, L longest link, w driver's peak speed."]
        return "; ".join(parts)
