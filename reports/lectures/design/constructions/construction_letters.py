"""The letters of a construction, and the numbers of the steps at the lines that they draw."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from analytic.lectures.synthesis.construction import Curve, Dot, Step
from models.array import Array
from reports.figures.style import INK, QUIET
from reports.lectures.design.constructions.construction_looks import GIVEN, look_of
from reports.lectures.design.constructions.strokes import xy
from reports.lectures.drawing.sheets.letters import NUMBER, Letter
from reports.lectures.drawing.sheets.paper import Box
from reports.lectures.drawing.sheets.scheme import PIN_MM

NEAR_MM = 0.5
"""Points that stand nearer have their letters in one label."""
NUMBERED, NUMBER_PLACES = 2, 14
"""So many lines of a step have its number, at one of so many places along them."""


def dot_letters(
    steps: Sequence[Step], points: Mapping[str, Array], at: Callable[[Array], Array], box: Box
) -> list[Letter]:
    """The letters of all dots in the box, and of the mechanism's ``points`` [m] that have no letter
    by then: C1 is also the letter of a point C in the first position."""
    low, high = box.corners
    dots = [each for step in steps for each in step.elements if isinstance(each, Dot)]
    named = [(dot.letter, at(xy(dot.place)), dot.look) for dot in dots if dot.letter]
    named += [(name, at(place), "result") for name, place in points.items()]
    spots: list[tuple[list[str], Array, str]] = []
    for letter, place, look in named:
        if np.any((place < low) | (place > high)):
            continue
        spot = next((each for each in spots if np.hypot(*(each[1] - place)) < NEAR_MM), None)
        if spot is None:
            spots.append(([letter], place, look))
        elif letter not in spot[0] and f"{letter}1" not in spot[0]:
            spot[0].append(letter)
    return [
        Letter(", ".join(names), place, PIN_MM, color=GIVEN if look == "given" else INK)
        for names, place, look in spots
    ]


def step_numbers(steps: Sequence[Step], drawn: Mapping[int, Sequence[Array]]) -> list[Letter]:
    """The number of each step at its longest lines [mm] that are no links; ``drawn`` are the lines
    of elements, by their identity."""
    letters = []
    for number, step in enumerate(steps, 1):
        every = [each for each in step.elements if not isinstance(each, Dot)]
        some = [each for each in every if each.look != "result"]
        longest = sorted(
            ((max(map(_length, lines)), each) for each in some if (lines := drawn[id(each)])),
            key=lambda pair: -pair[0],
        )
        for _, each in longest[:NUMBERED]:
            line = max(drawn[id(each)], key=_length)
            colour = look_of(each, steps).colour if isinstance(each, Curve) else QUIET
            letters.append(Letter(f"({number})", _along(line), 0.1, NUMBER, colour))
    return letters


def _length(line: Array) -> float:
    return float(np.sum(np.hypot(*np.diff(line, axis=0).T)))


def _along(line: Array) -> Array:
    """Places along a line, evenly, off its ends."""
    way = np.append(0.0, np.cumsum(np.hypot(*np.diff(line, axis=0).T)))
    there = np.linspace(0.06, 0.94, NUMBER_PLACES) * way[-1]
    return np.stack([np.interp(there, way, line[:, k]) for k in (0, 1)], axis=1)
