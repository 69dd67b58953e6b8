"""PRP: two blocks pinned to each other, each on a known line (fixed or moving).

::

      G1 --- s1 ---> e1
                 P                 G1 + s1 e1 = G2 + s2 e2
      G2 --- s2 ---> e2

One assembly only; singular where the lines are parallel.
"""

import numpy as np

from analytic.dyads import parts
from analytic.dyads.parts import Dyad, MovingLine, SlideError, Sliding
from analytic.dyads.plane import EPS


def solve(
    line1: MovingLine, line2: MovingLine, *, certified: bool = False, stretch: bool = False
) -> Dyad[Sliding, Sliding]:
    """Solve a PRP dyad: the point where two moving lines cross.

    Parameters
    ----------
    line1, line2 : MovingLine
        The lines of the two blocks.
    certified : bool
        Give error bounds; the lines must then carry theirs.
    stretch : bool
        Let parallel lines pass (the answer is not finite) instead of raising.

    Returns
    -------
    Dyad
        The displacements s1, s2; ``sine`` of the angle between the lines.

    Raises
    ------
    OpenError
        The lines are parallel.

    Notes
    -----
    Linear in its unknowns. Error about eps (|G1| + |G2| + s) / sine.
    """
    # s1 e1 - s2 e2 = G2 - G1, and so for the rates of both sides.
    det = -line1.along.cross(line2.along)
    jacobian = parts.Jacobian(line1.along, -line2.along, det)
    if not stretch and np.min(np.abs(det)) == 0.0:
        gap = np.abs((line2.point.p - line1.point.p).cross(line1.along))
        raise parts.OpenError(np.where(det == 0.0, gap, -gap))
    with np.errstate(divide="ignore", invalid="ignore"):
        s1, s2 = jacobian.solve(line2.point.p - line1.point.p)
        v1, v2 = jacobian.solve(line2.velocity(s2) - line1.velocity(s1))
        a1, a2 = jacobian.solve(line2.acceleration(s2, v2) - line1.acceleration(s1, v1))
    # Parallel lines at one angle cross on both sides of it.
    closure = parts.Closure(None, -np.abs(det) if stretch else None)
    dyad = Dyad(Sliding(s1, v1, a1), Sliding(s2, v2, a2), np.abs(det), closure)
    return dyad.bounded(*_errors(line1, line2, jacobian, dyad)) if certified else dyad


@np.errstate(divide="ignore", invalid="ignore", over="ignore")
def _errors(
    line1: MovingLine, line2: MovingLine, jacobian: parts.Jacobian, dyad: Dyad[Sliding, Sliding]
) -> tuple[SlideError, SlideError]:
    assert line1.error is not None
    assert line2.error is not None
    first, second = dyad.first, dyad.second
    s1, s2, v1, v2 = first.s, second.s, first.speed, second.speed
    gap = (line1.at(s1) - line2.at(s2)).norm()
    place = line1.errors(s1, v1, 0.0, 0.0)[0] + line2.errors(s2, v2, 0.0, 0.0)[0]
    sizes1, sizes2 = line1.sizes(s1, v1), line2.sizes(s2, v2)
    residual = gap + place + 2 * EPS * (sizes1[0] + sizes2[0])
    # The loop is linear in s1, s2, but its lines turn with the errors of their bodies; that share
    # is in the residual, and in the columns below.
    turn1, turn2 = line1.error.theta + 2 * EPS, line2.error.theta + 2 * EPS
    e1, e2 = parts.certify(
        jacobian, residual, (0.0, 0.0, 0.0), lambda: (np.inf, np.inf), turn1 + turn2
    )
    certificate = parts.Certificate(jacobian, turn1, turn2)
    drift = line1.errors(s1, v1, e1, 0.0)[1] + line2.errors(s2, v2, e2, 0.0)[1]
    r1, r2 = certificate.above(v1, v2, drift, sizes1[1] + sizes2[1])
    shove = line1.errors(s1, v1, e1, r1)[2] + line2.errors(s2, v2, e2, r2)[2]
    a1, a2 = certificate.above(
        first.acceleration, second.acceleration, shove, sizes1[2] + sizes2[2]
    )
    return SlideError(e1, r1, a1), SlideError(e2, r2, a2)
