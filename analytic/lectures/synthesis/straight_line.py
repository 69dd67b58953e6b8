r"""Four-bars with a coupler point that goes nearly straight, from the length of the straight part.

::

    Chebyshev          Watt             Roberts              Evans

     B-P-A             O2--A              A---B                P
      \ /                  |             / \ / \               A
       X                   P            /   P   \           /    B
      / \                  |           O2         O4       O2     |
    O2   O4                B--O4                                  O4

The driver is the link O2-A.

Source: R. L. Norton, Design of Machinery, section 3.8, figure 3-29 (proportions of Watt, Roberts
and Chebyshev); of Evans the rule that O2-A times A-P is A-B squared, with which P goes straight
where B does: I. I. Artobolevskii, Mechanisms in Modern Engineering Design, volume 1 (approximate
straight-line mechanisms of Evans).
"""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass
from typing import Literal

from analytic.lectures.synthesis.line_draft import StraightLine, placed, refuse_none
from analytic.lectures.synthesis.path.coupler_curve import CouplerCurve
from analytic.lectures.synthesis.straight_part import longest

Kind = Literal["chebyshev", "watt", "roberts", "evans"]


@dataclass(frozen=True)
class Textbook:
    """A linkage in the textbook's numbers, its crank's angle in the middle of the straight part
    [rad], and the deviation over the length that its part has unless another is asked for."""

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
) -> StraightLine:
    """A textbook's linkage of which a part of a length [m] is straight.

    Parameters
    ----------
    kind
        The linkage.
    length_m
        Of the straight part, along the line [m].
    deviation
        The largest distance from the line, over the length, to either side: the longest part that
        keeps it is taken. None takes that of `TEXTBOOK`.
    start, direction_rad
        Where the line begins [m], and its direction [rad].

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
