"""RRP: a link from a known point to a pin that slides on a known line (fixed or moving).

::

          P1                       +1: the pin lies on the side of the line's direction,
           \\ l                         seen from the foot of the perpendicular from P1
            \\
    --G------C---> e               P1 + l u = G + s e

Singular where the link stands across the line.
"""

import numpy as np

from analytic.dyads import parts
from analytic.dyads.parts import Dyad, Sliding, Turning
from analytic.dyads.plane import EPS, AngleError, PointKinematics, Real


def solve(
    p1: PointKinematics,
    line: parts.MovingLine,
    length: float,
    branch: Real,
    *,
    certified: bool = False,
    stretch: bool = False,
    root: Real | None = None,
) -> Dyad[Turning, Sliding]:
    """Solve an RRP dyad.

    Parameters
    ----------
    p1 : PointKinematics
        The outer pin of the link.
    line : MovingLine
        The line of the inner pin.
    length : float
        Distance from P1 to the inner pin [m].
    branch : int or Array
        +1 where the pin lies from the foot of P1 on the line in the line's direction, else -1.
    certified, stretch, root
        As for `analytic.dyads.rrr.solve`; the root is the distance of the pin from that foot [m].

    Returns
    -------
    Dyad
        The direction from P1 to the pin, and the displacement s; ``sine`` of the angle between
        the link and the perpendicular of the line.

    Raises
    ------
    OpenError
        The line is further from P1 than the link is long.

    Notes
    -----
    Error about eps (|P1| + |G| + s) / sine in the displacement.
    """
    away = line.point.p - p1.p
    height = line.along.cross(away)  # of the line over P1, to the left of e
    square = (length - height) * (length + height)

    def shortage() -> tuple[Real, Real, Real]:
        scale = np.abs(height) + length + p1.p.norm() + line.point.p.norm()
        turn = 0.0 if line.error is None else line.error.theta * away.norm()
        return np.abs(height) - length, scale, parts.uncertain(p1, line.point) + turn

    root, closure = parts.closing_root(square, shortage, stretch, root)
    reach = branch * root
    if stretch:
        height = np.clip(height, -length, length)
    s = reach - line.along.dot(away)  # from the foot of P1 to the pin, less that from it to G
    u = (line.along * reach + line.along.perp() * height) * (1.0 / length)
    jacobian = parts.Jacobian(u.perp() * length, -line.along, reach)
    with np.errstate(divide="ignore", invalid="ignore"):
        w, speed = jacobian.solve(line.velocity(s) - p1.v)
        pull = jacobian.c1.perp() * (w * w)  # -omega^2 l u, the centripetal part
        g, acceleration = jacobian.solve(line.acceleration(s, speed) - p1.a - pull)
    sine = np.abs(reach) * (1.0 / length)
    dyad = Dyad(Turning(u, w, g), Sliding(s, speed, acceleration), sine, closure)
    return dyad.bounded(*_errors(p1, line, length, jacobian, dyad)) if certified else dyad


@np.errstate(divide="ignore", invalid="ignore", over="ignore")
def _errors(
    p1: PointKinematics,
    line: parts.MovingLine,
    length: float,
    jacobian: parts.Jacobian,
    dyad: Dyad[Turning, Sliding],
) -> tuple[AngleError, parts.SlideError]:
    assert p1.error is not None
    assert line.error is not None
    turning, sliding = dyad.first, dyad.second
    s, speed, w = sliding.s, sliding.speed, np.abs(turning.omega)
    gap = (p1.p + turning.turn * length - line.at(s)).norm()
    place, _, _ = line.errors(s, speed, 0.0, 0.0)
    size = p1.p.norm() + 5.0 * length + 1.5 * line.sizes(s, speed)[0]
    residual = gap + p1.error.position + place + EPS * size
    # The line turns with the error of its body: about the pin itself this opens no gap, yet it
    # moves the toggle.
    turn = line.error.theta + 2 * EPS
    slack = residual + turn * (np.abs(jacobian.det) + turn * length)

    def folds() -> tuple[Real, Real]:
        fold = 2.0 * np.abs(jacobian.det) + 2.5 * np.sqrt(slack * length)
        return np.minimum(fold / length + turn, np.pi), fold + slack + turn * length

    t, es = parts.certify(jacobian, residual, (length, 0.0, 0.0), folds, turn * length)
    certificate = parts.Certificate(jacobian, length * t, turn)
    _, drift, _ = line.errors(s, speed, es, 0.0)
    r, ev = certificate.above(
        w, speed, p1.error.velocity + drift, p1.v.norm() + line.sizes(s, speed)[1]
    )
    _, _, shove = line.errors(s, speed, es, ev)
    pull = length * (r * (2.0 * w + r) + w * w * t)
    g, ea = certificate.above(
        turning.alpha,
        sliding.acceleration,
        p1.error.acceleration + shove + pull,
        p1.a.norm() + length * w * w + line.sizes(s, speed)[2],
    )
    return AngleError(t + 6 * EPS, r, g), parts.SlideError(es, ev, ea)
