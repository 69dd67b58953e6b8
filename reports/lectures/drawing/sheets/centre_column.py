"""The column beside instant centres: their polygon, the numbers of bodies, what is which curve."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Circle as Round

from analytic.lectures.drawings.drawn_polygons import DrawnPolygons
from analytic.lectures.drawings.instant_centres import Centre, Pair
from models.scene import GROUND
from reports.figures.style import INK, SMALL, cut
from reports.lectures.drawing.sheets.canvas import line, text
from reports.lectures.drawing.sheets.paper import MM_PER_IN, Box

POLYGON_MM = 42.0
"""Height of the polygon of centres, which is at the top."""
ROW_MM, SAMPLE_MM, CURVE_ROWS = 4.0, 7.0, 7.5
"""A line of the column, the sample of a curve before its name; lines that tell poles and curves."""
INFLECTION, NO_TANGENTIAL = "#2e6f9e", "#3a7d44"
FIXED, MOVING, THEOREM = "#b7791f", "#6b4e9b", "#a9b3bf"


def height_of_column(bodies: int, *, with_curves: bool) -> float:
    """What so many bodies need [mm]."""
    return POLYGON_MM + ROW_MM * (bodies + (CURVE_ROWS if with_curves else 0.0) + 1.0)


def write_legend(axes: Axes, numbers: Mapping[str, int], link: str, column: Box) -> None:
    """The bodies by number; of a ``link``, where one was named, what is which curve."""
    left, y = column.left + 2.0, column.bottom + column.height - POLYGON_MM - ROW_MM
    room = (column.width - 4.0) / MM_PER_IN
    for body, k in numbers.items():
        text(axes, left, y, cut(f"{k}  {body}", room, SMALL), SMALL)
        y -= ROW_MM
    if not link:
        return
    y -= 0.5 * ROW_MM
    for words in (f"of {link}:", "P  velocity pole", "Q  acceleration pole"):
        text(axes, left, y, cut(words, room, SMALL), SMALL)
        y -= ROW_MM
    kinds = {
        "inflection circle": INFLECTION, "second circle of Bresse": NO_TANGENTIAL,
        "fixed centrode": FIXED, "moving centrode": MOVING,
    }  # fmt: skip
    for words, colour in kinds.items():
        start = np.array([left, y + 0.8])
        line(axes, start, start + np.array([SAMPLE_MM, 0.0]), color=colour, linewidth=0.9)
        text(axes, left + SAMPLE_MM + 1.5, y, words, SMALL)
        y -= ROW_MM


def body_numbers(drawn: DrawnPolygons) -> dict[str, int]:
    """The numbers of the bodies, as books have them: 0 the ground, 1 the driver, then the rest."""
    placement = drawn.placement
    driver = placement.scene.driver.link
    rest = [body for body in placement.structure.bodies if body != driver]
    return {body: k for k, body in enumerate([GROUND, driver, *rest])}


def centre_name(pair: Pair, numbers: Mapping[str, int]) -> str:
    """P12 and the like, the lower number first."""
    low, high = sorted(numbers[body] for body in pair)
    return f"P{low}{high}" if high < 10 else f"P{low}.{high}"


def draw_polygon_of_centres(
    axes: Axes, centres: Mapping[Pair, Centre], numbers: Mapping[str, int], column: Box
) -> None:
    """At the top of the column: bodies as corners, centres of joints full sides, others dashed."""
    top = column.bottom + column.height
    middle = np.array([column.left + column.width / 2, top - POLYGON_MM / 2])
    radius = POLYGON_MM / 2 - 5.0
    angles = math.pi / 2 + math.tau * np.arange(len(numbers)) / len(numbers)
    corners = middle + radius * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    for pair, centre in centres.items():
        one, other = (corners[numbers[body]] for body in sorted(pair))
        style = (0, (3, 2)) if centre.by else "-"
        line(axes, one, other, color=THEOREM if centre.by else INK, linewidth=0.6, linestyle=style)
    for body, k in numbers.items():
        at = corners[k]
        axes.add_patch(Round(tuple(at), 2.2, fc="white", ec=INK, lw=0.6, zorder=7))
        look: dict[str, Any] = {"ha": "center", "zorder": 8, "gid": f"body-{body}"}
        text(axes, at[0], at[1] - 0.75, str(k), SMALL, **look)
