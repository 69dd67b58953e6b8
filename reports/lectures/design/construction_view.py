"""The visible part of a construction: the mechanism with its surroundings; words for the rest."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from analytic.kinematics import solve_driven
from analytic.lectures.circuits.arcs import SignedScene
from analytic.lectures.drawings.polygon import DriverState, PlacedMechanism
from analytic.lectures.synthesis import design
from analytic.lectures.synthesis.examine import UNMET, Examined, examine
from models.array import Array
from models.errors import CrankcheckError, ReachError
from models.motion import Motion
from models.scene import Scene
from reports.figures.style import INK
from reports.lectures.drawing.sheets.paper import arc_places, cut_line, near_angles
from reports.lectures.drawing.sheets.scheme import extent_of, sense_of_law
from reports.output.numbers import readable

GIVEN, AUXILIARY, OTHERS = "#2e6f9e", "#a9b3bf", "#d3dfe9"
"""Colours of given elements, of auxiliary lines, and of the mechanism's other positions; the last
two are so faint that letters may interrupt them."""
CURVES = ("#b7791f", "#6b4e9b", "#3a7d44")
"""Colours of curves, one after the other: they cross everything, and must be distinguishable."""
OTHERS_WIDTH = 1.2


@dataclass(frozen=True)
class Stroke:
    """The colour of a line, and its width [point]."""

    colour: str
    width: float


LOOKS: dict[design.Look, Stroke] = {
    "given": Stroke(GIVEN, 1.1),
    "auxiliary": Stroke(AUXILIARY, 0.6),
    "result": Stroke(INK, 1.5),
}


def look_of(element: design.Element, steps: Sequence[design.DrawingStep]) -> Stroke:
    """The look of an element among all of them."""
    if isinstance(element, design.DrawnCurve) and element.look == "auxiliary":
        curves = curves_of(steps)
        number = next(k for k, curve in enumerate(curves) if curve is element)
        return Stroke(CURVES[number % len(CURVES)], 0.8)
    return LOOKS[element.look]


def curves_of(steps: Sequence[design.DrawingStep]) -> list[design.DrawnCurve]:
    """The auxiliary curves, in their order."""
    every = (element for step in steps for element in step.elements)
    return [
        each for each in every if isinstance(each, design.DrawnCurve) and each.look == "auxiliary"
    ]


LEAST = 1e-9
"""Least angle of an arc [rad]."""


def xy(place: complex) -> Array:
    """A place as an array (2,)."""
    return np.array([place.real, place.imag])


def strokes(element: design.Element, low: Array, high: Array) -> list[Array]:
    """The lines of an element within a box [m], (n, 2) each; none for a dot."""
    return [part for line in _lines(element, low, high) for part in cut_line(line, low, high)]


def _lines(element: design.Element, low: Array, high: Array) -> Iterator[Array]:
    """The whole lines of an element, except parts of a circle far from the box."""
    match element:
        case design.Dot():
            return
        case design.Segment(start, end, _, beyond):
            more = beyond * (end - start)
            yield np.array([xy(start - more), xy(end + more)])
        case design.DrawnCircle(centre, radius):
            for first, last in _arcs(element, low, high):
                yield arc_places(xy(centre), radius, first, last)
        case design.DrawnCurve(pieces):
            for piece in pieces:
                if len(piece) > 1:
                    yield np.array([xy(place) for place in piece])


def _arcs(circle: design.DrawnCircle, low: Array, high: Array) -> Iterator[tuple[float, float]]:
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


def placements_of(examined: Examined) -> tuple[PlacedMechanism | None, ...]:
    """The mechanism in each position, on the branch that meets it, even where the driver can not
    lead there; None where it can not be assembled at the driver's angle."""
    return tuple(_placed(examined.scene, position) for position in examined.positions)


def _placed(scene: Scene, position: design.PrecisionPosition) -> PlacedMechanism | None:
    """Place the mechanism on the scene's own branches if they meet the position, else nearest."""
    signed = SignedScene.of(scene)
    every = (
        signed.with_signs(signs) for signs in itertools.product((1, -1), repeat=len(signed.dyads))
    )
    least, best = math.inf, None
    for one in (scene, *every):
        off, placed = _standing(one, position)
        if off < least:
            least, best = off, placed
        if least <= UNMET:
            break
    return best


def _standing(
    scene: Scene, position: design.PrecisionPosition
) -> tuple[float, PlacedMechanism | None]:
    """The distance of a scene from a position, and its placement there."""
    theta, one = np.array([position.driver_rad]), np.ones(1)
    try:
        motion = solve_driven(scene, theta, one, 0.0 * one, bound=False)
    except ReachError:
        return math.inf, None
    state = DriverState(position.driver_rad, sense_of_law(scene))
    off = float(position.off(motion, scene.longest_m)[0])
    return off, PlacedMechanism.standing(scene, motion, state)


NEAR = {"given": math.inf, "result": 1.5, "auxiliary": 0.5}
"""Distance from the mechanism, in its sizes, beyond which an element does not shrink the figure."""
FEW_PLACES = 72
"""Number of places of a circle that must be in the figure."""


