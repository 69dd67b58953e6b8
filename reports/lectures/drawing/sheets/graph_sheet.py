"""The sheet of graphs: a quantity and its rates, drawn from one another with ruler and pole.

::

    graph        the quantity, its divisions and their chords          | table
    P--| graph   its rate: a ray from the pole P parallel to each chord |
    P--| graph   the rate of that                                       |

By integration the second rate is at the top, and each graph has steps parallel to the rays of the
one before.
"""

import itertools
import math
from dataclasses import dataclass

import numpy as np

from analytic.lectures.drawings.graphical import ORDERS, Method, derivative_scale
from models.array import Array
from models.errors import CrankcheckError
from models.motion import Order
from reports.lectures.drawing.sheets.graph_drawing import READ, DrawnGraphs
from reports.lectures.drawing.sheets.paper import ROUNDING, Box, Paper, inner_box, round_scale

POLES_MM = (40.0, 35.0, 30.0, 25.0, 20.0, 15.0, 12.0, 10.0, 8.0, 6.0, 5.0)
"""Distances of the pole; with less a ray is too steep to be drawn well."""


@dataclass(frozen=True)
class GraphScales:
    """Units to the mm by order, and the distance of the pole beside it, NaN beside the first."""

    units_per_mm: tuple[float, float, float]
    poles_mm: tuple[float, float, float]


def graph_scales(
    by: Method, heights: tuple[float, float, float], scale_x: float, room_mm: float
) -> GraphScales:
    """Choose scales at which all three graphs fit, and are large.

    The scale of the read graph is round, the finest that leaves a pole to the others, whose scales
    follow from it and the pole distances.

    Parameters
    ----------
    heights : (float, float, float)
        Height of each graph from its lowest to its highest value, by order [unit].
    scale_x : float
        Units of x to the mm.
    room_mm : float
        Greatest height of a graph [mm].
    """
    backwards = by == "integration"
    read, second, third = heights[::-1] if backwards else heights

    def after(scale: float, pole: float) -> float:
        return pole * scale_x * scale if backwards else derivative_scale(pole, scale_x, scale)

    coarsest = after(1.0, max(POLES_MM) if backwards else min(POLES_MM))
    own = round_scale(max(read, second / coarsest, third / coarsest**2), room_mm)
    fitting = []
    for one, other in itertools.product(POLES_MM, repeat=2):
        two = after(own, one)
        three = after(two, other)
        high = second / two, third / three
        if max(high) <= room_mm * (1.0 + ROUNDING):
            fitting.append((high[0] * high[1], one, other, two, three))
    _, one, other, two, three = max(fitting)
    if backwards:
        return GraphScales((three, two, own), (math.nan, other, one))
    return GraphScales((own, two, three), (math.nan, one, other))


GAP = 2.0
LEGEND_MM = 5.0
CAPTION_MM, NUMBERS_MM = 5.0, 3.5
"""Room above a graph, and below it for the numbers of the divisions [mm]."""
POLE_ROOM, VALUES_MM = 47.0, 11.0
"""Room left of the axes for poles, and right of the graphs for values [mm]."""
LEAST_MM = 2.0
"""Least width of a part on paper [mm]."""
BEYOND = 0.5
"""Largest excess of a log's graph over the exact one within the sheet, as a share of it."""
STILL = 0.1
"""Greatest height of the graph of a body at rest, as a share of its size."""


@dataclass(frozen=True)
class Panel:
    """One graph on paper: the value at its x axis, its scale [unit to the mm], the distance of its
    pole (NaN: none), the box of its lines and the height of the axis [mm]."""

    order: Order
    symbol: str
    unit: str
    axis: float
    scale: float
    pole_mm: float
    box: Box
    axis_mm: float

    @property
    def origin(self) -> Array:
        """The origin of the axes [mm]."""
        return np.array([self.box.left, self.axis_mm])

    def height_mm(self, y: Array) -> Array:
        """Values as heights on paper [mm]."""
        return self.axis_mm + (y - self.axis) / self.scale


