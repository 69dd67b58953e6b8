"""What is known of a run of elastic links beside its errors."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field


@dataclass(frozen=True)
class ElasticFacts:
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

    segments: int
    springs: str
    ratio: float
    cycles: float
    slender: float
    doubt: float
    linear: float
    apart: Mapping[str, float] = field(default_factory=dict)
    estimated: bool = False
    straight: bool = False
    pushed: float = 0.0

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
