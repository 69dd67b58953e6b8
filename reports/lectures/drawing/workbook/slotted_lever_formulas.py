"""The slotted lever (culisse) as formulas of a sheet.

::

        B = A + R e(phi) slides on a line of the lever, which turns about C:
       /|   B = C + rho u + o n, with u along the line, n across it, o its distance from C
      / A   v.n = omega3 rho                       v.u = rho' - omega3 o
     C      a.n = alpha3 rho + 2 omega3 rho' - omega3^2 o
            a.u = rho'' - alpha3 o - omega3^2 rho
"""

from __future__ import annotations

from analytic.structure.groups import Group
from models.scene import Scene, span
from models.scene.joints import less, turned
from reports.lectures.drawing.workbook.formula_table import (
    DRIVE_COLUMNS,
    Column,
    FormulaTable,
    Input,
    continued,
    drive_inputs,
    state_column,
)

COLUMNS = (
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
    Column(
        "gain",
        "rho'' m/s^2",
        "-({omega}^2)*{R}*COS([turn])+[alpha3]*{o}+[omega3]^2*[rho]",
    ),
    Column("s", "displacement m", "[rho]-{rho0}"),
)
CHARTS = {
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
    return FormulaTable(inputs, COLUMNS, count, CHARTS)
