"""The sheet of graphs: a quantity over time, differentiated twice with ruler and pole.

::

    graph        the quantity, its divisions and their chords
    P--| graph   its rate: a ray from the pole P parallel to each chord, carried over to the middle
    P--| graph   the rate of that
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes

from analytic.drawings.graphical import Differentiated, by_chords
from analytic.drawings.paper_scale import round_scale
from models.array import Array
from models.errors import CrankcheckError
from models.scene import Scene
from reports.figures.style import FRONT, INK, QUIET, SMALL, TINY
from reports.output.numbers import readable
from reports.sheets.canvas import Canvas, line, text
from reports.sheets.graph_series import GraphSeries, sampled
from reports.sheets.paper import Box, Paper
from reports.sheets.sheet_frame import inner_box, write_head

GAP = 4.0
POLE_ROOM = 48.0
"""Room on the left of the axes for poles and numbers [mm]."""
POLES_MM = (40.0, 30.0, 25.0, 20.0, 15.0, 10.0, 8.0, 6.0, 5.0, 4.0, 3.0)
LEAST_MM = 2.0
"""Parts that are narrower on paper can not be drawn in."""
DENSE = 721
EXACT, DRAWN, RAY = "#9aa5b1", "#2e6f9e", "#b7791f"


@dataclass(frozen=True)
class Drawn:
    """A graph as drawn: its points (n,), its scale [unit to the mm], the exact curve, the pole's
    distance and the rays' ordinates [mm] where it was differentiated (n,)."""

    symbol: str
    unit: str
    x: Array
    y: Array
    scale: float
    exact: Array
    pole_mm: float = 0.0
    rays_mm: Array | None = None
    off: float = 0.0


@dataclass(frozen=True)
class GraphSheet:
    """Three graphs below each other; ``scale_x`` [s to the mm], ``dense_s`` of exact curves."""

    scene: Scene
    name: str
    divisions: int
    scale_x: float
    dense_s: Array
    graphs: tuple[Drawn, ...]
    paper: Paper


def graphs(scene: Scene, name: str, divisions: int, paper: Paper) -> GraphSheet:
    """A quantity of a scene over the driver's period, in equal parts, differentiated twice.

    Raises CrankcheckError for a quantity that the scene has not, and for parts too narrow to draw.
    """
    if scene.is_free:
        raise CrankcheckError(
            f"{scene.name}: it is let go, and has no period to draw; give its driver a law"
        )
    at, dense = sampled(scene, name, divisions, DENSE)
    boxes = _boxes(paper)
    wide = boxes[0].width - POLE_ROOM - 6.0
    part_mm = math.floor(wide / divisions)  # a ruler has millimetres
    if part_mm < LEAST_MM:
        raise CrankcheckError(
            f"--divisions {divisions}: a part is under {LEAST_MM:g} mm wide on {paper.width:g} x "
            f"{paper.height:g} mm; at most {int(wide / LEAST_MM)} fit, or take larger paper"
        )
    scale_x = float(dense.time_s[-1]) / (divisions * part_mm)
    room = boxes[0].height / 2 - 7.0
    return GraphSheet(
        scene, name, divisions, scale_x, dense.time_s, _drawn(at, dense, scale_x, room), paper
    )


def _drawn(at: GraphSeries, dense: GraphSeries, scale_x: float, room: float) -> tuple[Drawn, ...]:
    """The graph and both of its derivatives, drawn one from the other."""
    middle = 0.5 * float(dense.values[0].min() + dense.values[0].max())
    size = float(np.abs(dense.values[0] - middle).max()) or 1.0
    scale = round_scale(size, room)
    x, y = at.time_s, at.values[0] - middle
    found = [Drawn(at.symbols[0], at.units[0], x, y, scale, dense.values[0] - middle)]
    for order in (1, 2):
        exact = dense.values[order]
        pole = _pole(float(np.abs(exact).max()), scale_x, scale, room)
        drawn = by_chords(x, y, pole, scale_x, scale)
        off = np.abs(drawn.y - np.interp(drawn.x, dense.time_s, exact)).max()
        found.append(_graph(at, order, drawn, pole, exact, float(off)))
        x, y, scale = drawn.x, drawn.y, drawn.scale
    return tuple(found)


def _graph(
    at: GraphSeries, order: int, drawn: Differentiated, pole: float, exact: Array, off: float
) -> Drawn:
    symbol, unit = at.symbols[order], at.units[order]
    share = off / (float(np.abs(exact).max()) or 1.0)
    return Drawn(
        symbol, unit, drawn.x, drawn.y, drawn.scale, exact, pole, drawn.ordinates_mm, share
    )


