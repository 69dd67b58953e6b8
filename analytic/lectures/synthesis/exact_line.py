r"""Peaucellier's linkage: eight links that lead a point exactly along a line.

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

from __future__ import annotations

import cmath
import math

import numpy as np

from analytic.lectures.synthesis.asked import AskedPlace, PrecisionPosition
from analytic.lectures.synthesis.construction import Dot, Segment, Step
from analytic.lectures.synthesis.design import Proposal
from analytic.lectures.synthesis.line_draft import refuse_none
from models.array import Array
from models.lectures.draft import SPEED_RAD_S, Draft, bar

CRANK = "crank"
ARM, SIDE, CIRCLE = 5.0, 2.0, 1.9
"""Proportions: the arms, the sides of the rhombus, and the crank. A may be 3 to 7 from O4, and is
3.8 from it in the middle of the line."""
LEAN = math.radians(32.0)
"""Of O4-A, at most, to either side: the rhombus would be flat at 37.9 degrees."""
POSITIONS = 5


def peaucellier(length_m: float, *, start: complex = 0j, direction_rad: float = 0.0) -> Proposal:
    """Peaucellier's linkage with a way of a length [m], along which P is nowhere off the line.

    Parameters
    ----------
    length_m
        Of the way [m], over which the crank swings by twice 64 degrees.
    start, direction_rad
        Where the way begins [m], and its direction [rad].

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
    # The crank turns by twice the lean of O4-A, and P goes by the tangent of the lean.
    ways = np.linspace(-1.0, 1.0, POSITIONS)
    places = (middle + 0.5 * length_m * ways * turn).tolist()
    cranks = [o2 + CIRCLE * scale * inward * cmath.exp(2j * lean) for lean in _leans(ways)]
    corners = [_corner(a, p, scale) for a, p in zip(cranks, places, strict=True)]
    # That of B tells the assembly from the one with B and C exchanged.
    positions = tuple(
        PrecisionPosition(cmath.phase(a - o2), (AskedPlace("P", p), AskedPlace("B", b)))
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
    steps = _steps((o2, o4, cranks[at], corners[at], places[at]), places)
    return Proposal(draft, CRANK, positions, chosen, steps)


def _leans(ways: Array) -> list[float]:
    """The lean of O4-A [rad] with P at shares of half its way."""
    leans: list[float] = np.arctan(ways * math.tan(LEAN)).tolist()
    return leans


def _corner(a: complex, p: complex, scale: float) -> complex:
    """The corner B of the rhombus over A and P: to the left of the way from A to P."""
    half = 0.5 * (p - a)
    return a + half + 1j * half / abs(half) * math.sqrt((SIDE * scale) ** 2 - abs(half) ** 2)


def _steps(points: tuple[complex, ...], places: list[complex]) -> tuple[Step, ...]:
    """The way, and the linkage in its middle."""
    o2, o4, a, b, p = points
    c = a + p - b
    pairs = ((o2, a), (o4, b), (o4, c), (a, b), (a, c), (b, p), (c, p))
    dots = tuple(Dot(place, str(k + 1), "given") for k, place in enumerate(places))
    pivots = Dot(o2, "O2", "result", fixed=True), Dot(o4, "O4", "result", fixed=True)
    links = tuple(Segment(*pair, "result") for pair in pairs)
    return (
        Step("the way of P", (Segment(places[0], places[-1], "given"), *dots)),
        Step("the linkage in the middle of the way", (*links, *pivots)),
    )
