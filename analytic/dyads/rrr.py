"""RRR: two links between two known points, pinned to each other.

::

              C                    +1: C to the left of P1 -> P2
          l1 / \\ l2
           /    \\                  P1 + l1 u1 = P2 + l2 u2
         P1 ---- P2

Position from the triangle's sides (its area in Heron's form, so that no angle is formed); singular
where C lies on the line P1 P2 (toggle).
"""

import numpy as np

from analytic.dyads import parts
from analytic.dyads.parts import Dyad, Jacobian, Turning
from analytic.dyads.plane import EPS, AngleError, PointKinematics, Real, Vec


def solve(
    p1: PointKinematics,
    p2: PointKinematics,
    l1: float,
    l2: float,
    branch: Real,
    *,
    certified: bool = False,
    stretch: bool = False,
    root: Real | None = None,
) -> Dyad[Turning, Turning]:
    """Solve an RRR dyad.

    Parameters
    ----------
    p1, p2 : PointKinematics
        The outer pins.
    l1, l2 : float
        Distances of the inner pin C from P1 and from P2 [m].
    branch : int or Array
        +1 where C lies to the left of the line from P1 to P2, else -1.
    certified : bool
        Give error bounds; the points must then carry theirs.
    stretch : bool
        Where the dyad cannot close, take the two links in line instead of raising.
    root : Array or None
        Four times the area of the triangle [m^2], where it is known better than by its sides.

    Returns
    -------
    Dyad
        The directions P1 C and P2 C as turning unknowns; ``sine`` of the transmission angle.

    Raises
    ------
    OpenError
        The pins are too far apart, or too near.

    Notes
    -----
    Error about eps (|P1| + |P2| + l1 + l2) / (l sine) in the angles; rates and accelerations lose
    another factor 1 / sine relative to their size.
    """
    d = p2.p - p1.p
    d2 = d.square()
    # Heron: (4 area)^2 = ((l1 + l2)^2 - d^2) (d^2 - (l1 - l2)^2), below 0 where it cannot close.
    outer, inner = (l1 + l2) ** 2, (l1 - l2) ** 2
    square = outer - d2
    square *= d2 - inner

    def shortage() -> tuple[Real, Real, Real]:
        apart = np.sqrt(d2)
        scale = apart + l1 + l2 + p1.p.norm() + p2.p.norm()
        short = np.maximum(apart - (l1 + l2), abs(l1 - l2) - apart)
        return short, scale, parts.uncertain(p1, p2)

    root, closure = parts.closing_root(square, shortage, stretch, root)
    with np.errstate(divide="ignore", invalid="ignore"):
        # The foot of C on d by the law of cosines, (d^2 + l1^2 - l2^2) / (2 d^2), and its height
        # 2 area / d^2, both over d: r1 is d turned and stretched by them.
        inverse = 1.0 / d2
        along = (0.5 * (l1 - l2) * (l1 + l2)) * inverse
        along += 0.5
        inverse *= 0.5 * branch
        inverse *= root  # now the height
        r1 = d.turned(Vec(along, inverse))
        r2 = r1 - d
        # Cramer's rule with the columns r1' and -r2' (turned by 90 deg): their cross product is
        # minus twice the area, and a cross product with a turned vector is a dot product.
        inverse = (-2.0 * branch) / root  # now 1 over that cross product
        relative = p1.v - p2.v
        w1, w2 = relative.dot(r2), relative.dot(r1)
        w1 *= inverse
        w2 *= inverse
        # The rest for alpha after the centripetal parts, omega^2 r towards the outer pins.
        relative = (p1.a - p2.a).less(r1, w1 * w1).more(r2, w2 * w2)
        g1, g2 = relative.dot(r2), relative.dot(r1)
        g1 *= inverse
        g2 *= inverse
    sine = root * (0.5 / (l1 * l2))
    first, second = Turning(r1, w1, g1, None, l1), Turning(r2, w2, g2, None, l2)
    dyad = Dyad(first, second, sine, closure)
    if not certified:
        return dyad
    jacobian = Jacobian(r1.perp(), r2.perp(-1.0), (-0.5 * branch) * root)
    return dyad.bounded(*_errors(p1, p2, jacobian, dyad, np.sqrt(d2)))


