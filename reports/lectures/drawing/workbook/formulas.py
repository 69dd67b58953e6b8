"""Tables of formulas over inputs, and those of textbooks: four-bar, slider-crank, slotted lever.

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

from analytic.mechanism.fourbar import FourBar
from analytic.structure.groups import Group
from models.array import Array
from models.errors import CrankcheckError
from models.scene import Point, Scene, Slider, span
from models.scene.joints import less, turned
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
    formula = f"IF(ISNUMBER([{name}-1]),{on},[{within}])"  # starts again after a gap
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


FOUR_BAR_COLUMNS = (
    *DRIVE_COLUMNS,
    Column("Bx", "B x m", "{AB}*COS([phi])"),
    Column("By", "B y m", "{AB}*SIN([phi])"),
    Column("Dx", "D x m", "{AD}*COS(RADIANS({AD_deg}))"),
    Column("Dy", "D y m", "{AD}*SIN(RADIANS({AD_deg}))"),
    Column("BD", "BD m", "SQRT(([Dx]-[Bx])^2+([Dy]-[By])^2)"),
    Column("cosine", "cos CBD", "({BC}^2+[BD]^2-{CD}^2)/(2*{BC}*[BD])"),
    Column("inside", "sin^2 CBD", "1-[cosine]^2"),
    state_column("inside"),
    Column("inner", "angle CBD rad", "ACOS(IF([inside]<0,NA(),[cosine]))"),
    Column("psi", "of BC rad", "ATAN2([Dx]-[Bx],[Dy]-[By])+{branch}*[inner]"),
    Column("Cx", "C x m", "[Bx]+{BC}*COS([psi])"),
    Column("Cy", "C y m", "[By]+{BC}*SIN([psi])"),
    Column("chi", "of DC rad", "ATAN2([Cx]-[Dx],[Cy]-[Dy])"),
    continued("theta_bc", "theta of BC rad", "psi"),
    continued("theta_dc", "theta of DC rad", "chi"),
    Column("sine", "sin(BC - DC)", "SIN([psi]-[chi])"),
    Column("omega_bc", "omega of BC rad/s", "-{omega}*{AB}*SIN([phi]-[chi])/({BC}*[sine])"),
    Column("omega_dc", "omega of DC rad/s", "-{omega}*{AB}*SIN([phi]-[psi])/({CD}*[sine])"),
    Column(
        "alpha_bc",
        "alpha of BC rad/s^2",
        "({CD}*[omega_dc]^2-{AB}*{omega}^2*COS([phi]-[chi])-{BC}*[omega_bc]^2*COS([psi]-[chi]))"
        "/({BC}*[sine])",
    ),
    Column(
        "alpha_dc",
        "alpha of DC rad/s^2",
        "({CD}*[omega_dc]^2*COS([psi]-[chi])-{AB}*{omega}^2*COS([phi]-[psi])-{BC}*[omega_bc]^2)"
        "/({CD}*[sine])",
    ),
)
FOUR_BAR_CHARTS = {
    "position: angles [rad]": ("theta_bc", "theta_dc"),
    "velocity: omega [rad/s]": ("omega_bc", "omega_dc"),
    "acceleration: alpha [rad/s^2]": ("alpha_bc", "alpha_dc"),
}


def four_bar_table(scene: Scene, group: Group, count: int, step_deg: float) -> FormulaTable:
    """The table of a four-bar at constant speed, whose one group is ``group``."""
    bar = FourBar.of(scene)
    pins = group.outer1, group.outer2
    pivot, far = scene.driver_pivot, next(pin for pin in pins if pin in scene.ground)
    near = next(pin for pin in pins if pin != far)
    x, y = less(scene.ground[far], scene.ground[pivot])
    left = scene.branch.get(group.branch_key, 1) * (1 if pins[0] == near else -1)
    crank = scene.driver.link
    coupler, rocker = (
        (group.first, group.second) if pins[0] == near else (group.second, group.first)
    )
    inputs = (
        Input("AB", bar.driver, "m", "length of the driver", "above 0", crank),
        Input("BC", bar.coupler, "m", "length of the coupler", "above 0", coupler),
        Input("CD", bar.rocker, "m", "length of the rocker", "above 0", rocker),
        Input("AD", bar.ground, "m", "distance of the pins on the ground", "above 0"),
        Input("AD_deg", math.degrees(math.atan2(y, x)), "deg", "direction of AD"),
        Input("branch", left, "", "1: C to the left of the way from B to D; -1: right", "1 or -1"),
        *drive_inputs(scene, near, step_deg),
    )
    return FormulaTable(inputs, FOUR_BAR_COLUMNS, count, FOUR_BAR_CHARTS)


E_TOLD = "the way of the rod's pin on the slider passes the crank's pivot so far on its left"
SLIDER_CRANK_COLUMNS = (
    *DRIVE_COLUMNS,
    Column("t", "t rad", "[phi]-RADIANS({line_deg})"),
    Column("aside", "R sin t - e m", "{R}*SIN([t])-{e}"),
    Column("inside", "cos^2 f", "1-([aside]/{L})^2"),
    state_column("inside"),
    Column("cosine", "cos f", "{branch}*SQRT(IF([inside]<0,NA(),[inside]))"),
    Column("f", "f rad", "ATAN2([cosine],[aside]/{L})"),
    Column("f_rate", "f' rad/s", "{omega}*{R}*COS([t])/({L}*[cosine])"),
    Column("f_gain", "f'' rad/s^2", "([f_rate]^2*[aside]-{omega}^2*{R}*SIN([t]))/({L}*[cosine])"),
    Column("X", "X m", "{R}*COS([t])+{L}*[cosine]"),
    Column("X_rate", "X' m/s", "-{omega}*{R}*SIN([t])-[f_rate]*[aside]"),
    Column(
        "X_gain",
        "X'' m/s^2",
        "-({omega}^2)*{R}*COS([t])-[f_gain]*[aside]-[f_rate]*{omega}*{R}*COS([t])",
    ),
    Column("s", "displacement m", "[X]-{X0}"),
    Column("omega_rod", "omega of the rod rad/s", "-[f_rate]"),
    Column("alpha_rod", "alpha of the rod rad/s^2", "-[f_gain]"),
)
SLIDER_CRANK_CHARTS = {
    "position X [m]": ("X",),
    "velocity X' [m/s]": ("X_rate",),
    "acceleration X'' [m/s^2]": ("X_gain",),
}


def slider_crank_table(scene: Scene, group: Group, count: int, step_deg: float) -> FormulaTable:
    """The table of a slider-crank at constant speed, whose one group is ``group``."""
    slider, pivot = scene.sliders[group.outer2], scene.ground[scene.driver_pivot]
    crank, rod = scene.links[scene.driver.link], scene.links[group.first]
    ends = group.outer1, group.inner
    line = turned(less(slider.through_m, pivot), -slider.direction_rad)
    ahead, aside = _pin_in(scene, slider, group.inner)
    x0, e = line[0] + ahead, line[1] + aside
    radius = span({pin: crank.points[pin] for pin in (scene.driver_pivot, group.outer1)})
    length = span({pin: rod.points[pin] for pin in ends})
    branch = scene.branch.get(group.branch_key, 1)
    inputs = (
        Input("R", radius, "m", "length of the crank", "above 0", crank.name),
        Input("L", length, "m", "length of the rod", "above 0", rod.name),
        Input("e", e, "m", E_TOLD),
        Input("line_deg", math.degrees(slider.direction_rad), "deg", "direction of the line"),
        Input("X0", x0, "m", "X from which the displacement counts"),
        Input("branch", branch, "", "1: the rod points along the line; -1: against it", "1 or -1"),
        *drive_inputs(scene, group.outer1, step_deg),
    )
    return FormulaTable(inputs, SLIDER_CRANK_COLUMNS, count, SLIDER_CRANK_CHARTS)


def _pin_in(scene: Scene, slider: Slider, pin: str) -> Point:
    """The place of a pin of the sliding link from the slider's point [m]: along the line, and
    left."""
    if slider.link is None:
        return 0.0, 0.0
    points = scene.links[slider.link].points
    return turned(less(points[pin], points[slider.point]), slider.angle_rad)


SLOTTED_LEVER_COLUMNS = (
    *DRIVE_COLUMNS,
    Column("x", "C to B, x m", "{R}*COS([phi])-{ACx}"),
    Column("y", "C to B, y m", "{R}*SIN([phi])-{ACy}"),
    Column("inside", "(rho/R)^2", "([x]^2+[y]^2-{o}^2)/{R}^2"),
    state_column("inside"),
    Column("rho", "rho m", "{branch}*{R}*SQRT(IF([inside]<0,NA(),[inside]))"),
    Column("line", "of the line rad", "ATAN2([x],[y])-ATAN2([rho],{o})"),
    continued("theta", "theta of the line rad", "line"),
    Column("turn", "phi - theta rad", "[phi]-[line]"),
    Column("omega3", "lever omega rad/s", "{omega}*{R}*COS([turn])/[rho]"),
    Column("slide", "rho' m/s", "-{omega}*{R}*SIN([turn])+[omega3]*{o}"),
    Column("coriolis", "2 omega rho' m/s^2", "2*[omega3]*[slide]"),
    Column(
        "alpha3",
        "lever alpha rad/s^2",
        "(-({omega}^2)*{R}*SIN([turn])-[coriolis]+[omega3]^2*{o})/[rho]",
    ),
    Column("gain", "rho'' m/s^2", "-({omega}^2)*{R}*COS([turn])+[alpha3]*{o}+[omega3]^2*[rho]"),
    Column("s", "displacement m", "[rho]-{rho0}"),
)
SLOTTED_LEVER_CHARTS = {
    "position: theta [rad]": ("theta",),
    "velocity: omega [rad/s]": ("omega3",),
    "acceleration: alpha [rad/s^2]": ("alpha3",),
}


def slotted_lever_table(scene: Scene, group: Group, count: int, step_deg: float) -> FormulaTable:
    """The table of a slotted lever at constant speed, whose one group is ``group``."""
    slider = scene.sliders[group.inner]
    lever, crank = scene.links[slider.on], scene.links[scene.driver.link]
    pivot = next(pin for pin in (group.outer1, group.outer2) if pin in lever.points)
    x, y = less(scene.ground[pivot], scene.ground[scene.driver_pivot])
    rho0, o = turned(less(slider.through_m, lever.points[pivot]), -slider.direction_rad)
    radius = span({pin: crank.points[pin] for pin in (scene.driver_pivot, slider.point)})
    branch = scene.branch.get(group.branch_key, 1)
    inputs = (
        Input("R", radius, "m", "length of the crank", "above 0", crank.name),
        Input("ACx", x, "m", "from the crank's pivot to the lever's, along x"),
        Input("ACy", y, "m", "and along y"),
        Input("o", o, "m", "the line is so far to the left of the lever's pivot"),
        Input("rho0", rho0, "m", "rho from which the displacement counts"),
        Input("branch", branch, "", "1: B along the line from C; -1: against it", "1 or -1"),
        *drive_inputs(scene, slider.point, step_deg),
    )
    return FormulaTable(inputs, SLOTTED_LEVER_COLUMNS, count, SLOTTED_LEVER_CHARTS)
