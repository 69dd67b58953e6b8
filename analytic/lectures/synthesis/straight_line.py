r"""Four-bars with a nearly straight way of a coupler point, from the length of the straight part.

::

    Chebyshev          Watt             Roberts              Evans

     B-P-A             O2--A              A---B                P
      \ /                  |             / \ / \               A
       X                   P            /   P   \           /    B
      / \                  |           O2         O4       O2     |
    O2   O4                B--O4                                  O4

The driver is the link O2-A.

Source: R. L. Norton, Design of Machinery, section 3.8, figure 3-29 (proportions of Watt, Roberts
and Chebyshev); for Evans the rule that O2-A times A-P is A-B squared, with which P goes straight if
B does: I. I. Artobolevskii, Mechanisms in Modern Engineering Design, volume 1 (approximate
straight-line mechanisms of Evans). And Hoeken's, with a crank that turns::

            P           With the ground g over the crank, coupler and rocker are (3 g - 1)/2, and P
           /            is twice as far from A as B is, on the line A-B. Opposite to O4, P goes
          B             parallel to the ground, at nearly one speed.
        /  \
      A     \
    O2       O4

It is the cognate of Chebyshev's linkage that has a crank.

Source: R. L. Norton, Design of Machinery, section 3.8, figure 3-29 (g = 2) and table 3-1 (others).
"""

import cmath
import math
from dataclasses import dataclass
from typing import Literal

from scipy.optimize import minimize_scalar  # type: ignore[import-untyped]  # ships no stubs

from analytic.lectures.synthesis.path.coupler_curve import CouplerCurve
from analytic.lectures.synthesis.straight_part import (
    StraightLinkage,
    StraightPart,
    longest,
    measured,
    placed,
    refuse_none,
)
from models.errors import CrankcheckError

Kind = Literal["chebyshev", "watt", "roberts", "evans"]


@dataclass(frozen=True)
class Textbook:
    """Linkage in the textbook's numbers, its crank's angle in the middle of the straight part
    [rad], and the default deviation over the length of its part."""

    four_bar: CouplerCurve
    centre_rad: float
    deviation: float
    source: str


NORTON = "R. L. Norton, Design of Machinery, figure 3-29"
TEXTBOOK: dict[Kind, Textbook] = {
    "chebyshev": Textbook(
        CouplerCurve(0j, 2.0 + 0j, 2.5, 1.0, 2.5, 0.5 + 0j, -1),
        math.atan2(2.0, 1.5),
        2e-3,
        NORTON,
    ),
    "watt": Textbook(
        CouplerCurve(0j, 4.0 + 0j, 2.0, 1.0, 2.0, 0.5 + 0j, 1),
        -2.0
        * math.asin(0.125),  # where both cranks are parallel, and P in the middle of the ground
        1e-3,
        NORTON,
    ),
    "roberts": Textbook(
        CouplerCurve(0j, 2.0 + 0j, 1.0, 1.0, 1.0, cmath.exp(-1j * math.pi / 3.0), 1),
        math.pi / 3.0,
        1e-2,
        NORTON,
    ),
    "evans": Textbook(
        CouplerCurve(0j, 1.9 - 2.0j, 1.0, 1.0, 2.0, -1.0 + 0j, 1),
        0.0,
        1e-3,
        "I. I. Artobolevskii, Mechanisms in Modern Engineering Design, volume 1; O. Evans's rule",
    ),
}


def straight_line(
    kind: Kind,
    length_m: float,
    *,
    deviation: float | None = None,
    start: complex = 0j,
    direction_rad: float = 0.0,
) -> StraightLinkage:
    """Return a textbook's linkage with a straight part of a length [m].

    Parameters
    ----------
    kind
        The linkage.
    length_m
        Length of the straight part, along the line [m].
    deviation
        The largest distance from the line, over the length, to either side: the longest part that
        keeps it is taken. None takes that of `TEXTBOOK`.
    start, direction_rad
        Start of the line [m], and its direction [rad].

    Raises
    ------
    CrankcheckError
        A length or a deviation that is not above 0; a deviation that no part keeps.
    """
    book = TEXTBOOK[kind]
    wanted = book.deviation if deviation is None else deviation
    refuse_none(length_m, wanted)
    part = longest(book.four_bar, book.centre_rad, wanted)
    return placed(kind, book.source, book.four_bar, part, length_m, start, direction_rad)


