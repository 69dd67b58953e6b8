r"""The nearly straight part of a coupler curve, and linkages that lead a point along a line::

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
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, lru_cache
from itertools import pairwise

import numpy as np
from scipy.optimize import brentq, minimize_scalar  # type: ignore[import-untyped]  # ships no stubs

from analytic.lectures.synthesis import design
from analytic.lectures.synthesis.path import candidate
from analytic.lectures.synthesis.path.coupler_curve import CouplerCurve
from analytic.lectures.synthesis.path.task import Complexes
from models.array import Array
from models.errors import CrankcheckError
from models.lectures.draft import SPEED_RAD_S, Draft, bar

LOOKS = 2401
"""Crank angles at which a part is measured: between two of them the deviation changes by less than
a millionth of its own size."""
TRIALS, HALVINGS = 120, 30
STEP = math.radians(0.25)
"""Step of the crank's angle along its way."""
CLEAR = math.radians(2.0)
"""Distance from the crank's limit positions, where its speed is boundless."""


@dataclass(frozen=True)
class StraightPart:
    """Nearly straight part of a coupler curve, and the line that is nearest to it everywhere.

    ``crank_rad`` are the crank's angles at its ends [rad], ``start`` and ``along`` the line's first
    point [m] and its direction. ``length_m`` is its length along the line, ``deviation_m`` the
    largest distance of the curve from the line, to either side. ``uneven`` is the change of the
    speed along the line, over its mean, with a crank at constant speed.
    """

    crank_rad: tuple[float, float]
    start: complex
    along: complex
    length_m: float
    deviation_m: float
    uneven: float

    @property
    def share(self) -> float:
        """Share of a turn of the crank."""
        return abs(self.crank_rad[1] - self.crank_rad[0]) / math.tau

    def off(self, places: Complexes) -> Array:
        """Return the distance of places to the left of the line [m]."""
        return np.asarray(((places - self.start) * self.along.conjugate()).imag)


def measured(four_bar: CouplerCurve, low: float, high: float) -> StraightPart:
    """Measure the part between two angles of the crank [rad], and its line: that of the least
    largest distance (Chebyshev's)."""
    angles = np.linspace(low, high, LOOKS)
    places = four_bar.at(angles)
    chord = complex(places[-1] - places[0])
    own = (places - places[0]) * (abs(chord) / chord)
    slope = _slope(own)
    along = chord / abs(chord) * (1.0 + 1j * slope) / math.hypot(1.0, slope)
    turned = (places - places[0]) * along.conjugate()
    middle = 0.5 * (float(np.max(turned.imag)) + float(np.min(turned.imag)))
    speed = np.gradient(turned.real, angles, edge_order=2)
    length = float(turned.real[-1])
    return StraightPart(
        (low, high),
        complex(places[0]) + 1j * middle * along,
        along,
        length,
        0.5 * float(np.ptp(turned.imag)),
        float(np.ptp(speed)) * abs(high - low) / length,
    )


def _slope(own: Complexes) -> float:
    """Return the slope with the narrowest band along a chord: its width is a convex function."""
    steepest = 2.0 * float(np.ptp(own.imag) / np.ptp(own.real))
    if steepest < 1e-12:
        return 0.0
    result = minimize_scalar(
        lambda slope: np.ptp(own.imag - slope * own.real),
        bounds=(-steepest, steepest),
        method="bounded",
        options={"xatol": 1e-9 * steepest},
    )
    return float(result.x)


def longest(four_bar: CouplerCurve, centre_rad: float, deviation: float) -> StraightPart:
    """Find the longest part about a crank angle [rad] that deviates by a share of its length. Its
    ends are equally far from the place at its centre. Raises CrankcheckError where the shortest
    tried part deviates more."""
    reach, part = _parts(four_bar, centre_rad)
    # From the longest part down: the curve may leave the line and come back to it.
    good, bad = 0.0, reach
    for half in np.linspace(reach, 0.0, TRIALS, endpoint=False).tolist():
        one = part(half)
        if one.deviation_m <= deviation * one.length_m:
            good = half
            break
        bad = half
    if good == 0.0:
        raise CrankcheckError(
            f"a straight part with a deviation of {deviation:.3g} of its length was requested; "
            "allow more, or use another linkage"
        )
    for _ in range(HALVINGS):
        half = 0.5 * (good + bad)
        one = part(half)
        good, bad = (half, bad) if one.deviation_m <= deviation * one.length_m else (good, half)
    return part(good)


@lru_cache(maxsize=8)
def _parts(
    four_bar: CouplerCurve, centre_rad: float
) -> tuple[float, Callable[[float], StraightPart]]:
    """Return the largest distance of the ends of parts about a crank angle [m], and the part with
    ends at a smaller one; each is measured once, as tasks nearby look at the same parts."""
    angles, far = _both_ways(four_bar, centre_rad)
    ways = [(angle, np.maximum.accumulate(each)) for angle, each in zip(angles, far, strict=True)]

    @cache
    def part(half: float) -> StraightPart:
        low, high = (float(np.interp(half, each, angle)) for angle, each in ways)
        return measured(four_bar, low, high)

    return min(float(each[-1]) for _, each in ways), part


def _both_ways(four_bar: CouplerCurve, centre: float) -> tuple[tuple[Array, Array], list[Array]]:
    """Return the crank's angles from a centre down and up, as far as the curve leads away from it
    within half a turn, and its distances there [m]."""
    steps = np.arange(0.0, math.pi, STEP)
    angles, far = [], []
    for sense in (-1.0, 1.0):
        way = centre + sense * steps
        beyond = way[1:] + sense * CLEAR
        closes = [four_bar.leads_through(np.array([centre, at])) for at in beyond]
        count = 1 + (closes.index(False) if False in closes else len(closes))
        off = np.abs(four_bar.at(way[:count]) - four_bar.at(way[:1]))
        away = int(np.argmax(off)) + 1
        angles.append(way[:away])
        far.append(off[:away])
    return (angles[0], angles[1]), far


def on_line(four_bar: CouplerCurve, part: StraightPart) -> list[float]:
    """Return the angles of the crank [rad] at which the curve crosses the line of a part."""

    def off(angle: float) -> float:
        return float(part.off(four_bar.at(np.array([angle])))[0])

    angles = np.linspace(*part.crank_rad, LOOKS)
    sides = np.sign(part.off(four_bar.at(angles)))
    return [
        float(brentq(off, angles[i], angles[j], xtol=1e-15, rtol=1e-14))
        for i, j in pairwise(range(LOOKS))
        if sides[i] != sides[j] and sides[i] != 0.0
    ]


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
            f"a straight part of {length_m:g} m was requested; give more than 0 m"
        )
    if not (math.isfinite(deviation) and deviation > 0.0):
        raise CrankcheckError(
            f"a deviation of {deviation:g} of the length was requested; give more than 0 (only "
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
