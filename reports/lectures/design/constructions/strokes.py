"""What one draws of an element of a construction: lines, as far as they are in a box."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from analytic.lectures.synthesis.construction import Circle, Curve, Dot, Element, Segment
from models.array import Array
from reports.lectures.drawing.sheets.cut_lines import arc_places, cut_line, near_angles

LEAST = 1e-9
"""An arc that is shorter [rad] is none."""


def xy(place: complex) -> Array:
    """A place as the drawing has it (2,)."""
    return np.array([place.real, place.imag])


def strokes(element: Element, low: Array, high: Array) -> list[Array]:
    """The lines of an element within a box [m], (n, 2) each; none of a dot."""
    return [part for line in _lines(element, low, high) for part in cut_line(line, low, high)]


def _lines(element: Element, low: Array, high: Array) -> Iterator[Array]:
    """The whole lines of an element, but for what of a circle is far from the box."""
    match element:
        case Dot():
            return
        case Segment(start, end, _, beyond):
            more = beyond * (end - start)
            yield np.array([xy(start - more), xy(end + more)])
        case Circle(centre, radius):
            for first, last in _arcs(element, low, high):
                yield arc_places(xy(centre), radius, first, last)
        case Curve(pieces):
            for piece in pieces:
                if len(piece) > 1:
                    yield np.array([xy(place) for place in piece])


def _arcs(circle: Circle, low: Array, high: Array) -> Iterator[tuple[float, float]]:
    """The parts of a circle or an arc that may be in a box, from angle to angle [rad]."""
    near = near_angles(xy(circle.centre), circle.radius, low, high)
    if circle.arc is None:
        yield near
        return
    start, end = circle.arc
    end = start + ((end - start) % math.tau or math.tau)
    if near[1] - near[0] > math.tau - LEAST:
        yield start, end
        return
    shift = math.tau * math.floor((start - near[0]) / math.tau)
    for turn in (0.0, math.tau, 2.0 * math.tau):
        first, last = max(start, near[0] + shift + turn), min(end, near[1] + shift + turn)
        if last - first > LEAST:
            yield first, last
