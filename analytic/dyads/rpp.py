"""RPP: a block pinned at a known point slides on a link that itself slides on a known line.

::

      G --- s1 ---> e      known line (fixed or moving) of the sliding link
            |
            | k            line of the block on the sliding link, at a constant angle to e
            P1             P1 = G + s1 e + s2 k

The directions e and k both turn with the known body, so this is the crossing of two moving lines:
the known one, and the line through P1 along k. One assembly only; the conditioning is constant.
"""

from dataclasses import replace

import numpy as np

from analytic.dyads import prp
from analytic.dyads.parts import Closure, Dyad, MovingLine, Sliding
from analytic.dyads.plane import PointKinematics, Vec


def solve(
    p1: PointKinematics,
    line: MovingLine,
    inner: Vec,
    rounding: float = 0.0,
    *,
    certified: bool = False,
    stretch: bool = False,
) -> Dyad[Sliding, Sliding]:
    """Solve an RPP dyad.

    Parameters
    ----------
    p1 : PointKinematics
        The pin of the block.
    line : MovingLine
        The line on which the link slides.
    inner : Vec
        Unit vector of the block's line k against e: the constant angle from e to k.
    rounding : float
        Error of that angle [rad].
    certified, stretch
        As for `analytic.dyads.prp.solve`.

    Returns
    -------
    Dyad
        The displacement s1 of the link along its line, and s2 of the block along k;
        ``sine`` of the angle between the two lines.

    Raises
    ------
    OpenError
        The two lines are parallel.
    """
    error = line.error
    if error is not None:
        error = error._replace(theta=error.theta + rounding)
    across = MovingLine(p1, line.along.turned(inner), line.omega, line.alpha, error)
    crossing = prp.solve(line, across, certified=certified, stretch=stretch)
    # The crossing lies at s2 from P1 along k; the block lies at -s2 from the crossing.
    second = crossing.second
    block = replace(second, s=-second.s, speed=-second.speed, acceleration=-second.acceleration)
    short = None
    if stretch:  # parallel for good, as the angle between the lines is constant
        gap = np.abs((p1.p - line.point.p).cross(line.along))
        short = np.where(crossing.sine == 0.0, gap, -gap)
    return Dyad(crossing.first, block, crossing.sine, Closure(None, short))
