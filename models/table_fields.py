"""The kinds of keys and of tables that scene files are made of: names, texts, numbers."""

from __future__ import annotations

from typing import Annotated

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, StringConstraints

from models.released import LONGEST_S

NAME = r"[A-Za-z][A-Za-z0-9_-]{0,39}"
"""What a name is: nothing in it leaves a path, a tag or a cell."""
Name = Annotated[str, StringConstraints(pattern=rf"^{NAME}$")]
ACTING = r"\x00-\x08\x0b-\x1f\x7f-\x9f\u2028-\u202e\u2066-\u206f\ufffe\uffff"
"""Characters that act instead of being seen: a terminal obeys them, or they break lines or turn the
order of letters round; the last two XML can not hold."""
Text = Annotated[str, StringConstraints(max_length=2000, pattern=rf"^[^{ACTING}]*$")]
"""Text that is shown and written into other files."""
LARGEST = 1e15
"""No number of a scene is larger, and no length or mass smaller than its inverse: squares of
them, and products with rates, stay numbers."""
Number = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=-LARGEST, le=LARGEST)]
Duration = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=1 / LARGEST, le=LONGEST_S)]
"""Of free motion [s]."""
Degrees = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=-1e6, le=1e6)]
Positive = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=1 / LARGEST, le=LARGEST)]
NonNegative = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=0, le=LARGEST)]
Coordinates = tuple[Number, Number]
MOST_BODIES, MOST_POINTS = 1000, 100
"""Links of a scene (sliders, and points of the ground, too), and points of a link: the distances
between all points of a link are looked at many times."""


def not_tiny(value: float) -> float:
    """Refuse a number so near to 0 that its inverse, a period, is no number to work with."""
    if 0.0 < abs(value) < 1 / LARGEST:
        raise ValueError(
            f"found {value:g}; use {1 / LARGEST:g} or more, or {-1 / LARGEST:g} or less"
        )
    return value


RateNumber = Annotated[Number, AfterValidator(not_tiny)]


class Table(BaseModel):
    """A table of the file: unknown keys are faults, nothing is changed after reading."""

    # Built where a scene has such a table: most have few of them, and each takes a millisecond.
    model_config = ConfigDict(extra="forbid", frozen=True, defer_build=True)
