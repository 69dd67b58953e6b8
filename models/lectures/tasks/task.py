"""What the files of all tasks have, and what they wish of a solution."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field, StringConstraints, model_validator

from models.files.schema import Coordinates, Name, Positive, Table, Text
from models.lectures.draft import SPEED_RAD_S

MOST_LOADS = 20
Source = Annotated[Text, StringConstraints(min_length=1)]


class Region(Table):
    """A rectangle of the ground that fixed pivots are wanted in [m]."""

    from_m: Coordinates
    to_m: Coordinates

    @model_validator(mode="after")
    def _is_no_line(self) -> Region:
        if self.from_m[0] >= self.to_m[0] or self.from_m[1] >= self.to_m[1]:
            raise ValueError(
                f"from_m is {list(self.from_m)}, to_m {list(self.to_m)}: give the lower left and "
                "the upper right corner"
            )
        return self

    def holds(self, place: complex) -> bool:
        """Whether a place is in it."""
        return (
            self.from_m[0] <= place.real <= self.to_m[0]
            and self.from_m[1] <= place.imag <= self.to_m[1]
        )


class TaskTable(Table):
    """What every task has: its name, where it is from, and what its solutions are wanted to be.

    ``speed_rad_s`` is that of the driver, or the circular frequency of one that swings; ``loads``
    are those of the scenes, on links by the names that solutions have.
    """

    name: Name
    source: Source
    note: Text = ""
    tolerance_m: Positive | None = None
    tolerance_deg: Positive | None = None
    pivots_in: Region | None = None
    least_transmission_deg: Annotated[float, Field(strict=True, ge=0.0, le=60.0)] | None = None
    speed_rad_s: Positive = SPEED_RAD_S
    loads: dict[Name, dict[str, object]] = Field(default_factory=dict, max_length=MOST_LOADS)
