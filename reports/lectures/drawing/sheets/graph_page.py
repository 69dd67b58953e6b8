"""The whole sheet of graphs as a drawing: captions, legend, table and a layer for each step."""

import itertools
import math

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Rectangle

from analytic.lectures.drawings.graphical import Plotted, ThreeGraphs
from reports.figures.style import INK, LARGE, QUIET, SMALL, TINY, cut, width_in
from reports.lectures.drawing.sheets import graph_words
from reports.lectures.drawing.sheets.graph_drawing import LOGGED, READ, DrawnGraphs
from reports.lectures.drawing.sheets.graph_sheet import CAPTION_MM, GraphSheet, Panel, graph_sheet
from reports.lectures.drawing.sheets.paper import (
    MM_PER_IN,
    Canvas,
    Paper,
    headed,
    line,
    of_elastic,
    round_scale,
    text,
)
from reports.output.numbers import readable

EXACT, DRAWN, RAY, FAINT = "#a3adb8", "#2e6f9e", "#b7791f", "#e6e6e6"
DASHED = (0, (4, 2))
"""Style of a log's lines, through which others are seen."""
VALUES_APART_MM = 6.0
"""Least distance of values beside a graph."""
LABELS_APART_MM = 6.5
"""Least distance of numbers of divisions, or of angles."""
TANGENT = 0.35
"""Length of a tangent to either side, in parts."""


def draw_axes(axes: Axes, sheet: GraphSheet, panel: Panel, caption: str) -> None:
    """Draw axes of a graph, its divisions with their numbers, values on the right, and the pole."""
    box, top = panel.box, panel.box.top
    room = (box.right - sheet.legend.left) / MM_PER_IN
    size = SMALL if width_in(caption) <= room else TINY
    words = cut(caption, room, size)
    text(axes, sheet.legend.left, top + CAPTION_MM - 3.2, words, size, color=QUIET)
    along = np.linspace(box.left, box.right, sheet.drawn.parts + 1)
    names, every = _names(sheet), math.ceil(LABELS_APART_MM * sheet.drawn.parts / box.width)
    for k, x in enumerate(along):
        line(axes, (x, box.bottom), (x, top), color=FAINT, linewidth=0.3)
        line(axes, (x, panel.axis_mm - 0.7), (x, panel.axis_mm + 0.7), linewidth=0.4)
        if k % every == 0:
            text(axes, x, box.bottom - 2.6, names[k], TINY, ha="center", color=QUIET)
    end = np.array([box.right + 2.0, panel.axis_mm])
    line(axes, panel.origin, end, linewidth=0.6)
    line(axes, (box.left, box.bottom), (box.left, top), linewidth=0.6)
    _write_values(axes, panel)
    if not math.isnan(panel.pole_mm):
        pole = panel.origin - np.array([panel.pole_mm, 0.0])
        line(axes, pole, panel.origin, color=QUIET, linewidth=0.3)
        text(axes, pole[0] - 2.6, pole[1] - 1.0, "P", SMALL)


def _names(sheet: GraphSheet) -> list[str]:
    of, parts = sheet.drawn.span, sheet.drawn.parts
    if of.over == "time":
        return [str(k) for k in range(parts + 1)]
    return [f"{each:.4g}" for each in np.round(of.driver_at(of.divisions(parts)), 2) + 0.0]


def _write_values(axes: Axes, panel: Panel) -> None:
    right, bottom = panel.box.right + 2.0, panel.box.bottom
    line(axes, (right, bottom), (right, panel.box.top), linewidth=0.4, color=QUIET)
    step = round_scale(VALUES_APART_MM * panel.scale, 1.0)
    lowest = panel.axis + (bottom - panel.axis_mm) * panel.scale
    first, last = lowest / step, lowest / step + panel.box.height * panel.scale / step
    for k in range(math.ceil(first), math.floor(last) + 1):
        y = float(panel.height_mm(np.array(k * step)))
        line(axes, (right, y), (right + 0.9, y), linewidth=0.4, color=QUIET)
        text(axes, right + 1.4, y, readable(k * step), TINY, va="center", color=QUIET)