@dataclass(frozen=True)
class ConstructionView:
    """A construction with its mechanism in the precision positions, None where it can not be
    assembled, and the places (n, 2) [m] that the figure has room for."""

    examined: Examined
    placements: tuple[PlacedMechanism | None, ...]
    shown: Array

    @staticmethod
    def of(proposed: Examined | design.Proposal) -> ConstructionView:
        """Build the view. Raises CrankcheckError where the first position can not be assembled."""
        examined = examine(proposed) if isinstance(proposed, design.Proposal) else proposed
        placements = placements_of(examined)
        if placements[0] is None:
            name = examined.scene.name
            raise CrankcheckError(f"{name}: can not be assembled in its first precision position")
        return ConstructionView(examined, placements, _shown(examined, placements))

    @property
    def steps(self) -> tuple[design.DrawingStep, ...]:
        return self.examined.proposal.steps

    @property
    def first(self) -> PlacedMechanism:
        """The mechanism in its first precision position."""
        assert self.placements[0] is not None
        return self.placements[0]

    @property
    def others(self) -> list[PlacedMechanism]:
        """The mechanism in its other positions, where it can be assembled."""
        return [each for each in self.placements[1:] if each is not None]

    def far(self, low: Array, high: Array) -> Iterator[tuple[Array, str]]:
        """Elements out of a box [m]: their place (2,), and words; letters once."""
        told = set()
        for number, step in enumerate(self.steps, 1):
            for element in step.elements:
                place, words = _words_of(element, number)
                if words in told or not _is_out(element, low, high):
                    continue
                told.add(words)
                yield xy(place), f"{words} {_away(xy(place), (low + high) / 2)}"


def _shown(examined: Examined, placements: Sequence[PlacedMechanism | None]) -> Array:
    """Places of the mechanism in its positions, of given elements, and of other elements nearby."""
    there = [extent_of(placed) for placed in placements if placed is not None]
    elements = [each for step in examined.proposal.steps for each in step.elements]
    for look, reach in NEAR.items():
        places = np.concatenate(there)
        low, high = places.min(axis=0), places.max(axis=0)
        spare = reach * float(np.max(high - low))
        for element in (each for each in elements if each.look == look):
            own = np.reshape([xy(place) for place in _extent(element)], (-1, 2))
            there.append(own[np.all((own >= low - spare) & (own <= high + spare), axis=1)])
    return np.concatenate(there)


def _extent(element: design.Element) -> Iterable[complex]:
    """The places of an element that the figure must contain: none beyond a line's ends, and none of
    curves and circles that are not given."""
    match element:
        case design.Dot(place):
            return [place]
        case design.Segment(start, end):
            return [start, end]
        case design.DrawnCircle(centre, radius, "given", arc):
            first, last = arc or (0.0, math.tau)
            angles = np.linspace(first, first + ((last - first) % math.tau or math.tau), FEW_PLACES)
            return [complex(place) for place in centre + radius * np.exp(1j * angles)]
        case design.DrawnCurve(pieces, "given"):
            return [place for piece in pieces for place in piece]
    return []


def _is_out(element: design.Element, low: Array, high: Array) -> bool:
    if isinstance(element, design.Dot):
        place = xy(element.place)
        return bool(np.any((place < low) | (place > high)))
    return not strokes(element, low, high)


def _words_of(element: design.Element, number: int) -> tuple[complex, str]:
    match element:
        case design.Dot(place, letter):
            return place, letter or f"a point of step {number}"
        case design.Segment(start, end):
            return 0.5 * (start + end), f"a line of step {number}"
        case design.DrawnCircle(centre, radius):
            return centre, f"a circle of step {number} with the radius {readable(radius)} m"
        case design.DrawnCurve(pieces):
            every = [place for piece in pieces for place in piece] or [0j]
            return every[len(every) // 2], f"a curve of step {number}"


def _away(place: Array, middle: Array) -> str:
    """The direction and distance of a place from the middle of the figure, in words."""
    x, y = place - middle
    angle = round(math.degrees(math.atan2(y, x))) % 360
    where = f"({readable(float(place[0]))}, {readable(float(place[1]))}) m"
    return f"at {where}, {readable(math.hypot(x, y))} m from the middle towards {angle}°"


TOUCHED = 1e-3
"""Distance [rad] at which a driver that turns back still reaches a position."""


def positions_on_way(view: ConstructionView, motion: Motion) -> list[float | None]:
    """The samples at which a motion first goes through the precision positions, as fractional
    numbers; None for a position on another branch, or one that the driver does not reach."""
    scene = view.examined.scene
    theta = motion.links[scene.driver.link].theta
    return [
        _first(theta, position.driver_rad)
        if placed is not None and placed.scene.branch == scene.branch
        else None
        for position, placed in zip(view.examined.positions, view.placements, strict=True)
    ]


def _first(theta: Array, angle: float) -> float | None:
    """The sample at which angles (T,) first pass ``angle``, up to whole turns."""
    off = (theta - angle + math.pi) % math.tau - math.pi
    if abs(off[0]) < TOUCHED:
        return 0.0
    before, after = off[:-1], off[1:]
    passes = (before * after <= 0.0) & (np.abs(after - before) < math.pi)
    if passes.any():
        k = int(np.argmax(passes))
        return k + float(before[k] / (before[k] - after[k]))
    nearest = int(np.argmin(np.abs(off)))
    return float(nearest) if abs(off[nearest]) < TOUCHED else None
