"""The task of moving a slider to and fro by a stroke."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, model_validator

from models.files.schema import NonNegative, Positive
from models.lectures.tasks.task import TaskTable

TimeRatio = Annotated[float, Field(strict=True, allow_inf_nan=False, gt=1.0, lt=1000.0)]
"""Time of the slow stroke over that of the quick one."""


class StrokeTask(TaskTable):
    """A slider-crank of a stroke: ``central`` (of 2 cranks), ``isosceles`` (rod as long as the
    crank, 4 cranks), or ``offset`` by a length, or by its time ratio.

    ``rod_m`` is the rod; silent, several are tried.
    """

    stroke_m: Positive
    form: Literal["central", "isosceles", "offset"] = "central"
    rod_m: Positive | None = None
    offset_m: NonNegative | None = None
    time_ratio: TimeRatio | None = None

    @model_validator(mode="after")
    def _goes_together(self) -> StrokeTask:
        offset = self.offset_m is not None or self.time_ratio is not None
        if self.form != "offset" and offset:
            raise ValueError(f'offset_m and time_ratio belong to form = "offset", not {self.form}')
        if self.form == "offset" and not offset:
            raise ValueError("give offset_m, or time_ratio, or both: an offset slider-crank")
        if self.form == "isosceles" and self.rod_m is not None:
            raise ValueError("rod_m: of an isosceles slider-crank it is a quarter of the stroke")
        if self.rod_m is not None and self.offset_m is not None and self.time_ratio is not None:
            raise ValueError("rod_m, offset_m, time_ratio: the third follows from two; leave one")
        return self