def draw_exact(axes: Axes, sheet: GraphSheet, panel: Panel) -> None:
    """Draw the exact curve."""
    dense = sheet.drawn.span.dense
    y = panel.height_mm(sheet.drawn.span.exact(panel.order, dense))
    (curve,) = axes.plot(sheet.along_mm(dense), y, color=EXACT, lw=1.6, solid_capstyle="round")
    _clip(axes, panel, [curve])


def draw_rays(
    canvas: Canvas, sheet: GraphSheet, panel: Panel, drawn: ThreeGraphs, color: str, layer: str
) -> None:
    """Draw a ray from the pole to each ordinate on the axis, and from there across to its place; by
    integration the mean ordinates as well."""
    if not panel.order:
        return
    axes = canvas.layer(f"rays-{panel.symbol}{layer}")
    slopes = drawn.slopes[0 if panel.order == 1 else 1]
    pole = panel.origin - np.array([panel.pole_mm, 0.0])
    ends = zip(sheet.along_mm(slopes.x), panel.height_mm(slopes.y), strict=True)
    for k, (x, y) in enumerate(ends):
        cut_off, carried = (panel.box.left, y), (x, y)
        gid = f"ray-{panel.symbol}{layer}-{k}"
        line(axes, pole, cut_off, gid, color=color, linewidth=0.35)
        line(axes, cut_off, carried, color=color, linewidth=0.2, alpha=0.5)
        if sheet.drawn.by == "integration":
            line(axes, (x, panel.axis_mm), carried, color=color, linewidth=0.35)
    _clip(axes, panel, axes.lines, left=panel.pole_mm)


def draw_graph(
    canvas: Canvas, sheet: GraphSheet, panel: Panel, drawn: ThreeGraphs, color: str, layer: str
) -> None:
    """Draw the points of a graph, and the chords or steps between, or also its tangents."""
    axes = canvas.layer(f"graph-{panel.symbol}{layer}")
    graph = drawn.graphs[panel.order]
    x, y = sheet.along_mm(graph.x), panel.height_mm(graph.y)
    by = sheet.drawn.by
    word = "chord"
    if by == "integration" and panel.order < READ[by]:
        word = "step"
    look = {"color": color, "linewidth": 0.6, "linestyle": DASHED if layer else "-"}
    for k, (start, end) in enumerate(itertools.pairwise(np.column_stack([x, y]))):
        line(axes, start, end, f"{word}-{panel.symbol}{layer}-{k}", **look)
    if by == "tangents" and panel.order != 2:
        _draw_tangents(axes, sheet, panel, graph, drawn.slopes[panel.order], color)
    axes.plot(x, y, ls="", marker="o", ms=1.3, color=color if layer else INK, mew=0.0)
    _clip(axes, panel, axes.lines)


def _draw_tangents(
    axes: Axes, sheet: GraphSheet, panel: Panel, graph: Plotted, slopes: Plotted, color: str
) -> None:
    reach = TANGENT * (sheet.drawn.span.end - sheet.drawn.span.start) / sheet.drawn.parts
    for k, (x, y, slope) in enumerate(zip(slopes.x, graph.y[1:-1], slopes.y, strict=True)):
        ends = np.array([x - reach, x + reach])
        along, across = sheet.along_mm(ends), panel.height_mm(y + slope * (ends - x))
        start, end = np.column_stack([along, across])
        line(axes, start, end, f"tangent-{panel.symbol}-{k}", color=color, linewidth=1.1)


def draw_own_rates(canvas: Canvas, sheet: GraphSheet, panel: Panel) -> None:
    """Draw the log's own rates at the divisions, as points."""
    log = sheet.drawn.log
    if log is None or panel.order == READ[sheet.drawn.by]:
        return
    rates = log.at_divisions(panel.order, sheet.drawn.parts)
    if not rates.x.size:
        return
    axes = canvas.layer(f"own-{panel.symbol}")
    x, y = sheet.along_mm(rates.x), panel.height_mm(rates.y)
    axes.plot(x, y, ls="", marker="D", ms=2.4, mfc="none", mec=LOGGED, mew=0.5)
    _clip(axes, panel, axes.lines)


