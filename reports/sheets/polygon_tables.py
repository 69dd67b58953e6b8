"""The vectors of a polygon sheet on the terminal, in the order of drawing."""

from __future__ import annotations

import math

from rich.console import Console

from analytic.drawings.polygon import UNITS
from models.scene import GROUND
from reports.output.columns import plain_table
from reports.output.numbers import readable
from reports.sheets.polygon_sheet import PolygonSheet


def show_polygons(console: Console, sheet: PolygonSheet) -> None:
    """Print both polygons, step by step, and how fast the links turn."""
    placement = sheet.drawn.placement
    scene, driver = placement.scene, placement.driver
    heading = (
        f"{scene.name}: {scene.driver.link} at {math.degrees(driver.theta):g} deg, "
        f"{driver.omega:g} rad/s"
    )
    console.print(heading, highlight=False, markup=False)
    for drawn in (sheet.velocity, sheet.acceleration):
        quantity, unit = drawn.polygon.quantity, UNITS[drawn.polygon.quantity]
        console.print(
            f"\n{quantity} polygon, {readable(drawn.scale)} {unit} to the mm",
            highlight=False, markup=False,
        )  # fmt: skip
        table = plain_table(gap=2)
        for head in ("vector", unit, "mm", "towards deg", "found"):
            table.add_column(head, justify="left" if head in ("vector", "found") else "right")
        for step in drawn.polygon.steps:
            for vector in step.vectors:
                x, y = vector.value
                angle = f"{math.degrees(math.atan2(y, x)):.3f}" if vector.size else "-"
                table.add_row(
                    vector.name, f"{vector.size:.7g}", f"{vector.size / drawn.scale:.2f}", angle,
                    f"by crossing, {vector.direction}" if vector.direction else "known",
                )  # fmt: skip
        console.print(table)
    rates = plain_table(gap=2)
    for head in ("link", "omega rad/s", "alpha rad/s^2"):
        rates.add_column(head, justify="left" if head == "link" else "right")
    for name, body in sheet.drawn.rates.items():
        if name != GROUND and name in scene.links:
            rates.add_row(name, f"{body.omega:.7g}", f"{body.alpha:.7g}")
    console.print("", rates, sep="\n")
    for told in sheet.drawn.undetermined:
        console.print(f"not drawn: {told}", highlight=False, markup=False)
