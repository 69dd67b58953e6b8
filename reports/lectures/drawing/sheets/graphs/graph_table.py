"""The table that is drawn first: division, angle of the driver, and what is read there."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.axes import Axes

from models.array import Array
from models.driver import driver_unit
from reports.figures.style import INK, QUIET, TINY, width_in
from reports.lectures.drawing.sheets.canvas import line, text
from reports.lectures.drawing.sheets.graphs.graph_drawing import READ, DrawnGraphs
from reports.lectures.drawing.sheets.paper import MM_PER_IN, Box

ROW_MM = 2.55
GAP_MM = 2.5
DIGITS, MOST_DECIMALS = 5, 9


def table_cells(drawn: DrawnGraphs) -> list[list[str]]:
    """The columns of the table, each from its two lines of heading on."""
    order = READ[drawn.by]
    graph = drawn.reference.graphs[order]
    unit = drawn.span.units[order]
    columns = [
        ["", "no.", *(f"{each:g}" for each in numbers(drawn, graph.x))],
        [
            drawn.span.scene.driver.name,
            driver_unit(drawn.span.scene),
            *driver_column(drawn, graph.x),
        ],
        [drawn.span.symbols[order], unit, *written(graph.y, drawn.sizes[order])],
    ]
    if drawn.logged is not None:
        logged = drawn.logged.graphs[order].y
        columns.append(["log", unit, *written(logged, drawn.sizes[order])])
    return columns


def numbers(drawn: DrawnGraphs, x: Array) -> Array:
    """The divisions at places, halves in the middles of parts."""
    length = drawn.span.end - drawn.span.start
    return np.round(2.0 * drawn.parts * (x - drawn.span.start) / length) / 2.0


def driver_column(drawn: DrawnGraphs, x: Array) -> list[str]:
    """Where the driver is at places."""
    digits = 2 if driver_unit(drawn.span.scene) == "deg" else 5
    return [f"{each + 0.0:.{digits}f}" for each in np.round(drawn.span.driver_at(x), digits)]


def written(values: Array, size: float) -> list[str]:
    """Values with as many decimals as their size asks for."""
    decimals = min(max(DIGITS - 1 - math.floor(math.log10(size)), 0), MOST_DECIMALS)
    rounded = np.round(values, decimals) + 0.0
    return [f"{each:.{decimals}f}" if rounded.any() else "0" for each in rounded]


def table_width_mm(drawn: DrawnGraphs) -> float:
    """How wide the table is on paper."""
    return sum(map(_width_mm, table_cells(drawn)))


def _width_mm(column: list[str]) -> float:
    return max(width_in(each, TINY) for each in column) * MM_PER_IN + GAP_MM


def draw_table(axes: Axes, drawn: DrawnGraphs, box: Box) -> None:
    """The table in its box: every second, third... row where all have no room, which is said."""
    columns = table_cells(drawn)
    rows, room = len(columns[0]) - 2, int(box.height / ROW_MM) - 4
    every = math.ceil(rows / room)
    top = box.bottom + box.height - ROW_MM
    right = box.left
    for column in columns:
        right += _width_mm(column)
        shown = column[:2] + column[2::every]
        for k, cell in enumerate(shown):
            look = QUIET if k < 2 else INK
            text(axes, right, top - ROW_MM * (k + (k >= 2) * 0.4), cell, TINY, ha="right",
                 color=look)  # fmt: skip
    under = top - ROW_MM * 1.45
    line(axes, np.array([box.left, under]), np.array([right, under]), linewidth=0.4, color=QUIET)
    if every > 1:
        foot = top - ROW_MM * (3.4 + math.ceil(rows / every))
        text(axes, right, foot, f"1 row in {every}", TINY, ha="right", color=QUIET)
