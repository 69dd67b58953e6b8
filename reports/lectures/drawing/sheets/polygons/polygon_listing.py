"""The vectors of a polygon sheet on the terminal, in the order of drawing."""

from __future__ import annotations

import math

import numpy as np
from rich.console import Console
from rich.table import Table

from analytic.lectures.drawings.drawn_polygons import QUANTITIES, link_rates
from analytic.lectures.drawings.polygon import UNITS
from models.array import Array
from models.errors import harmless
from reports.lectures.drawing.sheets.paper import of_elastic
from reports.lectures.drawing.sheets.polygons.polygon_on_paper import DrawnPolygon
from reports.lectures.drawing.sheets.polygons.polygon_sheet import PolygonSheet
from reports.lectures.drawing.sheets.polygons.polygon_table import (
    at_rest,
    doubts,
    drawn_links,
    image_words,
)
from reports.output.console import plain_table
from reports.output.numbers import readable


def show_polygons(console: Console, sheet: PolygonSheet) -> None:
    """Print both polygons, step by step, how fast the links turn, and what their images are."""
    _say(console, _heading(sheet))
    for drawn in (sheet.velocity, sheet.acceleration):
        quantity, unit = drawn.polygon.quantity, UNITS[drawn.polygon.quantity]
        _say(console, f"\n{quantity} polygon, {readable(drawn.scale)} {unit} to the mm")
        console.print(_vectors(drawn))
        if drawn.polygon.largest == 0.0:
            _say(console, at_rest(quantity))
        _show_log(console, drawn, sheet)
    _show_links(console, sheet)
    for told in doubts(sheet.drawn):
        _say(console, told)


def _say(console: Console, words: str) -> None:
    console.print(harmless(words), highlight=False, markup=False, soft_wrap=True)


def _heading(sheet: PolygonSheet) -> str:
    placement, log = sheet.drawn.placement, sheet.log
    scene, driver = placement.scene, placement.driver
    at_time = f", t = {sheet.time_s:.9g} s" if sheet.time_s is not None else ""
    at_time += f" in {log.source}{log.taken}" if log is not None else ""
    alpha = f", {driver.alpha:g} rad/s^2" if driver.alpha else ""
    rigid = of_elastic(scene, "; its elastic links are taken as rigid")
    return (
        f"{scene.name}: {scene.driver.link} at {round(math.degrees(driver.theta), 9) % 360.0:g} deg"
        f"{at_time}, {driver.omega:g} rad/s{alpha}{rigid}"
    )


def _vectors(drawn: DrawnPolygon) -> Table:
    table = plain_table(gap=2)
    for head in ("vector", UNITS[drawn.polygon.quantity], "mm", "towards deg", "found"):
        table.add_column(head, justify="left" if head in ("vector", "found") else "right")
    for vector in drawn.polygon.vectors:
        size = drawn.size_of(vector)
        table.add_row(
            vector.name, f"{size:.7g}", f"{size / drawn.scale:.2f}",
            _towards(vector.value if size else np.zeros(2)),
            f"by crossing, {vector.direction}" if vector.direction else "known",
        )  # fmt: skip
    return table


def _towards(vector: Array) -> str:
    """The angle of a vector [deg]; none of one that is 0."""
    x, y = vector
    return f"{math.degrees(math.atan2(y, x)):.3f}" if np.any(vector) else "-"


def _show_log(console: Console, drawn: DrawnPolygon, sheet: PolygonSheet) -> None:
    """The images of a log's points beside those of the reference, where there is a log."""
    if drawn.logged is None:
        return
    unit = UNITS[drawn.polygon.quantity]
    if not drawn.logged.errors:
        _say(console, f"\nno {drawn.polygon.quantity} of any point in the log")
        return
    _say(console, f"\n{drawn.logged_by}: {drawn.logged.words} on the sheet")
    table = plain_table(gap=2)
    for head in ("point", unit, "mm", f"logged {unit}", "mm", f"error {unit}", "mm", "towards deg"):
        table.add_column(head, justify="left" if head == "point" else "right")
    for name, size, own, error in drawn.logged_sizes():
        off = float(np.hypot(*error))
        table.add_row(
            name,
            f"{size:.7g}", f"{size / drawn.scale:.2f}", f"{own:.7g}", f"{own / drawn.scale:.2f}",
            readable(off * drawn.scale), readable(off), _towards(error),
        )  # fmt: skip
    console.print(table)


def _show_links(console: Console, sheet: PolygonSheet) -> None:
    rates = plain_table(gap=2)
    for head in ("link", "omega rad/s", "alpha rad/s^2"):
        rates.add_column(head, justify="left" if head == "link" else "right")
    for name in drawn_links(sheet.drawn):
        rates.add_row(name, *(f"{rate:.7g}" for rate in link_rates(sheet.drawn, name)))
    console.print("", rates, sep="\n")
    images = plain_table(gap=2)
    for head in ("image of", "in velocities", "in accelerations"):
        images.add_column(head)
    for name in drawn_links(sheet.drawn):
        words = (image_words(sheet.drawn, name, quantity) for quantity in QUANTITIES)
        images.add_row(name, *words)
    console.print("", images, sep="\n")