@np.errstate(divide="ignore", invalid="ignore", over="ignore")
def _errors(
    p1: PointKinematics,
    p2: PointKinematics,
    jacobian: Jacobian,
    dyad: Dyad[Turning, Turning],
    apart: Real,
) -> tuple[AngleError, AngleError]:
    assert p1.error is not None
    assert p2.error is not None
    first, second = dyad.first, dyad.second
    l1, l2 = first.length, second.length
    # The computed vectors close up to the rounding of their difference; they are not quite as
    # long as the links, whose lengths are rounded too.
    off1, off2 = np.abs(first.turn.norm() - l1), np.abs(second.turn.norm() - l2)
    residual = off1 + off2 + p1.error.position + p2.error.position + 4 * EPS * (l1 + l2)
    # The determinant comes from Heron's area, the columns from a vector that is d turned.
    skew = 2 * EPS * l1 * apart
    t1, t2 = parts.certify(
        jacobian, residual, (l1, 0.0, l2), lambda: _folds(jacobian, residual, apart, dyad), skew
    )
    certificate = parts.Certificate(jacobian, l1 * t1, l2 * t2, skew)
    w1, w2 = np.abs(first.omega), np.abs(second.omega)
    r1, r2 = certificate.above(
        w1, w2, p1.error.velocity + p2.error.velocity, p1.v.norm() + p2.v.norm()
    )
    pulls = l1 * (r1 * (2.0 * w1 + r1) + w1 * w1 * t1) + l2 * (r2 * (2.0 * w2 + r2) + w2 * w2 * t2)
    a1, a2 = certificate.above(
        first.alpha,
        second.alpha,
        p1.error.acceleration + p2.error.acceleration + pulls,
        p1.a.norm() + p2.a.norm() + l1 * w1 * w1 + l2 * w2 * w2,
    )
    t1, t2 = t1 + off1 / l1, t2 + off2 / l2  # what hangs on a link takes its vector, length and all
    return AngleError(t1 + 4 * EPS, r1, a1), AngleError(t2 + 4 * EPS, r2, a2)


def _folds(
    jacobian: Jacobian, residual: Real, apart: Real, dyad: Dyad[Turning, Turning]
) -> tuple[Real, Real]:
    """Return bounds of the angles where the first order fails: of the line between the outer pins,
    and of the links against it.

    By a residual e the foot of C on the line, x1 from P1 and x2 from P2, moves along it by up to
    e / d (|x2| + |x1 - x2| e / d) and a little, which turns the links by that over its height;
    where that is small, or the links in line, by twice the height and the square root of it.
    """
    l1, l2 = dyad.first.length, dyad.second.length
    line = np.pi * residual / apart
    height = np.abs(jacobian.det) / apart
    fold = 2.0 * height + 2.5 * np.sqrt(residual * l1 * l2 / apart)
    base = dyad.first.turn - dyad.second.turn
    share = residual / apart
    found = []
    for one, other in ((dyad.first, dyad.second), (dyad.second, dyad.first)):
        far = np.abs(base.dot(other.turn)) / apart
        near = np.abs(base.dot(one.turn)) / apart
        shift = 2.0 * share * (far + (far + near) * share)
        small = (share <= 0.25) & (4.0 * one.length * shift <= height * height)
        swing = np.where(small, 2.0 * shift / height, fold / one.length)
        # No angle is wrong by more than half a turn, not even one without a solution (NaN).
        found.append(np.fmin(np.fmin(swing, fold / one.length) + line, np.pi))
    return found[0], found[1]
