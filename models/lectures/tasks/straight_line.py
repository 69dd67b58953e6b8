"""The task of leading a point along a straight line, nearly."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, model_validator

from models.files.schema import Coordinates, Degrees, Positive
from models.lectures.tasks.task import TaskTable


class StraightLineTable(TaskTable):
    """A straight part of ``length_m`` from ``start_m`` on, in a direction.

    ``deviation`` is the largest distance from the line, over the length; of Hoeken's ``turn_deg``,
    the turn of the crank over the straight part, says it as well, and ``even`` whether the line or
    the speed is to be best. Peaucellier's eight bars lead a point exactly.
    """

    linkage: Literal["hoeken", "chebyshev", "watt", "roberts", "evans", "peaucellier"]
    length_m: Positive
    deviation: Annotated[float, Field(strict=True, gt=0.0, lt=1.0)] | None = None
    turn_deg: Annotated[float, Field(strict=True, gt=0.0, lt=360.0)] | None = None
    even: Literal["line", "speed"] | None = None
    start_m: Coordinates = (0.0, 0.0)
    direction_deg: Degrees = 0.0

    @model_validator(mode="after")
    def _fits_the_linkage(self) -> StraightLineTable:
        for key in ("turn_deg", "even"):
            if self.linkage != "hoeken" and getattr(self, key) is not None:
                raise ValueError(f"{key}: belongs to hoeken; a {self.linkage} linkage has none")
        if self.linkage == "peaucellier" and self.deviation is not None:
            raise ValueError("deviation: a peaucellier linkage has none, leave it out")
        if self.turn_deg is not None and self.deviation is not None:
            raise ValueError("deviation and turn_deg: the one follows from the other; give one")
        return self
