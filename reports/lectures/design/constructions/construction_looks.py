"""How the lines of a construction look on paper."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from analytic.lectures.synthesis.construction import Curve, Element, Look, Step
from reports.figures.style import INK

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
