"""The proposal of a four-bar whose coupler point goes through a path."""

from __future__ import annotations

import math

import numpy as np

from analytic.lectures.synthesis.asked import AskedPlace, PrecisionPosition
from analytic.lectures.synthesis.construction import Curve, Dot, Segment, Step
from analytic.lectures.synthesis.design import Proposal
from analytic.lectures.synthesis.fourbar_draft import COUPLER, INPUT, OUTPUT, PINS, PIVOTS
from analytic.lectures.synthesis.path.candidate import Candidate
from analytic.lectures.synthesis.path.coupler_curve import CouplerCurve
from analytic.lectures.synthesis.path.task import PathTask
from models.array import Array
from models.lectures.draft import SPEED_RAD_S, Draft, bar, plate

POINT = "P"
LOOKS = 180
"""Places at which a coupler curve is drawn."""
ROUNDING = 1e-9
"""Of the longest link: by how much more than the fit the reference may be off."""


def drafted(name: str, source: str, four_bar: CouplerCurve, note: str = "") -> Draft:
    """The draft of a four-bar with its coupler point."""
    places = {PINS[0]: 0j, PINS[1]: complex(four_bar.coupler), POINT: four_bar.arm}
    return Draft(
        name,
        source,
        {PIVOTS[0]: four_bar.o2, PIVOTS[1]: four_bar.o4},
        {
            INPUT: bar(PIVOTS[0], PINS[0], four_bar.crank),
            COUPLER: plate(places),
            OUTPUT: bar(PIVOTS[1], PINS[1], four_bar.rocker),
        },
        {"link": INPUT, "speed_rad_s": SPEED_RAD_S},
        note=note,
    )


def proposed(name: str, source: str, candidate: Candidate, task: PathTask) -> Proposal:
    """A candidate as a proposal: its crank's angles are those that fit the points best."""
    four_bar = candidate.four_bar
    draft = drafted(name, source, four_bar)
    positions = tuple(
        PrecisionPosition(angle, (AskedPlace(POINT, place),))
        for angle, place in zip(candidate.crank_rad.tolist(), task.points, strict=True)
    )
    allowed = candidate.largest_m / draft.scene.longest_m + ROUNDING
    off = f"{candidate.rms_m:.3g} m RMS, {candidate.largest_m:.3g} m at most"
    chosen = {"distance from the points": off}
    if not task.is_timed:
        chosen["crank angles"] = "nearest to each point"
    if task.freedom > 0:
        chosen["freedom"] = f"{task.freedom} numbers of the four-bar, taken from the search"
    return Proposal(draft, INPUT, positions, chosen, _steps(candidate, task), allowed=allowed)


def _steps(candidate: Candidate, task: PathTask) -> tuple[Step, ...]:
    """The points, the curve that goes through them, and the links that draw it."""
    four_bar = candidate.four_bar
    angles = candidate.crank_rad
    first, second = (pin[0] for pin in four_bar.pins(angles[:1]))
    dots = tuple(Dot(place, str(k + 1), "given") for k, place in enumerate(task.points))
    start = complex(four_bar.at(angles[:1])[0])
    links = (
        Segment(four_bar.o2, complex(first), "result"),
        Segment(complex(first), complex(second), "result"),
        Segment(four_bar.o4, complex(second), "result"),
        Segment(complex(first), start, "result"),
        Segment(complex(second), start, "result"),
        Dot(four_bar.o2, PIVOTS[0], "result", fixed=True),
        Dot(four_bar.o4, PIVOTS[1], "result", fixed=True),
    )
    return (
        Step("the points of the path, in their order", dots),
        Step("the coupler curve of least squares", (_curve(four_bar, angles),)),
        Step("the four-bar that draws it, in the first point", links),
    )


def _curve(four_bar: CouplerCurve, angles: Array) -> Curve:
    """The coupler curve: over a turn, or between the outermost angles."""
    low, high = float(np.min(angles)), float(np.max(angles))
    if four_bar.family != "limited":
        high = low + math.tau
    return Curve((tuple(four_bar.at(np.linspace(low, high, LOOKS + 1)).tolist()),))
