"""The task of generating a function: the output is to follow it as the input turns evenly."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, StringConstraints, model_validator

from models.files.schema import Degrees, Number, Positive
from models.lectures.formula import LONGEST_TEXT
from models.lectures.tasks.task import TaskTable

MOST_ROWS = 10_000
Rows = Annotated[list[Number], Field(min_length=2, max_length=MOST_ROWS)]
Formula = Annotated[str, StringConstraints(min_length=1, max_length=LONGEST_TEXT)]


class FunctionTable(TaskTable):
    """``formula`` of x, or a table of ``x`` and ``y``, over ``range_of_x``.

    While x goes through its range the input turns by ``input_range_deg``, and the output goes
    through ``output_range_deg`` (of a four-bar) or ``output_range_m`` (of a slider-crank) as y goes
    through its own; negative ranges go clockwise, or back. ``points`` is the number of precision
    points in Chebyshev's spacing, or their x. Starts that are silent are found by four and five
    points, and tried on a grid otherwise.
    """

    formula: Formula | None = None
    x: Rows | None = None
    y: Rows | None = None
    range_of_x: tuple[Number, Number]
    mechanism: Literal["fourbar", "slider-crank"] = "fourbar"
    points: Literal[3, 4, 5] | Annotated[list[Number], Field(min_length=3, max_length=5)] = 3
    input_range_deg: Degrees
    input_start_deg: Degrees | None = None
    output_range_deg: Degrees | None = None
    output_start_deg: Degrees | None = None
    output_range_m: Number | None = None
    output_start_m: Number | None = None
    ground_m: Positive = 0.1
    equal_ripple: bool = False

    @model_validator(mode="after")
    def _is_one_function(self) -> FunctionTable:
        table = self.x is not None or self.y is not None
        if (self.formula is None) != table:
            raise ValueError("give formula, or x and y of a table, one of the two")
        if table and (self.x is None or self.y is None or len(self.x) != len(self.y)):
            raise ValueError(
                f"x and y: found {len(self.x or [])} and {len(self.y or [])} rows; give as many"
            )
        return self

    @model_validator(mode="after")
    def _has_the_units_of_its_output(self) -> FunctionTable:
        own, other = ("deg", "m") if self.mechanism == "fourbar" else ("m", "deg")
        if getattr(self, f"output_range_{own}") is None:
            raise ValueError(
                f"output_range_{own}: missing; a {self.mechanism} has its output in it"
            )
        for key in (f"output_range_{other}", f"output_start_{other}"):
            if getattr(self, key) is not None:
                raise ValueError(f"{key}: the output of a {self.mechanism} is in {own}")
        return self
