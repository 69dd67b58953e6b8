"""A table of formulas over inputs: columns that are written once, for all rows of a sheet.

Spreadsheets take -a^2 for (-a)^2: a subtracted square is in brackets.

A formula is written with names: ``{AB}`` an input, ``[phi]`` the same row's value of a column,
``[phi-1]`` the value of the row before. The first row may have another formula.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from openpyxl.utils import get_column_letter  # type: ignore[import-untyped]  # ships no stubs

from models.array import Array
from models.errors import CrankcheckError
from models.scene import Scene
from models.scene.joints import less
from models.scene.laws import ConstantSpeed

NAME = re.compile(r"\{([\w]+)\}|\[([\w]+?)(-1)?\]")
STATE = "state"
"""The column that says in words whether a row's position can be assembled."""
ASSEMBLED = "assembled"
ZERO = "1E-14"
"""Value indistinguishable from 0: its root is 1e-7, and rates are that many times less certain."""
Range = Literal["any", "above 0", "not 0", "1 or -1"]


@dataclass(frozen=True)
class Input:
    """A number that may be changed: its name in formulas, its unit, its meaning, its range, and the
    link whose length it is, if any."""

    name: str
    value: float
    unit: str
    told: str
    range: Range = "any"
    link: str = ""

    def allows(self, value: float) -> bool:
        """True if the value is in its range."""
        return {
            "any": True,
            "above 0": value > 0.0,
            "not 0": value != 0.0,
            "1 or -1": abs(value) == 1.0,
        }[self.range]


@dataclass(frozen=True)
class Column:
    """A column of formulas; ``head`` is its heading, with the unit, or a formula of inputs."""

    name: str
    head: str
    formula: str
    first: str | None = None


@dataclass(frozen=True)
class FormulaTable:
    """Inputs and columns in ``count`` rows; ``charts`` are the names of the columns drawn over the
    time, by the title of their chart."""

    inputs: Sequence[Input]
    columns: Sequence[Column]
    count: int
    charts: Mapping[str, Sequence[str]]

    def with_input(self, one: Input, *, value: float) -> FormulaTable:
        """The table with another value of one of its inputs."""
        inputs = [replace(each, value=value) if each is one else each for each in self.inputs]
        return replace(self, inputs=inputs)

    def place(self, column: str) -> int:
        """The number of a column by its name, from 1."""
        return [each.name for each in self.columns].index(column) + 1

    def letter(self, column: str) -> str:
        """The letter of a column by its name."""
        return str(get_column_letter(self.place(column)))

    @property
    def states(self) -> list[str]:
        """The columns that say whether a position can be assembled: one, or one a member."""
        names = [each.name for each in self.columns]
        return [name for name in names if name == STATE or name.startswith(f"{STATE}_")]


def state_column(inside: str) -> Column:
    """The column that says whether a row can be assembled, by the sign of the column ``inside``:
    the square of the rates' divisor over its size."""
    words = f'"cannot be assembled",IF([{inside}]>{ZERO},"{ASSEMBLED}","rates not determined")'
    formula = f'IF(ISNUMBER([{inside}]),IF([{inside}]<-{ZERO},{words}),"not determined")'
    return Column(STATE, STATE, formula)


STEP_TOLD = "angle of the crank between two rows; with over 30 turns may be lost"
DRIVE_COLUMNS = (
    Column("n", "n", "[n-1]+1", first="0"),
    Column("time", "time s", "[n]*RADIANS({step_deg})/ABS({omega})"),
    Column("phi", "phi rad", "RADIANS({start_deg})+{omega}*[time]"),
)


def drive_inputs(scene: Scene, pin: str, step_deg: float) -> tuple[Input, ...]:
    """The inputs of speed, start and step; the crank is the line from its pivot to ``pin``.

    Raises CrankcheckError for a law of another kind.
    """
    law = scene.driver.law
    if not isinstance(law, ConstantSpeed):
        raise CrankcheckError(f"{scene.name}: its formulas are those of a crank at constant speed")
    points = scene.links[scene.driver.link].points
    x, y = less(points[pin], points[scene.driver_pivot])
    start = math.degrees(law.start_rad + math.atan2(y, x))
    return (
        Input("omega", law.speed_rad_s, "rad/s", "angular velocity of the crank", "not 0"),
        Input("start_deg", start, "deg", "angle of the crank at time 0"),
        Input("step_deg", step_deg, "deg", STEP_TOLD, "above 0"),
    )


def continued(name: str, head: str, within: str) -> Column:
    """The angle of a column ``within`` a turn, continuous from row to row."""
    step = f"([{within}]-[{name}-1])"
    on = f"[{within}]-2*PI()*ROUND({step}/(2*PI()),0)"
    formula = f"IF(ISNUMBER([{name}-1]),{on},[{within}])"  # begins anew after a gap
    return Column(name, head, formula, first=f"[{within}]")


FUNCTIONS = {
    "SIN": np.sin,
    "COS": np.cos,
    "ACOS": np.arccos,
    "SQRT": np.sqrt,
    "RADIANS": np.radians,
    "ABS": np.abs,
    "ATAN2": lambda x, y: np.arctan2(y, x),  # a spreadsheet has x first
    "PI": lambda: np.pi,
    "IF": np.where,
    "ISNUMBER": np.isfinite,
    "NA": lambda: np.nan,
}


def evaluated(table: FormulaTable) -> dict[str, Array]:
    """Every column by name, (rows,); NaN where a mechanism can not be assembled. Columns of words
    are arrays of text.

    Columns that build on the row before are known by ``first``: row numbers, or continuous angles.
    """
    values: dict[str, Array] = {}
    given = {each.name: each.value for each in table.inputs}
    with np.errstate(invalid="ignore", divide="ignore"):
        for column in table.columns:
            if column.first is None:
                value = _of(column.formula, values, given)  # one number where all rows have it
                values[column.name] = np.broadcast_to(value, table.count)
            elif column.first == "0":
                values[column.name] = np.arange(table.count, dtype=float)
            else:
                values[column.name] = np.unwrap(_of(column.first, values, given))
    return values


def _of(formula: str, values: Mapping[str, Array], given: Mapping[str, float]) -> Array:
    """The value of a formula without references to the row before."""
    names: dict[str, object] = {f"in_{name}": value for name, value in given.items()}
    names |= {f"at_{name}": value for name, value in values.items()}
    plain = NAME.sub(lambda m: f"in_{m[1]}" if m[1] else f"at_{m[2]}", formula).replace("^", "**")
    code = compile(re.sub(r"\s+", " ", plain), "<formula>", "eval")  # of ours alone
    return np.asarray(eval(code, {"__builtins__": {}}, names | FUNCTIONS))
