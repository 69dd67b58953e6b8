"""RPR: a block pinned at a known point slides on a link that turns about another known point.

::

           P1 block                +1: the block lies from the foot of P2 on the line
          /                            in the line's direction
         /  e                      P1 = P2 + s e + h e'      (e' = e turned by +90 deg)
       P2  (line at distance h)

Singular where s = 0: the line is tangent to the circle about P2 of radius h.
"""

import numpy as np

from analytic.dyads import parts
from analytic.dyads.parts import Dyad, Sliding, Turning
from analytic.dyads.plane import EPS, AngleError, PointKinematics, Real


def solve(
    p1: PointKinematics,
    p2: PointKinematics,
    offset: float,
    branch: Real,
    *,
    certified: bool = False,
    stretch: bool = False,
    root: Real | None = None,
) -> Dyad[Turning, Sliding]:
    """Solve an RPR dyad.

    Parameters
    ----------
    p1 : PointKinematics
        The pin of the block.
    p2 : PointKinematics
        The pin of the link that carries the line.
    offset : float
        Distance h of the line from P2 [m], positive to the left of its direction.
    branch : int or Array
        The sign of the displacement s.
    certified, stretch, root
        As for `analytic.dyads.rrr.solve`; the root is the size of s [m].

    Returns
    -------
    Dyad
        The direction of the line, and the displacement s along it from the foot of P2;
        ``sine`` is |s| over the distance of the pins.

    Raises
    ------
    OpenError
        The pins are nearer to each other than the line is to P2.

    Notes
    -----
    Error about eps (|P1| + |P2|) / |s| in the angle.
    """
    d = p1.p - p2.p
    d2 = d.square()
    square = d2 - offset * offset if offset else d2

    def shortage() -> tuple[Real, Real, Real]:
        apart = np.sqrt(d2)
        scale = abs(offset) + apart + p1.p.norm() + p2.p.norm()
        return abs(offset) - apart, scale, parts.uncertain(p1, p2)

    root, closure = parts.closing_root(square, shortage, stretch, root)
    s = branch * root
    with np.errstate(divide="ignore", invalid="ignore"):
        # d = s e + h e', solved for e.
        along = (d * s - d.perp() * offset) * (1.0 / d2)
        across = along.perp()
        jacobian = parts.Jacobian(across * s - along * offset, along, -s)
        w, speed = jacobian.solve(p1.v - p2.v)
        # The centripetal part of d goes over to the right side, and so does Coriolis'.
        inertia = d * (w * w) - across * (2.0 * w * speed)
        g, acceleration = jacobian.solve(p1.a - p2.a + inertia)
        sine = np.abs(s) / np.sqrt(d2)
    dyad = Dyad(Turning(along, w, g), Sliding(s, speed, acceleration), sine, closure)
    return dyad.bounded(*_errors(p1, p2, offset, jacobian, dyad)) if certified else dyad


@np.errstate(divide="ignore", invalid="ignore", over="ignore")
def _errors(
    p1: PointKinematics,
    p2: PointKinematics,
    offset: float,
    jacobian: parts.Jacobian,
    dyad: Dyad[Turning, Sliding],
) -> tuple[AngleError, parts.SlideError]:
    assert p1.error is not None
    assert p2.error is not None
    turning, sliding = dyad.first, dyad.second
    s, along = sliding.s, turning.turn
    w, v = np.abs(turning.omega), np.abs(sliding.speed)
    arm = np.hypot(s, offset)
    gap = (p1.p - p2.p - along * s - along.perp() * offset).norm()
    # Half a unit of the distance of the pins, and the excess of the line's direction over 1.
    residual = gap + p1.error.position + p2.error.position + 5 * EPS * (np.abs(s) + abs(offset))

    def folds() -> tuple[Real, Real]:
        fold: Real = 2.0 * np.abs(s) + 2.0 * np.sqrt(residual * (arm + residual))
        # Where the two pins nearly meet the direction of the line is not determined at all.
        turn = np.where(arm > 2.0 * residual, np.fmin(np.pi, 2.0 * fold / arm), np.pi)
        return turn, fold + residual

    t, es = parts.certify(jacobian, residual, (arm, 1.0, 0.0), folds)
    certificate = parts.Certificate(jacobian, arm * t + es, t)
    r, ev = certificate.above(
        w, v, p1.error.velocity + p2.error.velocity, p1.v.norm() + p2.v.norm()
    )
    swing = r * (2.0 * w + r) * (arm + arm * t + es) + w * w * (arm * t + es)
    coriolis = 2.0 * ((w + r) * (v + ev) - w * v + w * v * t)
    g, ea = certificate.above(
        turning.alpha,
        sliding.acceleration,
        p1.error.acceleration + p2.error.acceleration + swing + coriolis,
        p1.a.norm() + p2.a.norm() + w * w * arm + 2.0 * w * v,
    )
    return AngleError(t + 6 * EPS, r, g), parts.SlideError(es, ev, ea)