def _pole(largest: float, scale_x: float, scale_y: float, room: float) -> float:
    """The largest usual pole distance [mm] at which the derivative has room."""
    fits = (h for h in POLES_MM if largest * h * scale_x / scale_y <= room)
    return next(fits, POLES_MM[-1])


def _boxes(paper: Paper) -> list[Box]:
    """Three, the upper first."""
    box = inner_box(paper)
    high = (box.height - 2 * GAP) / 3
    return [Box(box.left, box.bottom + k * (high + GAP), box.width, high) for k in (2, 1, 0)]


def draw_graphs(sheet: GraphSheet, note: str) -> Canvas:
    """The sheet, a layer for each graph and for the construction of each derivative."""
    canvas = Canvas(sheet.paper)
    frame = canvas.layer("frame")
    title = f"{sheet.scene.name}: {sheet.name} over a period, {sheet.divisions} parts"
    write_head(frame, sheet.paper, title, note)
    boxes = _boxes(sheet.paper)
    for graph, box in zip(sheet.graphs, boxes, strict=True):
        _axes(frame, sheet, graph, box)
    for k, (graph, box) in enumerate(zip(sheet.graphs, boxes, strict=True)):
        if graph.rays_mm is not None:
            _rays(canvas.layer(f"rays-{graph.symbol}"), sheet, graph, box)
        _curves(canvas.layer(f"graph-{graph.symbol}"), sheet, graph, box, chords=k < 2)
    return canvas


def _origin(box: Box) -> Array:
    return np.array([box.left + POLE_ROOM, box.bottom + box.height / 2])


def _axes(axes: Axes, sheet: GraphSheet, graph: Drawn, box: Box) -> None:
    origin = _origin(box)
    end = origin[0] + sheet.dense_s[-1] / sheet.scale_x + 4.0
    line(axes, origin, np.array([end, origin[1]]), linewidth=0.7)
    up = np.array([0.0, box.height / 2 - 1.0])
    line(axes, origin - up, origin + up, linewidth=0.7)
    marks = np.linspace(0.0, sheet.dense_s[-1], sheet.divisions + 1) / sheet.scale_x
    half, every = np.array([0.0, 0.8]), max(1, sheet.divisions // 12)
    for k, along in enumerate(marks):
        at = origin + np.array([along, 0.0])
        line(axes, at - half, at + half, linewidth=0.5)
        if k % every == 0:
            text(axes, at[0], at[1] - 3.2, str(k), TINY, ha="center", color=QUIET)
    caption = f"{graph.symbol} [{graph.unit}], {readable(graph.scale)} {graph.unit} per mm"
    if graph.rays_mm is not None:
        caption += (
            f", H = {graph.pole_mm:g} mm; off by up to {100 * graph.off:.2g} % of the largest"
        )
    text(axes, box.left + 1.0, box.bottom + box.height - 3.0, caption, SMALL, color=QUIET)
    told = f"{readable(sheet.scale_x)} s per mm"
    text(axes, end, origin[1] + 1.5, told, TINY, ha="right", color=QUIET)


def _rays(axes: Axes, sheet: GraphSheet, graph: Drawn, box: Box) -> None:
    """A ray from the pole for each chord, and its ordinate carried over to the middle."""
    origin = _origin(box)
    pole = origin - np.array([graph.pole_mm, 0.0])
    text(axes, pole[0] - 2.6, pole[1] - 1.0, "P", SMALL)
    assert graph.rays_mm is not None
    for x, ordinate in zip(graph.x, graph.rays_mm, strict=True):
        cut_off = origin + np.array([0.0, ordinate])
        carried = origin + np.array([x / sheet.scale_x, ordinate])
        line(axes, pole, cut_off, color=RAY, linewidth=0.35)
        line(axes, cut_off, carried, color=FRONT, linewidth=0.3)


def _curves(axes: Axes, sheet: GraphSheet, graph: Drawn, box: Box, *, chords: bool) -> None:
    """The exact curve, the drawn points, and their chords where they are differentiated."""
    origin = _origin(box)
    _polyline(axes, origin, sheet.dense_s / sheet.scale_x, graph.exact / graph.scale, EXACT, 1.6)
    x, y = graph.x / sheet.scale_x, graph.y / graph.scale
    for k, (start, end) in enumerate(itertools.pairwise(zip(x, y, strict=True))):
        gid = f"chord-{graph.symbol}-{k}" if chords else ""
        line(axes, origin + start, origin + end, gid, color=DRAWN, linewidth=0.6)
    for at in zip(x, y, strict=True):
        axes.plot(*(origin + at), marker="o", ms=1.4, color=INK)


def _polyline(
    axes: Axes, origin: Array, x: Array, y: Sequence[float] | Array, color: str, width: float
) -> None:
    axes.plot(
        origin[0] + x, origin[1] + np.asarray(y), color=color, lw=width, solid_capstyle="round"
    )
