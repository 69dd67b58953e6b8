"""Tasks of curves: a function, a path, a straight line."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, StrictInt, StringConstraints, model_validator

from models.files.schema import Coordinates, Degrees, Number, Positive
from models.lectures.formula import LONGEST_TEXT
from models.lectures.shipped_tables import TaskTable

MOST_ROWS = 10_000
Rows = Annotated[list[Number], Field(min_length=2, max_length=MOST_ROWS)]
Formula = Annotated[str, StringConstraints(min_length=1, max_length=LONGEST_TEXT)]


class FunctionTable(TaskTable):
    """A function as ``formula`` of x, or as a table of ``x`` and ``y``, over ``range_of_x``.

    While x runs through its range the input turns by ``input_range_deg``, and the output runs
    through ``output_range_deg`` (four-bar) or ``output_range_m`` (slider-crank) as y runs through
    its own; negative ranges go clockwise, or back. ``points`` is the number of precision points in
    Chebyshev's spacing, or their x. Missing starts are found by four and five points, and tried on
    a grid otherwise.
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


class PathTable(TaskTable):
    """A path: ``points_m`` in their order; with ``crank_deg``, timing: the crank's angles in them,
    of which only the differences count. A ``closed`` path returns to its first point, listed once.

    ``starts`` is the number of starts of least squares, ``seed`` the seed of their draw; ``time_s``
    limits the search. Mechanisms below ``least_transmission_deg`` are not taken.
    """

    points_m: Annotated[list[Coordinates], Field(min_length=4, max_length=50)]
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


class StraightLineTable(TaskTable):
    """A straight part of ``length_m`` from ``start_m`` on, in a direction.

    ``deviation`` is the largest distance from the line, over the length; Hoeken's linkage takes
    instead ``turn_deg``, the turn of the crank over the straight part, and ``even`` is line or
    speed, whichever is to be best. Peaucellier's eight bars guide a point exactly.
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
