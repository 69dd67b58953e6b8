"""The slider-crank as formulas of a sheet, as the paper writes them.

With t the angle of the crank from the line of the slider, R and L the lengths of crank and rod, e
by how much the way of the rod's pin on the slider passes the crank's pivot on its left, and f the
rod's angle to the line::

    sin f = (R sin t - e) / L       X = R cos t + L cos f
    X'  = -w R sin t - f' (R sin t - e)
    X'' = -w^2 R cos t - f'' (R sin t - e) - f' w R cos t

A slider that is a link may have this pin off its line, and ahead of the point that the displacement
is told of: its way is parallel to the line then. With e = 0 these are X' = -(w + f') R sin t and
X'' = -w^2 R [cos t + (f''/w^2) sin t + (f'/w) cos t]. Source: paper "Phan tich
dong hoc co cau tay quay con truot bang phan mem Excel".
"""

from __future__ import annotations

import math

from analytic.structure.groups import Group
from models.scene import Point, Scene, Slider, span
from models.scene.joints import less, turned
from reports.lectures.drawing.workbook.formula_table import (
    DRIVE_COLUMNS,
    Column,
    FormulaTable,
    Input,
    drive_inputs,
    state_column,
)

E_TOLD = "the way of the rod's pin on the slider passes the crank's pivot so far on its left"
COLUMNS = (
    *DRIVE_COLUMNS,
    Column("t", "t rad", "[phi]-RADIANS({line_deg})"),
    Column("aside", "R sin t - e m", "{R}*SIN([t])-{e}"),
    Column("inside", "cos^2 f", "1-([aside]/{L})^2"),
    state_column("inside"),
    Column("cosine", "cos f", "{branch}*SQRT(IF([inside]<0,NA(),[inside]))"),
    Column("f", "f rad", "ATAN2([cosine],[aside]/{L})"),
    Column("f_rate", "f' rad/s", "{omega}*{R}*COS([t])/({L}*[cosine])"),
    Column(
        "f_gain",
        "f'' rad/s^2",
        "([f_rate]^2*[aside]-{omega}^2*{R}*SIN([t]))/({L}*[cosine])",
    ),
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
CHARTS = {
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
    return FormulaTable(inputs, COLUMNS, count, CHARTS)


def _pin_in(scene: Scene, slider: Slider, pin: str) -> Point:
    """Where a pin of what slides is from the point of the slider [m]: along the line, and to its
    left."""
    if slider.link is None:
        return 0.0, 0.0
    points = scene.links[slider.link].points
    return turned(less(points[pin], points[slider.point]), slider.angle_rad)
