r"""Proposal of a linkage that leads a point along a line of given place and length.

::

              B               O4 and O2 are pivots. O4-B and O4-C are arms, A-B-P-C is a rhombus,
           / / \              the crank O2-A is as long as O2 is far from O4: A goes round a circle
         /  /   \             through O4. O4-A times O4-P stays arm^2 - side^2, and so P is on the
      O4 - A     P            circle's inverse: a line across O4-O2.
         \  \   /
           \ \ /              O2 lies between O4 and A.
              C

Source: C. N. Peaucellier, Nouvelles annales de mathematiques (1864); R. L. Norton, Design of
Machinery, section 3.8, figure 3-30 (exact straight-line linkages).
"""

import cmath
import math
from dataclasses import dataclass

import numpy as np

from analytic.lectures.synthesis import design
from analytic.lectures.synthesis.path import candidate
from analytic.lectures.synthesis.path.coupler_curve import CouplerCurve
from analytic.lectures.synthesis.straight_part import StraightPart, measured, on_line
from models.array import Array
from models.errors import CrankcheckError
from models.lectures.draft import SPEED_RAD_S, Draft, bar

DRAWN = 240
"""Number of places at which a coupler curve is drawn."""


@dataclass(frozen=True)
class StraightLinkage:
    """Linkage that leads a point nearly straight, and the straight part [m]."""

    four_bar: CouplerCurve
    part: StraightPart
    proposal: design.Proposal


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
) -> StraightLinkage:
    """Place a textbook's linkage, its line from a place on, and its part of a length [m]."""
    by = length_m / part.length_m * cmath.exp(1j * direction_rad) / part.along
    four_bar = book.moved(by, start - by * part.start)
    turn = cmath.phase(by)
    own = measured(four_bar, part.crank_rad[0] + turn, part.crank_rad[1] + turn)
    # The ends of the part as well: between them the point is as near as stated.
    angles = np.array(sorted({own.crank_rad[0], *on_line(four_bar, own), own.crank_rad[1]}))
    positions = candidate.at_places(angles, four_bar.at(angles).tolist())
    draft = candidate.drafted(f"straight-line-{kind}", source, four_bar)
    chosen = {
        "deviation from the line": f"{own.deviation_m:.3g} m over {own.length_m:.6g} m",
        "crank's turn": f"{math.degrees(own.crank_rad[1] - own.crank_rad[0]):.6g} deg",
        "change of speed": f"{100.0 * own.uneven:.3g} % of its mean",
    }
    proposal = design.Proposal(
        draft, design.INPUT, positions, chosen, _steps(four_bar, own, angles)
    )
    return StraightLinkage(four_bar, own, proposal)


def _steps(
    four_bar: CouplerCurve, part: StraightPart, angles: Array
) -> tuple[design.DrawingStep, ...]:
    end = part.start + part.length_m * part.along
    curve = candidate.drawn_curve(four_bar, part.crank_rad, DRAWN)
    on_curve = design.numbered("", four_bar.at(angles).tolist())
    return (
        design.DrawingStep("the line, and its length", (design.Segment(part.start, end, "given"),)),
        design.DrawingStep(
            "the linkage in the textbook's proportions", candidate.drawn_links(four_bar, angles[:1])
        ),
        design.DrawingStep("its coupler curve, and where this is on the line", (curve, *on_curve)),
    )


CRANK = "crank"
ARM, SIDE, CIRCLE = 5.0, 2.0, 1.9
"""Proportions: the arms, the sides of the rhombus, and the crank. A may be 3 to 7 from O4, and is
3.8 from it in the middle of the line."""
LEAN = math.radians(32.0)
"""Largest lean of O4-A, to either side: the rhombus would be flat at 37.9 degrees."""
POSITIONS = 5


def peaucellier(
    length_m: float, *, start: complex = 0j, direction_rad: float = 0.0
) -> design.Proposal:
    """Return Peaucellier's linkage with a way of a length [m], with P exactly on the line.

    Parameters
    ----------
    length_m
        Length of the way [m], over which the crank swings by twice 64 degrees.
    start, direction_rad
        Start of the way [m], and its direction [rad].

    Raises
    ------
    CrankcheckError
        A length that is not above 0.
    """
    refuse_none(length_m, 1.0)
    distance = (ARM**2 - SIDE**2) / (2.0 * CIRCLE)
    scale = length_m / (2.0 * distance * math.tan(LEAN))
    turn = cmath.exp(1j * direction_rad)
    # O4 is to the left of the way, and O2 between it and the way.
    middle = start + 0.5 * length_m * turn
    inward = -1j * turn
    o4 = middle - inward * distance * scale
    o2 = o4 + inward * CIRCLE * scale
    # The crank turns by twice the lean of O4-A, and P moves by the tangent of the lean.
    ways = np.linspace(-1.0, 1.0, POSITIONS)
    places = (middle + 0.5 * length_m * ways * turn).tolist()
    leans: list[float] = np.arctan(ways * math.tan(LEAN)).tolist()
    cranks = [o2 + CIRCLE * scale * inward * cmath.exp(2j * lean) for lean in leans]
    corners = [_corner(a, p, scale) for a, p in zip(cranks, places, strict=True)]
    # The place of B selects the assembly, as B and C may be exchanged.
    positions = tuple(
        design.PrecisionPosition(
            cmath.phase(a - o2), (design.AskedPlace("P", p), design.AskedPlace("B", b))
        )
        for a, p, b in zip(cranks, places, corners, strict=True)
    )
    draft = Draft(
        "straight-line-peaucellier",
        "R. L. Norton, Design of Machinery, section 3.8",
        {"O2": o2, "O4": o4},
        {
            CRANK: bar("O2", "A", CIRCLE * scale),
            "arm": bar("O4", "B", ARM * scale),
            "arm-2": bar("O4", "C", ARM * scale),
            "side": bar("A", "B", SIDE * scale),
            "side-2": bar("A", "C", SIDE * scale),
            "side-3": bar("B", "P", SIDE * scale),
            "side-4": bar("C", "P", SIDE * scale),
        },
        {"link": CRANK, "speed_rad_s": SPEED_RAD_S},
    )
    chosen = {"crank's turn": f"{math.degrees(4.0 * LEAN):.6g} deg", "deviation": "none"}
    at = POSITIONS // 2
    steps = _exact_steps((o2, o4, cranks[at], corners[at], places[at]), places)
    return design.Proposal(draft, CRANK, positions, chosen, steps)


def _corner(a: complex, p: complex, scale: float) -> complex:
    """Return the corner B of the rhombus over A and P: to the left of the way from A to P."""
    half = 0.5 * (p - a)
    return a + half + 1j * half / abs(half) * math.sqrt((SIDE * scale) ** 2 - abs(half) ** 2)


def _exact_steps(
    points: tuple[complex, ...], places: list[complex]
) -> tuple[design.DrawingStep, ...]:
    o2, o4, a, b, p = points
    c = a + p - b
    pairs = ((o2, a), (o4, b), (o4, c), (a, b), (a, c), (b, p), (c, p))
    dots = design.numbered("", places, "given")
    pivots = design.Dot(o2, "O2", "result", fixed=True), design.Dot(o4, "O4", "result", fixed=True)
    links = tuple(design.Segment(*pair, "result") for pair in pairs)
    return (
        design.DrawingStep("the way of P", (design.Segment(places[0], places[-1], "given"), *dots)),
        design.DrawingStep("the linkage in the middle of the way", (*links, *pivots)),
    )
