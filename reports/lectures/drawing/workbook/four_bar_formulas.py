"""The four-bar as formulas of a sheet, as textbooks write them.

::

            C
      BC  /  \\  CD         C is where two circles about B and D cross; rates by the loop
        B     \\            AB + BC = AD + DC, differentiated once and twice, along BC and DC
    AB /       \\
      A ------- D
"""

from __future__ import annotations

import math

from analytic.mechanism.fourbar import FourBar
from analytic.structure.groups import Group
from models.scene import Scene
from models.scene.joints import less
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
CHARTS = {
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
    return FormulaTable(inputs, COLUMNS, count, CHARTS)
