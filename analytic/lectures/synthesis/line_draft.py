"""The proposal of a linkage that leads a point along a line: to its place, and to its length."""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass

import numpy as np

from analytic.lectures.synthesis.asked import AskedPlace, PrecisionPosition
from analytic.lectures.synthesis.construction import Curve, Dot, Segment, Step
from analytic.lectures.synthesis.design import Proposal
from analytic.lectures.synthesis.fourbar_draft import INPUT, PIVOTS
from analytic.lectures.synthesis.path.coupler_curve import CouplerCurve
from analytic.lectures.synthesis.path.path_draft import POINT, drafted
from analytic.lectures.synthesis.straight_part import StraightPart, measured, on_line
from models.errors import CrankcheckError

DRAWN = 240
"""Places at which a coupler curve is drawn."""


@dataclass(frozen=True)
class StraightLine:
    """A linkage that leads a point nearly straight, and the part over which it does [m]."""

    four_bar: CouplerCurve
    part: StraightPart
    proposal: Proposal


def refuse_none(length_m: float, deviation: float) -> None:
    if not (math.isfinite(length_m) and length_m > 0.0):
        raise CrankcheckError(
            f"a straight part of {length_m:g} m was asked for; give more than 0 m"
        )
    if not (math.isfinite(deviation) and deviation > 0.0):
        raise CrankcheckError(
            f"a deviation of {deviation:g} of the length was asked for; give more than 0 (only "
            "exact linkages have none)"
        )


def placed(
    kind: str,
    source: str,
    book: CouplerCurve,
    part: StraightPart,
    length_m: float,
    start: complex,
    direction_rad: float,
) -> StraightLine:
    """A textbook's linkage, with its line from a place on, and its part of a length [m]."""
    by = length_m / part.length_m * cmath.exp(1j * direction_rad) / part.along
    four_bar = book.moved(by, start - by * part.start)
    turn = cmath.phase(by)
    own = measured(four_bar, part.crank_rad[0] + turn, part.crank_rad[1] + turn)
    # The ends of the part as well: between them the point is as near as is told.
    angles = sorted({own.crank_rad[0], *on_line(four_bar, own), own.crank_rad[1]})
    positions = tuple(
        PrecisionPosition(angle, (AskedPlace(POINT, complex(place)),))
        for angle, place in zip(angles, four_bar.at(np.array(angles)), strict=True)
    )
    draft = drafted(f"straight-line-{kind}", source, four_bar)
    chosen = {
        "deviation from the line": f"{own.deviation_m:.3g} m over {own.length_m:.6g} m",
        "crank's turn": f"{math.degrees(own.crank_rad[1] - own.crank_rad[0]):.6g} deg",
        "change of speed": f"{100.0 * own.uneven:.3g} % of its mean",
    }
    proposal = Proposal(draft, INPUT, positions, chosen, _steps(four_bar, own, angles))
    return StraightLine(four_bar, own, proposal)


def _steps(four_bar: CouplerCurve, part: StraightPart, angles: list[float]) -> tuple[Step, ...]:
    """The line, the linkage in the first position on it, and the curve with these positions."""
    end = part.start + part.length_m * part.along
    first = np.array(angles[:1])
    a, b = (complex(pin[0]) for pin in four_bar.pins(first))
    p = complex(four_bar.at(first)[0])
    low, high = part.crank_rad
    spread = np.linspace(low, low + math.tau if four_bar.family != "limited" else high, DRAWN)
    met = tuple(
        Dot(complex(place), str(k + 1)) for k, place in enumerate(four_bar.at(np.array(angles)))
    )
    pairs = ((four_bar.o2, a), (a, b), (four_bar.o4, b), (a, p), (b, p))
    return (
        Step("the line, and its length", (Segment(part.start, end, "given"),)),
        Step(
            "the linkage in the textbook's proportions",
            (
                *(Segment(*pair, "result") for pair in pairs),
                Dot(four_bar.o2, PIVOTS[0], "result", fixed=True),
                Dot(four_bar.o4, PIVOTS[1], "result", fixed=True),
            ),
        ),
        Step(
            "its coupler curve, and where this is on the line",
            (Curve((tuple(four_bar.at(spread).tolist()),)), *met),
        ),
    )
