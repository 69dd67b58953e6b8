"""How the lines of a construction look on paper."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from analytic.lectures.synthesis.design import Circle, Curve, Dot, Element, Look, Segment, Step
from models.array import Array
from reports.figures.style import INK
from reports.lectures.drawing.sheets.canvas import arc_places, cut_line, near_angles

GIVEN, AUXILIARY, OTHERS = "#2e6f9e", "#a9b3bf", "#d3dfe9"
"""Of what a task gives, of what is drawn on the way, and of the mechanism's other positions; the
last two are so faint that letters may interrupt them."""
CURVES = ("#b7791f", "#6b4e9b", "#3a7d44")
"""Of curves, one after the other: they go through everything, and have to be told apart."""
OTHERS_WIDTH = 1.2


@dataclass(frozen=True)
class Stroke:
    """The colour of a line, and its width [point]."""

    colour: str
    width: float


LOOKS: dict[Look, Stroke] = {
    "given": Stroke(GIVEN, 1.1),
    "auxiliary": Stroke(AUXILIARY, 0.6),
    "result": Stroke(INK, 1.5),
}


def look_of(element: Element, steps: Sequence[Step]) -> Stroke:
    """That of an element among all of them."""
    if isinstance(element, Curve) and element.look == "auxiliary":
        curves = curves_of(steps)
        number = next(k for k, curve in enumerate(curves) if curve is element)
        return Stroke(CURVES[number % len(CURVES)], 0.8)
    return LOOKS[element.look]


def curves_of(steps: Sequence[Step]) -> list[Curve]:
    """The curves that are drawn on the way, in their order."""
    every = (element for step in steps for element in step.elements)
    return [each for each in every if isinstance(each, Curve) and each.look == "auxiliary"]


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
