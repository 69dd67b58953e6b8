"""Scales and pole distances of three graphs of which each is drawn from the one before."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass

from analytic.lectures.drawings.graphical import Method, derivative_scale
from analytic.lectures.drawings.paper_scale import ROUNDING, round_scale

POLES_MM = (40.0, 35.0, 30.0, 25.0, 20.0, 15.0, 12.0, 10.0, 8.0, 6.0, 5.0)
"""Distances that are taken; with less a ray is too steep to be drawn well."""


@dataclass(frozen=True)
class GraphScales:
    """By order: units to the mm, and the distance of the pole beside it, NaN beside the first."""

    units_per_mm: tuple[float, float, float]
    poles_mm: tuple[float, float, float]


def graph_scales(
    by: Method, heights: tuple[float, float, float], scale_x: float, room_mm: float
) -> GraphScales:
    """The scales at which all three graphs fit, and are large.

    Of the graph that is read the scale is a round one, the finest that leaves a pole to the others;
    theirs follow from it and the pole distances.

    Parameters
    ----------
    heights : (float, float, float)
        From the lowest to the highest of each graph, by order [unit].
    scale_x : float
        Units of x to the mm.
    room_mm : float
        How high a graph may be [mm].
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