Even = Literal["line", "speed"]
"""Aim of the proportions: a straight line, or an even speed along it."""
LEAST_SHARE, MOST_SHARE = 0.02, 0.5
"""Share of Hoeken's straight part in the crank's turn: below, its deviation is rounding."""
GROUNDS = (1.05, 3.2)
"""Hoeken's ground over its crank: with less, it is no crank; beyond 3, the line curves more."""


def hoeken(
    length_m: float,
    *,
    share: float | None = None,
    deviation: float | None = None,
    even: Even = "line",
    start: complex = 0j,
    direction_rad: float = 0.0,
) -> StraightLinkage:
    """Return Hoeken's crank-rocker, its ground chosen for the narrowest band about the line, or for
    the evenest speed along it.

    Parameters
    ----------
    length_m
        Length of the straight part [m].
    share
        Share of the crank's turn, `LEAST_SHARE` to `MOST_SHARE`.
    deviation
        Instead of a share: the largest distance from the line over the length; the largest share
        with which the proportions keep it is taken. Without either, the share is `MOST_SHARE`.
    even
        Aim: the best line or the most even speed.
    start, direction_rad
        Start of the line [m], and its direction [rad].

    Raises
    ------
    CrankcheckError
        Both a share and a deviation; a number out of its range.
    """
    if share is not None and deviation is not None:
        raise CrankcheckError(
            f"Hoeken's linkage was requested with a share of {share:g} of the turn and a deviation "
            f"of {deviation:g}, which follow from each other; give one of them"
        )
    refuse_none(length_m, 1.0 if deviation is None else deviation)
    own = MOST_SHARE if share is None else share
    if not LEAST_SHARE <= own <= MOST_SHARE:
        raise CrankcheckError(
            f"Hoeken's straight part was requested over {own:g} of the crank's turn; give "
            f"{LEAST_SHARE:g} to {MOST_SHARE:g}"
        )
    if deviation is not None:
        own = _share_of(deviation, even)
    four_bar, part = best_hoeken(own, even)
    source = "R. L. Norton, Design of Machinery, section 3.8, table 3-1"
    return placed("hoeken", source, four_bar, part, length_m, start, direction_rad)


def hoeken_of(ground: float) -> CouplerCurve:
    """Return Hoeken's proportions for a ground over the crank: straight beyond the ground."""
    side = 0.5 * (3.0 * ground - 1.0)
    return CouplerCurve(0j, complex(ground), 1.0, side, side, complex(2.0 * side), 1)


def best_hoeken(share: float, even: Even) -> tuple[CouplerCurve, StraightPart]:
    """Return the best proportions over a share of the crank's turn, and their part."""
    half = math.pi * share

    def part(ground: float) -> StraightPart:
        return measured(hoeken_of(ground), math.pi - half, math.pi + half)

    def badness(ground: float) -> float:
        one = part(ground)
        return one.uneven if even == "speed" else one.deviation_m / one.length_m

    result = minimize_scalar(badness, bounds=GROUNDS, method="bounded", options={"xatol": 1e-7})
    return hoeken_of(float(result.x)), part(float(result.x))


def _share_of(deviation: float, even: Even) -> float:
    """Return the largest share of a turn over which the best proportions keep a deviation."""

    def keeps(share: float) -> bool:
        _, part = best_hoeken(share, even)
        return part.deviation_m <= deviation * part.length_m

    low, high = LEAST_SHARE, MOST_SHARE
    if keeps(high):
        return high
    if not keeps(low):
        raise CrankcheckError(
            f"a deviation of {deviation:.3g} of the length was requested; Hoeken's linkage "
            f"keeps it over less than {LEAST_SHARE:g} of the crank's turn; allow more"
        )
    while high - low > 1e-4:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if keeps(middle) else (low, middle)
    return low
