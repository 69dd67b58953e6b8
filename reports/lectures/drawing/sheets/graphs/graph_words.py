"""What drawn graphs are off by, in words and as a table on the terminal."""

from __future__ import annotations

import numpy as np
from rich.console import Console

from analytic.lectures.drawings.graphical import ORDERS, ThreeGraphs
from models.array import Array
from models.driver_shown import driver_unit
from models.errors import harmless
from models.motion import Order
from reports.lectures.drawing.sheets.graphs.graph_drawing import READ, DrawnGraphs
from reports.lectures.drawing.sheets.graphs.graph_table import driver_column, numbers, written
from reports.output.console import plain_table
from reports.output.numbers import listed

NOTHING = 1e-9
"""What is off by a smaller share is rounding."""


def share(off: float) -> str:
    """An error over its size in per cent."""
    return f"{float(f'{100 * off:.2g}'):g} %" if off > NOTHING else "0 %"


def own_rates_off(drawn: DrawnGraphs, order: Order) -> float | None:
    """What a log's own rate is off by at the divisions, over the size; None where it has none."""
    if drawn.log is None:
        return None
    rates = drawn.log.at_divisions(order, drawn.parts)
    if not rates.x.size:
        return None
    off = rates.y - drawn.span.exact(order, rates.x)
    return float(np.abs(off).max()) / drawn.sizes[order]


def told_errors(drawn: DrawnGraphs, graphs: ThreeGraphs) -> str:
    """What the graphs that were derived are off by."""
    symbols = drawn.span.symbols
    return ", ".join(
        f"{symbols[order]} off by up to {share(drawn.off(graphs, order))}"
        for order in drawn.derived
    )


def told_log(drawn: DrawnGraphs) -> list[str]:
    """What the log's graphs are off by, of that the engine's part, and how it was read."""
    assert drawn.log is not None
    assert drawn.logged is not None
    symbols, order = drawn.span.symbols, READ[drawn.by]
    parts = listed([
        f"{symbols[each]} {share(drawn.own_part(each))}" for each in drawn.derived
    ])  # fmt: skip
    how = drawn.log.how(order, drawn.logged.graphs[order].x)
    read_off = share(drawn.off(drawn.logged, order))
    lines = [
        f"{drawn.log.name}: {told_errors(drawn, drawn.logged)}; of that its own error, beside the "
        f"drawing of the reference: {parts}",
        f"{symbols[order]} is read {drawn.log.taken}, {how}; it is off by up to {read_off}",
    ]
    if doubt := drawn.log.doubt(order, drawn.logged.graphs[order].x):
        lines.append(doubt)
    own = [(each, own_rates_off(drawn, each)) for each in drawn.derived]
    said = [f"{symbols[each]} off by up to {share(off)}" for each, off in own if off is not None]
    if said:
        lines.append(f"as logged, at the divisions: {', '.join(said)}")
    return lines


def show_graphs(console: Console, drawn: DrawnGraphs) -> None:
    """Print the table: what is read at each division, and what is drawn from it."""
    of = drawn.span
    table = plain_table(gap=2)
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
    for head in heads:
        table.add_column(head, justify="right")
    for row in zip(*columns, strict=True):
        table.add_row(*row)
    console.print(table)


def _places(drawn: DrawnGraphs) -> Array:
    """All places at which something is plotted, by halves of parts."""
    halves = {float(each) for graph in drawn.reference.graphs for each in numbers(drawn, graph.x)}
    length = drawn.span.end - drawn.span.start
    return drawn.span.start + length * np.array(sorted(halves)) / drawn.parts


def _cells(drawn: DrawnGraphs, graphs: ThreeGraphs, order: Order, places: Array) -> list[str]:
    """The values of a graph at those places, nothing where it has no point."""
    graph = graphs.graphs[order]
    texts = written(graph.y, drawn.sizes[order])
    at = dict(zip(numbers(drawn, graph.x).tolist(), texts, strict=True))
    return [at.get(each, "") for each in numbers(drawn, places).tolist()]


def tell(console: Console, line: str) -> None:
    """A sentence in one line, whatever stands in it."""
    console.print(harmless(line), highlight=False, markup=False, soft_wrap=True)
