"""A run of segmented links that was let go, beside the beam and beside the exact chain."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from reports.compare.elastic.elastic_truth import ElasticBeside
from reports.compare.free.free_beside import FreeBeside


@dataclass(frozen=True)
class ReleasedElasticBeside(ElasticBeside, FreeBeside):
    """As `FreeBeside`, without a geometry at the driver's own angle."""

    compared_by: ClassVar[tuple[str, ...]] = (
        *FreeBeside.compared_by,
        ".elastic.elastic_errors",
    )

    @property
    def no_geometry(self) -> str:
        return "no geometry: where links bend the driver's angle does not say where the others are"

    @property
    def tells_momentum(self) -> bool:
        return False
