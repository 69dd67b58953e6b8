"""The task of swinging a rocker to and fro between two positions."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field, model_validator

from models.files.schema import Positive
from models.lectures.tasks.positions import PoseTable, PositionsTask
from models.lectures.tasks.task import TaskTable

Swing = Annotated[float, Field(strict=True, gt=0.0, lt=180.0)]


class RockerTask(TaskTable):
    """A crank is to swing a rocker, by its angle or between two positions of a body on it.

    ``rocker_m`` is the distance of its pin B from its pivot O4 (of positions silent: as far as the
    body's first point); ``distance_m`` that of the crank's pivot O2 from the middle of the chord
    B1 B2, on whose extension it lies: silent, several are tried.
    """

    swing_deg: Swing | None = None
    positions: list[PoseTable] = Field(default_factory=list, max_length=2)
    rocker_m: Positive | None = None
    distance_m: Positive | None = None

    @model_validator(mode="after")
    def _is_by_angle_or_by_positions(self) -> RockerTask:
        if (self.swing_deg is None) == (not self.positions):
            raise ValueError("give swing_deg, or two positions, one of the two")
        if self.positions and len(self.positions) != 2:
            raise ValueError("positions: found 1; a rocker swings between two")
        if self.swing_deg is not None and self.rocker_m is None:
            raise ValueError("rocker_m: missing; a rocker by its angle needs its length")
        if self.positions:
            _ = self.body
        return self

    @property
    def body(self) -> PositionsTask:
        """The body in its two positions. Raises ValidationError for positions of no rigid body."""
        return PositionsTask(name=self.name, source=self.source, positions=self.positions)