def _clip(axes: Axes, panel: Panel, lines: object, left: float = 0.0) -> None:
    """Clip lines to the box of a graph, with the pole left of it."""
    box = panel.box
    frame = Rectangle(
        (box.left - left - 1.0, box.bottom - 0.5), box.width + left + 2.0, box.height + 1.0,
        transform=axes.transData,
    )  # fmt: skip
    for each in lines:  # type: ignore[attr-defined]  # matplotlib's own list
        each.set_clip_path(frame)


NAME_IN = 1.3
"""Greatest length of the name of a log in the title [inch]."""


def laid_out(drawn: DrawnGraphs, paper: Paper) -> GraphSheet:
    """Graphs on paper, beside their table. Raises CrankcheckError for parts too narrow."""
    return graph_sheet(drawn, paper, graph_words.table_width_mm(drawn))


def draw_graphs(sheet: GraphSheet, note: str) -> Canvas:
    """Draw the sheet, a layer for each graph and for the construction of each from the last."""
    drawn = sheet.drawn
    canvas, frame = headed(sheet.paper, _title(drawn), note)
    _write_legend(frame, sheet)
    graph_words.draw_table(frame, drawn, sheet.table)
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
    """The caption of a graph: scale, axis, pole, and errors."""
    drawn, order = sheet.drawn, panel.order
    words = [f"{panel.symbol} [{panel.unit}], {readable(panel.scale)} {panel.unit} per mm"]
    if panel.axis:
        words.append(f"axis at {panel.axis:.6g}")
    if not math.isnan(panel.pole_mm):
        words.append(f"H = {panel.pole_mm:g} mm")
    told = ", ".join(words)
    if order == READ[drawn.by]:
        if drawn.logged is not None:
            told += f"; log off by up to {graph_words.share(drawn.off(drawn.logged, order))}"
        return told
    if drawn.by == "integration":
        start = drawn.reference.graphs[order].y[0]
        told += f", from {start:.6g} {panel.unit} on (exact)"
    told += f"; off by up to {graph_words.share(drawn.off(drawn.reference, order))}"
    if drawn.logged is not None:
        told += (
            f"; log by up to {graph_words.share(drawn.off(drawn.logged, order))}, its own part "
            f"{graph_words.share(drawn.own_part(order))}"
        )
        own = graph_words.own_rates_off(drawn, order)
        told += f", as logged {graph_words.share(own)}" if own is not None else ""
    return told


def _write_legend(axes: Axes, sheet: GraphSheet) -> None:
    """Write the abscissa of the graphs on the left, the key of the lines on the right."""
    drawn, box = sheet.drawn, sheet.legend
    base = box.bottom + 1.6
    text(axes, box.left, base, _along(sheet), TINY, color=QUIET)
    entries = [("exact", EXACT, 1.6, ""), (f"by {drawn.by}", DRAWN, 0.8, "o")]
    if drawn.log is not None:
        entries.append((f"log by {drawn.by}", LOGGED, 0.8, "o"))
        if any(each in drawn.log.rows for each in drawn.derived):
            entries.append(("as logged", LOGGED, 0.0, "D"))
    x = box.right - 1.0
    for words, color, width, marker in reversed(entries):
        x -= width_in(words, TINY) * MM_PER_IN
        text(axes, x, base, words, TINY, color=QUIET)
        x -= 10.0
        if width:
            ends = (x, base + 0.6), (x + 8.0, base + 0.6)
            style = DASHED if color == LOGGED else "-"
            line(axes, *ends, color=color, linewidth=width, linestyle=style)
        if marker:
            look = {"mfc": "none", "mec": color, "mew": 0.5} if marker == "D" else {"mew": 0.0}
            axes.plot(x + 4.0, base + 0.6, marker=marker, ms=1.8, color=color, **look)
        x -= 5.0


def _along(sheet: GraphSheet) -> str:
    of = sheet.drawn.span
    part = (of.end - of.start) / sheet.drawn.parts
    name, unit = f"angle of {of.scene.driver.joint}", "deg"
    if of.over == "time":
        name, unit = "time", "s"
    since = f" from {of.start:.6g} s on" if of.start and not of.analogues else ""
    return (
        f"along: {name}{since}, {readable(of.shown * sheet.scale_x)} {unit} per mm; a part is "
        f"{part / sheet.scale_x:g} mm, {readable(of.shown * part, 4)} {unit}"
    )
