"""The whole sheet of graphs as a drawing: captions, legend, table and a layer for each step."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.axes import Axes

from reports.figures.style import LARGE, QUIET, TINY, cut, width_in
from reports.lectures.drawing.sheets.canvas import Canvas, line, text, write_head
from reports.lectures.drawing.sheets.graphs.graph_drawing import READ, DrawnGraphs
from reports.lectures.drawing.sheets.graphs.graph_lines import (
    DASHED,
    DRAWN,
    EXACT,
    RAY,
    draw_axes,
    draw_exact,
    draw_graph,
    draw_own_rates,
    draw_rays,
)
from reports.lectures.drawing.sheets.graphs.graph_sheet import GraphSheet, Panel, graph_sheet
from reports.lectures.drawing.sheets.graphs.graph_words import (
    draw_table,
    own_rates_off,
    share,
    table_width_mm,
)
from reports.lectures.drawing.sheets.paper import MM_PER_IN, Paper, of_elastic
from reports.lectures.drawing.sheets.sheet_log import LOGGED
from reports.output.numbers import readable

NAME_IN = 1.3
"""How long the name of a log is in the title at most [inch]."""


def laid_out(drawn: DrawnGraphs, paper: Paper) -> GraphSheet:
    """Graphs on paper, beside their table. Raises CrankcheckError for parts too narrow."""
    return graph_sheet(drawn, paper, table_width_mm(drawn))


def draw_graphs(sheet: GraphSheet, note: str) -> Canvas:
    """The sheet, a layer for each graph and for the construction of each from the one before."""
    canvas, drawn = Canvas(sheet.paper), sheet.drawn
    frame = canvas.layer("frame")
    write_head(frame, sheet.paper, _title(drawn), note)
    _write_legend(frame, sheet)
    draw_table(frame, drawn, sheet.table)
    for panel in sheet.panels:
        draw_axes(frame, sheet, panel, caption(sheet, panel))
        draw_exact(frame, sheet, panel)
    for panel in sheet.panels:
        if drawn.logged is not None:
            draw_rays(canvas, sheet, panel, drawn.logged, LOGGED, "-log")
        draw_rays(canvas, sheet, panel, drawn.reference, RAY, "")
        draw_graph(canvas, sheet, panel, drawn.reference, DRAWN, "")
        if drawn.logged is not None:
            draw_graph(canvas, sheet, panel, drawn.logged, LOGGED, "-log")
        draw_own_rates(canvas, sheet, panel)
    return canvas


def _title(drawn: DrawnGraphs) -> str:
    of = drawn.span
    over = f"{of.words}, {drawn.parts} parts, by {drawn.by}"
    title = f"{of.scene.name}: {of.quantity.name} over {over}"
    title += of_elastic(of.scene, ", links taken as rigid")
    return f"{title}; log: {cut(drawn.log.name, NAME_IN, LARGE)}" if drawn.log else title


def caption(sheet: GraphSheet, panel: Panel) -> str:
    """What stands above a graph: scale, axis, pole, and what it is off by."""
    drawn, order = sheet.drawn, panel.order
    words = [f"{panel.symbol} [{panel.unit}], {readable(panel.scale)} {panel.unit} per mm"]
    if panel.axis:
        words.append(f"axis at {panel.axis:.6g}")
    if not math.isnan(panel.pole_mm):
        words.append(f"H = {panel.pole_mm:g} mm")
    told = ", ".join(words)
    if order == READ[drawn.by]:
        if drawn.logged is not None:
            told += f"; log off by up to {share(drawn.off(drawn.logged, order))}"
        return told
    if drawn.by == "integration":
        start = drawn.reference.graphs[order].y[0]
        told += f", from {start:.6g} {panel.unit} on (exact)"
    told += f"; off by up to {share(drawn.off(drawn.reference, order))}"
    if drawn.logged is not None:
        told += (
            f"; log by up to {share(drawn.off(drawn.logged, order))}, its own part "
            f"{share(drawn.own_part(order))}"
        )
        own = own_rates_off(drawn, order)
        told += f", as logged {share(own)}" if own is not None else ""
    return told


def _write_legend(axes: Axes, sheet: GraphSheet) -> None:
    """What is along the graphs on the left, what the lines are on the right."""
    drawn, box = sheet.drawn, sheet.legend
    base = box.bottom + 1.6
    text(axes, box.left, base, _along(sheet), TINY, color=QUIET)
    entries = [("exact", EXACT, 1.6, ""), (f"by {drawn.by}", DRAWN, 0.8, "o")]
    if drawn.log is not None:
        entries.append((f"log by {drawn.by}", LOGGED, 0.8, "o"))
        if any(each in drawn.log.rows for each in drawn.derived):
            entries.append(("as logged", LOGGED, 0.0, "D"))
    x = box.left + box.width - 1.0
    for words, color, width, marker in reversed(entries):
        x -= width_in(words, TINY) * MM_PER_IN
        text(axes, x, base, words, TINY, color=QUIET)
        x -= 10.0
        if width:
            start, end = np.array([x, base + 0.6]), np.array([x + 8.0, base + 0.6])
            style = DASHED if color == LOGGED else "-"
            line(axes, start, end, color=color, linewidth=width, linestyle=style)
        if marker:
            look = {"mfc": "none", "mec": color, "mew": 0.5} if marker == "D" else {"mew": 0.0}
            axes.plot(x + 4.0, base + 0.6, marker=marker, ms=1.8, color=color, **look)
        x -= 5.0


def _along(sheet: GraphSheet) -> str:
    of = sheet.drawn.span
    part = (of.end - of.start) / sheet.drawn.parts
    name, unit = (
        ("time", "s") if of.over == "time" else (f"angle of {of.scene.driver.joint}", "deg")
    )
    since = f" from {of.start:.6g} s on" if of.start and not of.analogues else ""
    return (
        f"along: {name}{since}, {readable(of.shown * sheet.scale_x)} {unit} per mm; a part is "
        f"{part / sheet.scale_x:g} mm, {readable(of.shown * part, 4)} {unit}"
    )
