"""Errors of drawn graphs, in words and as a table on the terminal."""

import math

import numpy as np
from matplotlib.axes import Axes
from rich.console import Console

from analytic.lectures.drawings.graphical import ORDERS, ThreeGraphs
from models.array import Array
from models.motion import Order
from models.scene.driver import driver_unit
from reports.figures.style import INK, QUIET, TINY, width_in
from reports.lectures.drawing.sheets.graph_drawing import READ, DrawnGraphs
from reports.lectures.drawing.sheets.paper import MM_PER_IN, Box, line, text
from reports.output.console import grid
from reports.output.numbers import listed

ROW_MM = 2.55
GAP_MM = 2.5
DIGITS, MOST_DECIMALS = 5, 9


def table_cells(drawn: DrawnGraphs) -> list[list[str]]:
    """The columns of the table, each with two lines of heading."""
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
    """The division numbers of places, with halves in the middles of parts."""
    length = drawn.span.end - drawn.span.start
    return np.round(2.0 * drawn.parts * (x - drawn.span.start) / length) / 2.0


def driver_column(drawn: DrawnGraphs, x: Array) -> list[str]:
    """The driver's positions at places, as a column."""
    digits = 2 if driver_unit(drawn.span.scene) == "deg" else 5
    return [f"{each + 0.0:.{digits}f}" for each in np.round(drawn.span.driver_at(x), digits)]


def written(values: Array, size: float) -> list[str]:
    """Values with as many decimals as their size requires."""
    decimals = min(max(DIGITS - 1 - math.floor(math.log10(size)), 0), MOST_DECIMALS)
    rounded = np.round(values, decimals) + 0.0
    return [f"{each:.{decimals}f}" if rounded.any() else "0" for each in rounded]


def table_width_mm(drawn: DrawnGraphs) -> float:
    """The width of the table on paper [mm]."""
    return sum(map(_width_mm, table_cells(drawn)))


def _width_mm(column: list[str]) -> float:
    return max(width_in(each, TINY) for each in column) * MM_PER_IN + GAP_MM


def draw_table(axes: Axes, drawn: DrawnGraphs, box: Box) -> None:
    """Draw the table in its box: every second, third... row where room is lacking, with a note."""
    columns = table_cells(drawn)
    rows, room = len(columns[0]) - 2, int(box.height / ROW_MM) - 4
    every = math.ceil(rows / room)
    top = box.top - ROW_MM
    right = box.left
    for column in columns:
        right += _width_mm(column)
        shown = column[:2] + column[2::every]
        for k, cell in enumerate(shown):
            look = QUIET if k < 2 else INK
            text(axes, right, top - ROW_MM * (k + (k >= 2) * 0.4), cell, TINY, ha="right",
                 color=look)  # fmt: skip
    under = top - ROW_MM * 1.45
    line(axes, (box.left, under), (right, under), linewidth=0.4, color=QUIET)
    if every > 1:
        foot = top - ROW_MM * (3.4 + math.ceil(rows / every))
        text(axes, right, foot, f"1 row in {every}", TINY, ha="right", color=QUIET)


NOTHING = 1e-9
"""Share below which an error is rounding."""


def share(off: float) -> str:
    """An error over its size, in per cent."""
    return f"{float(f'{100 * off:.2g}'):g} %" if off > NOTHING else "0 %"


def own_rates_off(drawn: DrawnGraphs, order: Order) -> float | None:
    """Largest error of a log's own rate at the divisions, over the size; None without rate."""
    if drawn.log is None:
        return None
    rates = drawn.log.at_divisions(order, drawn.parts)
    if not rates.x.size:
        return None
    off = rates.y - drawn.span.exact(order, rates.x)
    return float(np.abs(off).max()) / drawn.sizes[order]


def told_errors(drawn: DrawnGraphs, graphs: ThreeGraphs) -> str:
    """The errors of the derived graphs, in words."""
    symbols = drawn.span.symbols
    return ", ".join(
        f"{symbols[order]} off by up to {share(drawn.off(graphs, order))}"
        for order in drawn.derived
    )


def told_log(drawn: DrawnGraphs) -> list[str]:
    """Lines on the errors of the log's graphs, the engine's part of them, and their reading."""
    assert drawn.log is not None
    assert drawn.logged is not None
    symbols, order = drawn.span.symbols, READ[drawn.by]
    parts = listed([
        f"{symbols[each]} {share(drawn.own_part(each))}" for each in drawn.derived
    ])  # fmt: skip
    how = drawn.log.how(order, drawn.logged.graphs[order].x)
    read_off = share(drawn.off(drawn.logged, order))
    lines = [
        f"{drawn.log.name}: {told_errors(drawn, drawn.logged)}; its own part, relative to the "
        f"drawing of the reference: {parts}",
        f"{symbols[order]} is read {drawn.log.span.taken}, {how}; it is off by up to {read_off}",
    ]
    if doubt := drawn.log.doubt(order, drawn.logged.graphs[order].x):
        lines.append(doubt)
    own = [(each, own_rates_off(drawn, each)) for each in drawn.derived]
    said = [f"{symbols[each]} off by up to {share(off)}" for each, off in own if off is not None]
    if said:
        lines.append(f"as logged, at the divisions: {', '.join(said)}")
    return lines


def show_graphs(console: Console, drawn: DrawnGraphs) -> None:
    """Print the table: the read values at each division, and the drawn ones."""
    of = drawn.span
    heads = ["no.", f"{of.scene.driver.name} {driver_unit(of.scene)}"]
    places = _places(drawn)
    columns = [[f"{each:g}" for each in numbers(drawn, places)], driver_column(drawn, places)]
    for order in ORDERS:
        heads.append(f"{of.symbols[order]} {of.units[order]}")
        columns.append(_cells(drawn, drawn.reference, order, places))
        if drawn.logged is not None:
            heads.append("log")
            columns.append(_cells(drawn, drawn.logged, order, places))
        elif order != READ[drawn.by]:
            heads.append("exact")
            columns.append(written(of.exact(order, places), drawn.sizes[order]))
    rows = zip(*columns, strict=True)
    console.print(grid((f"{head}:" for head in heads), rows, wraps=True))


def _places(drawn: DrawnGraphs) -> Array:
    """All plotted places, by halves of parts."""
    halves = {float(each) for graph in drawn.reference.graphs for each in numbers(drawn, graph.x)}
    length = drawn.span.end - drawn.span.start
    return drawn.span.start + length * np.array(sorted(halves)) / drawn.parts


def _cells(drawn: DrawnGraphs, graphs: ThreeGraphs, order: Order, places: Array) -> list[str]:
    """The values of a graph at those places, "" where it has no point."""
    graph = graphs.graphs[order]
    texts = written(graph.y, drawn.sizes[order])
    at = dict(zip(numbers(drawn, graph.x).tolist(), texts, strict=True))
    return [at.get(each, "") for each in numbers(drawn, places).tolist()]
