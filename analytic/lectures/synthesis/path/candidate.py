"""Four-bars that lead through a path, from fits: sorted out, and with their cognates."""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import isotonic_regression  # type: ignore[import-untyped]  # ships no stubs

from analytic.lectures.synthesis import design
from analytic.lectures.synthesis.path.coupler_curve import CouplerCurve, cognates, real_size
from analytic.lectures.synthesis.path.fit import TOO_LARGE, Fitted
from analytic.lectures.synthesis.path.task import PathTask, least_sine
from models.array import Array
from models.lectures.draft import SPEED_RAD_S, Draft, bar, plate

APART = 0.02
"""Largest difference of equal mechanisms in each length and place, over their size."""
STEP = 1e-6
"""Crank angle [rad] between points that are nearest to one place of the curve, or change their
order there, as noisy points do."""
EQUAL = 6
"""Decimals of the error over the path's radius in which candidates are compared."""


@dataclass(frozen=True)
class FourBarCandidate:
    """Four-bar, its crank's angles in the points [rad], and their distances from them [m]."""

    four_bar: CouplerCurve
    crank_rad: Array
    off_m: Array

    @property
    def rms_m(self) -> float:
        """Root of the mean square of the distances [m]."""
        return float(np.sqrt(np.mean(self.off_m**2)))

    @property
    def largest_m(self) -> float:
        """The largest distance [m]."""
        return float(np.max(self.off_m))

    @property
    def least_sine(self) -> float:
        """Least sine of the transmission angle: over a turn, or between the angles."""
        four_bar = self.four_bar
        phi = self.crank_rad - cmath.phase(four_bar.o4 - four_bar.o2)
        low, high = float(np.min(phi)), float(np.max(phi))
        if four_bar.family != "limited":
            low, high = 0.0, math.pi  # a turn is the same on both sides of the ground
        return least_sine(four_bar.shape, low, high)

    def same_as(self, other: FourBarCandidate) -> bool:
        """True if two are one mechanism, driven at the same pivot."""
        one, two = _numbers(self.four_bar), _numbers(other.four_bar)
        near = bool(np.max(np.abs(one - two)) < APART * max(np.max(np.abs(one[2:])), 1e-300))
        return near and self.four_bar.sign == other.four_bar.sign


def _numbers(one: CouplerCurve) -> Array:
    """Return its places, from the pivot, and its lengths [m]."""
    places = np.array([one.o2, one.o4 - one.o2, one.arm]).view(np.float64)
    return np.array([*places, one.crank, one.coupler, one.rocker])


def candidates(fits: Iterable[Fitted], task: PathTask) -> list[FourBarCandidate]:
    """Return the distinct four-bars of fits whose crank leads through the points in their order,
    and such cognates of them; the nearest to the points first, of equal ones that of the better
    transmission angle."""
    own = [each for fit in fits for each in _of_fit(fit, task)]
    every = [each for one in distinct(own, task) for each in (one, *_cognates(one, task))]
    return distinct(every, task)


def distinct(every: Sequence[FourBarCandidate], task: PathTask) -> list[FourBarCandidate]:
    """Return each mechanism once, in order."""
    kept: list[FourBarCandidate] = []

    def order(one: FourBarCandidate) -> tuple[float, float]:
        return round(one.rms_m / task.radius_m, EQUAL), -one.least_sine

    for one in sorted(every, key=order):
        if not any(one.same_as(other) for other in kept):
            kept.append(one)
    return kept


def _of_fit(fit: Fitted, task: PathTask) -> Iterator[FourBarCandidate]:
    """Yield the four-bar of a fit, if its crank leads through the points."""
    four_bar, angles = real_size(fit)
    own = four_bar.moved(complex(task.radius_m), task.middle)
    yield from _leading(own, angles if task.is_timed else in_order(angles), task)


def _cognates(one: FourBarCandidate, task: PathTask) -> Iterator[FourBarCandidate]:
    """Yield its cognates, driven at either pivot, whose crank leads through the points; with
    timing, by the same angles."""
    at = [cognates(one.four_bar, angle) for angle in one.crank_rad.tolist()]
    for way in zip(*at, strict=True):
        angles = np.unwrap(np.array([angle for _, angle in way]))
        if task.is_timed and np.max(np.abs(np.diff(angles) - np.diff(one.crank_rad))) > STEP:
            continue
        yield from _leading(way[0][0], angles, task)


