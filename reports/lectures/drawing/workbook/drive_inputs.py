"""What all tables of formulas begin with: the crank at constant speed, and its step."""

from __future__ import annotations

import math

from models.errors import CrankcheckError
from models.joints import less
from models.laws import ConstantSpeed
from models.scene import Scene
from reports.lectures.drawing.workbook.formula_table import Column, Input

STEP_TOLD = "angle of the crank between two rows; with over 30 turns may be lost"
DRIVE_COLUMNS = (
    Column("n", "n", "[n-1]+1", first="0"),
    Column("time", "time s", "[n]*RADIANS({step_deg})/ABS({omega})"),
    Column("phi", "phi rad", "RADIANS({start_deg})+{omega}*[time]"),
)


def drive_inputs(scene: Scene, pin: str, step_deg: float) -> tuple[Input, ...]:
    """Speed, start and step, the crank being the line from its pivot to ``pin``.

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
    """The angle of a column ``within`` a turn, going on continuously from row to row."""
    step = f"([{within}]-[{name}-1])"
    on = f"[{within}]-2*PI()*ROUND({step}/(2*PI()),0)"
    formula = f"IF(ISNUMBER([{name}-1]),{on},[{within}])"  # begins anew after a gap
    return Column(name, head, formula, first=f"[{within}]")
