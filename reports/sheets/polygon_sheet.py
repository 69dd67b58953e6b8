"""The sheet of both vector polygons: scheme, velocities, accelerations, and their table.

::

    title
    +----------+-------------------+
    | scheme   | velocity polygon  |
    +----------+-------------------+
    | table    | acceleration      |
    +----------+-------------------+
    versions
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes

from analytic.drawings.drawn_polygons import DrawnPolygons
from analytic.drawings.paper_scale import book_scales, round_scale
from analytic.drawings.polygon import UNITS
from models.array import Array
from models.errors import CrankcheckError
from models.scene import GROUND
from reports.figures.style import QUIET, SMALL, TINY
from reports.output.numbers import readable
from reports.sheets.canvas import Canvas, text
from reports.sheets.letters import write_letters
from reports.sheets.paper import Box, Paper
from reports.sheets.polygon_drawing import DrawnPolygon, draw_polygon, fitted, frame_of
from reports.sheets.scheme import draw_scheme, point_letters
from reports.sheets.sheet_frame import draw_border, inner_box, write_head

GAP = 4.0
LEFT_SHARE, SCHEME_SHARE = 0.38, 0.5
SCHEME_PADDING = 9.0
ROW_MM = 3.1
COLUMN_MM = 52.0


@dataclass(frozen=True)
class PolygonSheet:
    """What is on the sheet: the polygons, each with its scale; the scale of lengths [m/mm], and
    what stands in the middle of the scheme [m]."""

    drawn: DrawnPolygons
    velocity: DrawnPolygon
    acceleration: DrawnPolygon
    length_scale: float
    middle: Array
    boxes: dict[str, Box]
    paper: Paper


def laid_out(drawn: DrawnPolygons, paper: Paper, k: float | None = None) -> PolygonSheet:
    """The polygons on paper, at the finest round scales that fit; with ``k`` at the book's, the
    crank's vectors k times as long as the drawn crank. Raises CrankcheckError for too small paper.
    """
    boxes = _boxes(paper)
    places = np.array(list(drawn.placement.points.values()))
    length_scale, middle = _scheme_frame(places, boxes["scheme"])
    scales: tuple[float | None, float | None] = (None, None)
    if k is not None:
        if drawn.placement.driver.alpha:
            raise CrankcheckError("--k: the book's scales are those of a crank at constant speed")
        scales = book_scales(length_scale, drawn.placement.driver.omega, k)
    velocity = fitted(drawn.velocity, boxes["velocity"], scales[0])
    acceleration = fitted(drawn.acceleration, boxes["acceleration"], scales[1])
    return PolygonSheet(drawn, velocity, acceleration, length_scale, middle, boxes, paper)


def _scheme_frame(places: Array, box: Box) -> tuple[float, Array]:
    """The scale of lengths [m/mm] for places (n, 2), and what is in the middle of the box [m]."""
    low, high = places.min(axis=0), places.max(axis=0)
    room = np.array([box.width, box.height]) - 2 * SCHEME_PADDING
    scales = [round_scale(s, r) for s, r in zip(high - low, room, strict=True) if s > 0.0]
    return max(scales), (low + high) / 2


def over_positions(drawn: Sequence[DrawnPolygons], paper: Paper) -> list[PolygonSheet]:
    """A sheet for each position, all at the same scales and with the same pole."""
    boxes = _boxes(paper)
    places = np.array([list(each.placement.points.values()) for each in drawn]).reshape(-1, 2)
    scheme = _scheme_frame(places, boxes["scheme"])
    velocity = frame_of([each.velocity for each in drawn], boxes["velocity"])
    acceleration = frame_of([each.acceleration for each in drawn], boxes["acceleration"])
    return [
        PolygonSheet(
            each,
            DrawnPolygon(each.velocity, *velocity),
            DrawnPolygon(each.acceleration, *acceleration),
            *scheme,
            boxes,
            paper,
        )
        for each in drawn
    ]


def _boxes(paper: Paper) -> dict[str, Box]:
    inner = inner_box(paper)
    left, bottom = inner.left, inner.bottom
    wide, tall = LEFT_SHARE * inner.width, SCHEME_SHARE * inner.height
    right, rest = left + wide + GAP, inner.width - wide - GAP
    half = (inner.height - GAP) / 2
    return {
        "scheme": Box(left, bottom + inner.height - tall, wide, tall),
        "table": Box(left, bottom, wide, inner.height - tall - GAP),
        "velocity": Box(right, bottom + half + GAP, rest, half),
        "acceleration": Box(right, bottom, rest, half),
    }


def draw_sheet(sheet: PolygonSheet, note: str) -> Canvas:
    """The sheet, a layer for each part and each step of drawing; ``note`` stands at its foot."""
    canvas = Canvas(sheet.paper)
    axes = canvas.layer("frame")
    _frame(axes, sheet, note)
    _scheme(canvas, sheet)
    _table(canvas.layer("table"), sheet)
    draw_polygon(canvas, sheet.velocity, sheet.boxes["velocity"])
    draw_polygon(canvas, sheet.acceleration, sheet.boxes["acceleration"])
    return canvas


def _frame(axes: Axes, sheet: PolygonSheet, note: str) -> None:
    scene, driver = sheet.drawn.placement.scene, sheet.drawn.placement.driver
    angle = math.degrees(driver.theta) % 360.0
    title = (
        f"{scene.name}: {scene.driver.link} at {angle:.6g}°, omega {readable(driver.omega)} rad/s"
        + (f", alpha {readable(driver.alpha)} rad/s²" if driver.alpha else "")
    )
    write_head(axes, sheet.paper, title, note)
    captions = {
        "scheme": f"scheme, K_l = {sheet.length_scale:g} m/mm",
        "velocity": f"velocities, K_v = {sheet.velocity.scale:g} m/s per mm",
        "acceleration": f"accelerations, K_a = {sheet.acceleration.scale:g} m/s² per mm",
        "table": "lengths on paper, and values",
    }
    for name, box in sheet.boxes.items():
        draw_border(axes, box)
        text(
            axes, box.left + 1.5, box.bottom + box.height - 3.2, captions[name], SMALL, color=QUIET
        )


def _scheme(canvas: Canvas, sheet: PolygonSheet) -> None:
    axes = canvas.layer("scheme")
    placement, box = sheet.drawn.placement, sheet.boxes["scheme"]
    places = {
        name: box.middle + (at - sheet.middle) / sheet.length_scale
        for name, at in placement.points.items()
    }
    draw_scheme(axes, placement, places)
    write_letters(canvas, axes, point_letters(placement, places), box)


def _table(axes: Axes, sheet: PolygonSheet) -> None:
    box = sheet.boxes["table"]
    rows = list(_rows(sheet))
    per_column = int((box.height - 6.0) / ROW_MM)
    for number, (name, on_paper, value) in enumerate(rows):
        column, row = divmod(number, per_column)
        x = box.left + 1.5 + column * COLUMN_MM
        y = box.bottom + box.height - 7.0 - row * ROW_MM
        text(axes, x, y, name, TINY)
        text(axes, x + 24.0, y, on_paper, TINY, ha="right")
        text(axes, x + 26.0, y, value, TINY)


def _rows(sheet: PolygonSheet) -> Sequence[tuple[str, str, str]]:
    rows = []
    for drawn in (sheet.velocity, sheet.acceleration):
        unit = UNITS[drawn.polygon.quantity]
        rows += [
            (each.name, f"{each.size / drawn.scale:.2f} mm", f"{readable(each.size)} {unit}")
            for each in drawn.polygon.vectors
        ]
    for name, body in sheet.drawn.rates.items():
        if name != GROUND and name in sheet.drawn.placement.scene.links:
            rows.append(
                (
                    f"omega, alpha of {name}",
                    "",
                    f"{readable(body.omega)} rad/s, {readable(body.alpha)} rad/s²",
                )
            )
    return rows
