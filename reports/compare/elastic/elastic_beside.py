"""A run of segmented links, beside the beam and beside the exact chain."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

from models.errors import ReachError
from models.motion import Motion
from reports.compare.beside import Beside

if TYPE_CHECKING:
    from reports.compare.elastic.elastic_truth import ElasticTruth


@dataclass(frozen=True)
class ElasticBeside(Beside):
    """As `Beside`. Where links bend the angle of the driver says nothing of the others: there are
    no errors at the logged angle."""

    elastic: ElasticTruth = field(kw_only=True)

    @cached_property
    def exact(self) -> Motion | None:
        """The exact chain at the logged instants, None where it takes too long to be found."""
        return self.elastic.exact_at(self.motion.time_s) if self.elastic.is_exact else None

    @property
    def has_crank(self) -> bool:
        return False

    @cached_property
    def at_crank(self) -> Motion:
        raise ReachError("where links bend the driver's angle does not say where the others are")
