"""The task of leading a point along a path."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field, StrictInt, model_validator

from models.files.schema import Coordinates, Degrees
from models.lectures.tasks.task import TaskTable

LEAST_POINTS, MOST_POINTS = 4, 50


class PathTable(TaskTable):
    """``points_m`` in their order; with ``crank_deg``, timing: the crank's angles in them, of which
    only the differences count. A ``closed`` path comes back to its first point, listed once.

    ``starts`` is from how many places least squares begins, ``seed`` that of the draw among them;
    ``time_s`` ends the search after so long. Mechanisms below ``least_transmission_deg`` are not
    taken.
    """

    points_m: Annotated[list[Coordinates], Field(min_length=LEAST_POINTS, max_length=MOST_POINTS)]
    crank_deg: list[Degrees] | None = None
    closed: bool = False
    starts: Annotated[StrictInt, Field(ge=1, le=1000)] = 48
    seed: Annotated[StrictInt, Field(ge=0, le=2**32 - 1)] = 0
    time_s: Annotated[float, Field(strict=True, gt=0.0, le=3600.0)] = 120.0

    @model_validator(mode="after")
    def _has_an_angle_for_each_point(self) -> PathTable:
        if self.crank_deg is not None and len(self.crank_deg) != len(self.points_m):
            raise ValueError(
                f"crank_deg: found {len(self.crank_deg)} angles for {len(self.points_m)} points; "
                "give one for each, or none"
            )
        return self