@dataclass(frozen=True)
class GraphSheet:
    """Three graphs below each other in the order of drawing; ``scale_x`` is units of x to the mm,
    ``table`` the room for the table."""

    drawn: DrawnGraphs
    paper: Paper
    scale_x: float
    panels: tuple[Panel, ...]
    legend: Box
    table: Box

    def along_mm(self, x: Array) -> Array:
        """Places of x on paper [mm]."""
        return self.panels[0].box.left + (x - self.drawn.span.start) / self.scale_x

    def panel(self, order: Order) -> Panel:
        return next(each for each in self.panels if each.order == order)


def graph_sheet(drawn: DrawnGraphs, paper: Paper, table_mm: float) -> GraphSheet:
    """Lay out graphs beside a table so wide. Raises CrankcheckError for parts too narrow."""
    inner = inner_box(paper)
    wide = inner.width - POLE_ROOM - VALUES_MM - GAP - table_mm
    part_mm = math.floor(2.0 * wide / drawn.parts) / 2.0  # a ruler has half millimetres
    if part_mm < LEAST_MM:
        raise CrankcheckError(
            f"--divisions {drawn.parts}: a part is under {LEAST_MM:g} mm wide on {paper.width:g} x "
            f"{paper.height:g} mm; at most {int(wide / LEAST_MM)} fit, or take larger paper"
        )
    scale_x = (drawn.span.end - drawn.span.start) / (drawn.parts * part_mm)
    high = (inner.height - LEGEND_MM - 2 * GAP) / 3
    left, width, tall = (
        inner.left + POLE_ROOM,
        drawn.parts * part_mm,
        high - CAPTION_MM - NUMBERS_MM,
    )
    bottoms = [inner.bottom + k * (high + GAP) + NUMBERS_MM for k in (2, 1, 0)]
    panels = _panels(drawn, scale_x, [Box(left, bottom, width, tall) for bottom in bottoms])
    legend = Box(inner.left, inner.top - LEGEND_MM, inner.width, LEGEND_MM)
    beside = panels[0].box.right + VALUES_MM + GAP
    table = Box(beside, inner.bottom, table_mm, inner.height - LEGEND_MM)
    return GraphSheet(drawn, paper, scale_x, panels, legend, table)


def _panels(drawn: DrawnGraphs, scale_x: float, boxes: list[Box]) -> tuple[Panel, ...]:
    axes = _axis_of_places(drawn), 0.0, 0.0
    reaches = [_reach(drawn, order, axes[order]) for order in ORDERS]
    first, second, third = (high - low for low, high in reaches)
    scales = graph_scales(drawn.by, (first, second, third), scale_x, boxes[0].height)
    panels = []
    orders = ORDERS[::-1] if READ[drawn.by] else ORDERS
    for order, box in zip(orders, boxes, strict=True):
        low, high = reaches[order]
        scale = scales.units_per_mm[order]
        spare = box.height - (high - low) / scale
        symbol, unit = drawn.span.symbols[order], drawn.span.units[order]
        pole = scales.poles_mm[order]
        panels.append(
            Panel(
                order, symbol, unit, axes[order], scale, pole, box,
                box.bottom + spare / 2 - low / scale,
            )
        )  # fmt: skip
    return tuple(panels)


def _axis_of_places(drawn: DrawnGraphs) -> float:
    """The value at the axis of the quantity itself: about its middle; by integration, its start."""
    if drawn.by == "integration":
        return float(drawn.reference.graphs[0].y[0])
    exact = drawn.span.exact(0, drawn.span.dense)
    middle = 0.5 * float(exact.min() + exact.max())
    digits = math.floor(math.log10(drawn.sizes[0])) - 1
    return round(middle, -digits)


def _reach(drawn: DrawnGraphs, order: Order, axis: float) -> tuple[float, float]:
    """The lowest and the highest value of a graph over its axis, which lies within [unit]."""
    exact = drawn.span.exact(order, drawn.span.dense)
    both = np.concatenate([exact, drawn.reference.graphs[order].y, [axis]]) - axis
    low, high = float(both.min()), float(both.max())
    if drawn.logged is not None:
        most = BEYOND * (high - low)
        assert drawn.log is not None
        own = drawn.log.at_divisions(order, drawn.parts).y
        logged = np.concatenate([drawn.logged.graphs[order].y, own]) - axis
        low = max(min(low, float(logged.min())), low - most)
        high = min(max(high, float(logged.max())), high + most)
    if high - low < STILL * drawn.sizes[order]:
        return low - drawn.sizes[order], high + drawn.sizes[order]
    return low, high