def _leading(four_bar: CouplerCurve, angles: Array, task: PathTask) -> Iterator[FourBarCandidate]:
    """Yield a four-bar if its crank leads through its angles, and it is not far too large."""
    small = math.isfinite(four_bar.size) and four_bar.size <= TOO_LARGE * task.radius_m
    if not small or not four_bar.leads_through(angles):
        return
    if task.closed and four_bar.family == "limited":
        return
    yield FourBarCandidate(four_bar, angles, np.abs(four_bar.at(angles) - task.array))


def in_order(angles: Array) -> Array:
    """Return angles [rad] that grow, or fall, throughout: the nearest ones of least squares, each a
    little after the one before."""
    sense = 1.0 if angles[-1] >= angles[0] else -1.0
    apart = STEP * np.arange(len(angles))
    ordered = isotonic_regression(sense * angles - apart).x
    return np.asarray(sense * (ordered + apart))


POINT = "P"
LOOKS = 180
"""Number of places at which a coupler curve is drawn."""
ROUNDING = 1e-9
"""Allowed error of the reference beyond that of the fit, over the longest link."""


def drafted(name: str, source: str, four_bar: CouplerCurve) -> Draft:
    """Return the draft of a four-bar with its coupler point."""
    places = {design.PINS[0]: 0j, design.PINS[1]: complex(four_bar.coupler), POINT: four_bar.arm}
    return Draft(
        name,
        source,
        {design.PIVOTS[0]: four_bar.o2, design.PIVOTS[1]: four_bar.o4},
        {
            design.INPUT: bar(design.PIVOTS[0], design.PINS[0], four_bar.crank),
            design.COUPLER: plate(places),
            design.OUTPUT: bar(design.PIVOTS[1], design.PINS[1], four_bar.rocker),
        },
        {"link": design.INPUT, "speed_rad_s": SPEED_RAD_S},
    )


def proposed(
    name: str, source: str, candidate: FourBarCandidate, task: PathTask
) -> design.Proposal:
    """Return a candidate as a proposal: its crank's angles are those that fit the points best."""
    four_bar = candidate.four_bar
    draft = drafted(name, source, four_bar)
    positions = at_places(candidate.crank_rad, task.points)
    allowed = candidate.largest_m / draft.scene.longest_m + ROUNDING
    off = f"{candidate.rms_m:.3g} m RMS, {candidate.largest_m:.3g} m at most"
    chosen = {"distance from the points": off}
    if not task.is_timed:
        chosen["crank angles"] = "nearest to each point"
    if task.freedom > 0:
        chosen["freedom"] = f"{task.freedom} numbers of the four-bar, taken from the search"
    return design.Proposal(
        draft, design.INPUT, positions, chosen, _steps(candidate, task), allowed=allowed
    )


def at_places(crank_rad: Array, places: Iterable[complex]) -> tuple[design.PrecisionPosition, ...]:
    """Return the positions of a coupler point in places [m] at angles of the crank [rad]."""
    asked = [(design.AskedPlace(POINT, place),) for place in places]
    return tuple(map(design.PrecisionPosition, crank_rad.tolist(), asked))


def _steps(candidate: FourBarCandidate, task: PathTask) -> tuple[design.DrawingStep, ...]:
    four_bar, angles = candidate.four_bar, candidate.crank_rad
    dots = tuple(design.numbered("", task.points, "given"))
    curve = drawn_curve(four_bar, (float(np.min(angles)), float(np.max(angles))), LOOKS + 1)
    return (
        design.DrawingStep("the points of the path, in their order", dots),
        design.DrawingStep("the coupler curve of least squares", (curve,)),
        design.DrawingStep(
            "the four-bar that draws it, in the first point", drawn_links(four_bar, angles[:1])
        ),
    )


def drawn_links(four_bar: CouplerCurve, crank_rad: Array) -> tuple[design.Element, ...]:
    """Draw the links and pivots of a four-bar with its crank at an angle [rad], (1,)."""
    ends = (*four_bar.pins(crank_rad), four_bar.at(crank_rad))
    a, b, p = (complex(end[0]) for end in ends)
    o2, o4 = (
        design.Dot(place, name, "result", fixed=True)
        for place, name in zip((four_bar.o2, four_bar.o4), design.PIVOTS, strict=True)
    )
    pairs = ((four_bar.o2, a), (a, b), (four_bar.o4, b), (a, p), (b, p))
    return (*(design.Segment(*pair, "result") for pair in pairs), o2, o4)


def drawn_curve(
    four_bar: CouplerCurve, ends_rad: tuple[float, float], count: int
) -> design.DrawnCurve:
    """Draw the coupler curve through so many places: over a turn, or between the crank's ends."""
    low, high = ends_rad
    if four_bar.family != "limited":
        high = low + math.tau
    return design.DrawnCurve((tuple(four_bar.at(np.linspace(low, high, count)).tolist()),))
