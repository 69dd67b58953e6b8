"""Input and output of the dyad solvers: turning and sliding unknowns, moving lines, closure.

Every class II dyad closes one vector equation f(q1, q2) = 0 with df = c1 dq1 + c2 dq2. Rates and
accelerations follow from the same two columns::

    c1 q1' + c2 q2' = b_v          c1 q1'' + c2 q2'' = b_a

so that one determinant, c1 x c2, carries the conditioning of all three levels.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, Generic, NamedTuple, TypeVar

import numpy as np

from analytic.dyads.plane import EPS, AngleError, PointKinematics, Real, Vec
from models.array import Array

CLOSED = 16 * EPS
"""Gap of a closed dyad by rounding, over the lengths in its closure."""


@dataclass(frozen=True, slots=True)
class Turning:
    """Unknown rotation: a vector of constant ``length`` at its angle, its rate [rad/s] and
    acceleration [rad/s^2], bounds if required."""

    turn: Vec
    omega: Real
    alpha: Real
    error: AngleError | None = None
    length: float = 1.0


class SlideError(NamedTuple):
    """Bounds on a slider's displacement [m], speed [m/s], acceleration [m/s^2]."""

    displacement: Real
    speed: Real
    acceleration: Real


@dataclass(frozen=True, slots=True)
class Sliding:
    """Unknown displacement [m], its rate [m/s] and acceleration [m/s^2], bounds if required."""

    s: Real
    speed: Real
    acceleration: Real
    error: SlideError | None = None


First = TypeVar("First", Turning, Sliding)
Second = TypeVar("Second", Turning, Sliding)


@dataclass(frozen=True, slots=True)
class MovingLine:
    """Line of a known body: a point of it, its direction, and the rotation of the body."""

    point: PointKinematics
    along: Vec
    omega: Real
    alpha: Real
    error: AngleError | None

    def at(self, s: Real) -> Vec:
        """Return the place at displacement ``s`` from the point."""
        ahead: Vec = self.along * s
        return self.point.p + ahead

    def velocity(self, s: Real) -> Vec:
        """Return the velocity of the body's own point there."""
        return self.along.perp(self.omega * s) + self.point.v

    def acceleration(self, s: Real, speed: Real) -> Vec:
        """Return the acceleration there at sliding ``speed``, Coriolis in, without its own."""
        across = self.alpha * s + 2.0 * self.omega * speed
        return (self.point.a + self.along.perp(across)).less(self.along, self.omega**2 * s)

    def errors(self, s: Real, speed: Real, es: Real, ev: Real) -> tuple[Real, Real, Real]:
        """Return error bounds of `at`, `velocity`, `acceleration` for errors es, ev of s, speed."""
        assert self.point.error is not None
        assert self.error is not None
        e, p = self.error, self.point.error
        w, g, d, v = abs(self.omega), abs(self.alpha), np.abs(s), np.abs(speed)
        shift = d * e.theta + es
        gain = e.alpha + e.omega * (2.0 * w + e.omega)
        position = p.position + d * e.theta
        velocity = p.velocity + d * e.omega + (w + e.omega) * shift
        coriolis = v * e.omega + (w + e.omega) * ev + w * v * e.theta
        acceleration = p.acceleration + d * gain + (g + w * w + gain) * shift + 2.0 * coriolis
        return position, velocity, acceleration

    def sizes(self, s: Real, speed: Real) -> tuple[Real, Real, Real]:
        """Return the sums of the lengths of the terms of `at`, `velocity`, `acceleration`."""
        w, d = abs(self.omega), np.abs(s)
        return (
            self.point.p.norm() + d,
            self.point.v.norm() + w * d,
            self.point.a.norm() + (abs(self.alpha) + w * w) * d + 2.0 * w * np.abs(speed),
        )


@dataclass(frozen=True, slots=True)
class Closure:
    """Closure of a dyad.

    ``root`` has the branch as its sign, None for a dyad of one assembly; 0 where it is singular.
    ``short_m``, given for a stretched solution only, is the shortage of closure [m] (negative: it
    closes), less half of ``rounding_m``, the possible gap by rounding. With a shortage above
    ``slack_m`` it closes nowhere within the bounds of its inputs. ``square``, also for a stretched
    solution only, is that of the root, below 0 where the dyad is open.
    """

    root: Real | None
    short_m: Real | None = None
    rounding_m: Real = 0.0
    slack_m: Real = 0.0
    square: Real | None = None


@dataclass(frozen=True, slots=True)
class Dyad(Generic[First, Second]):
    """Solved dyad; ``sine`` is its conditioning (1 best, 0 singular)."""

    first: First
    second: Second
    sine: Real
    closure: Closure

    def bounded(self, first: Any, second: Any) -> Dyad[First, Second]:
        """Return the dyad with the bounds of its two unknowns, each of its own kind."""
        one, other = replace(self.first, error=first), replace(self.second, error=second)
        return replace(self, first=one, second=other)


def uncertain(one: PointKinematics, other: PointKinematics) -> Real:
    """Return the error of the distance of two points [m]; 0 where they carry no bounds."""
    if one.error is None or other.error is None:
        return 0.0
    return one.error.position + other.error.position


class OpenError(Exception):
    """The dyad cannot be assembled at some samples.

    ``short_m`` is the shortage of closure at each sample (positive where open) [m].
    """

    def __init__(self, short_m: Array) -> None:
        self.short_m = short_m
        super().__init__(f"the dyad is open by up to {np.max(short_m):.3g} m")


def closing_root(
    square: Real,
    shortage: Callable[[], tuple[Real, Real, Real]],
    stretch: bool,
    root: Real | None = None,
) -> tuple[Real, Closure]:
    """Return the square root in a closure, 0 where rounding has taken its argument below 0.

    Parameters
    ----------
    square : Array or float
        Positive where the dyad closes.
    shortage : Callable
        Shortage of closure [m] (negative: it closes), the sum of the lengths and coordinates that
        it is the difference of, and its error by the inputs; called only where it matters.
    stretch : bool
        Solve the dyad as if stretched where it is open, instead of raising.
    root : Array or None
        The root, where it is known better than by the difference ``square``.

    Returns
    -------
    tuple
        The root, and the closure of the dyad.

    Raises
    ------
    OpenError
        Where the dyad is open by more than rounding.
    """
    if stretch:
        # A little less is allowed than when solving, so that the ends of a range can be solved.
        short, scale, slack = shortage()
        rounding = CLOSED * scale
        if root is None:
            root = np.sqrt(np.maximum(square, 0.0))
        return root, Closure(root, short - 0.5 * rounding, rounding, slack + rounding, square)
    if np.min(square) < 0.0:
        short, scale, _ = shortage()
        if np.any(short > CLOSED * scale):
            raise OpenError(np.broadcast_to(np.asarray(short), np.shape(square)))
        root = np.sqrt(np.maximum(square, 0.0))
    else:
        root = np.sqrt(square)
    return root, Closure(root)


ROUNDING = 3 * EPS
"""Rounding of the rates that solve a loop equation, over the sum of the lengths of its terms: a
cross product takes 1, the quotient and the terms on its right side another 2."""


@dataclass(frozen=True, slots=True)
class Jacobian:
    """Columns c1, c2 of a dyad's loop equation, and their determinant c1 x c2."""

    c1: Vec
    c2: Vec
    det: Real

    def solve(self, b: Vec) -> tuple[Real, Real]:
        """Return the q1, q2 with c1 q1 + c2 q2 = b, by Cramer's rule."""
        return b.cross(self.c2) / self.det, self.c1.cross(b) / self.det


@dataclass(frozen=True, slots=True)
class Certificate:
    """Error bounds of a dyad at position level, for those of its rates.

    ``d1``, ``d2`` bound the columns of the Jacobian. ``skew`` is the rounding between the
    determinant that rates are divided by and that of the columns, where it is more than `ROUNDING`
    of their lengths.
    """

    jacobian: Jacobian
    d1: Real
    d2: Real
    skew: Real = 0.0

    def above(self, q1: Real, q2: Real, error_of_b: Real, size_of_b: Real) -> tuple[Real, Real]:
        """Return bounds on rates (or accelerations) q1, q2 that solve the loop with right side b.

        ``error_of_b`` bounds the error of b from its inputs; ``size_of_b`` is the sum of the
        lengths of its terms, of which rounding takes its share.
        """
        n1, n2 = self.jacobian.c1.norm(), self.jacobian.c2.norm()
        a1, a2 = np.abs(q1), np.abs(q2)
        residual = (
            error_of_b + a1 * self.d1 + a2 * self.d2 + ROUNDING * (size_of_b + n1 * a1 + n2 * a2)
        )
        lost = self.d1 * n2 + n1 * self.d2 + self.d1 * self.d2 + 4 * EPS * n1 * n2 + self.skew
        left = np.abs(self.jacobian.det) - lost
        # A singular dyad before this one may give 0 times infinity: not certain.
        sure = (left > 0.0) & (residual < np.inf)
        e1 = np.where(sure, ((n2 + self.d2) * residual + a1 * self.skew) / left, np.inf)
        e2 = np.where(sure, ((n1 + self.d1) * residual + a2 * self.skew) / left, np.inf)
        return e1, e2


def certify(
    jacobian: Jacobian,
    residual: Real,
    curvature: tuple[Real, Real, Real],
    folds: Callable[[], tuple[Real, Real]],
    lost: Real = 0.0,
) -> tuple[Real, Real]:
    """Return bounds on the errors of a dyad's two unknowns at position level.

    The certificate is a posteriori. The residual of the computed position, plus the rounding of its
    evaluation, plus the errors of the inputs, is a bound on f at the exact inputs; multiplied by
    the inverse of the Jacobian it bounds the error of the unknowns to first order, and up to twice
    that bounds it fully as long as the curvature of f over that distance spends no more than the
    residual itself (Newton-Kantorovich). Elsewhere the dyad is within about the square root of
    rounding of its toggle: each dyad then gives the width of its fold, and rates are not certain at
    all (infinite).

    Parameters
    ----------
    jacobian : Jacobian
        At the computed position.
    residual : Array or float
        Bound on |f| at the computed position and the exact inputs [m].
    curvature : tuple
        Bounds on the second derivatives of f nearby: q1 q1, q1 q2, q2 q2.
    folds : Callable
        Largest errors of the unknowns beside the toggle, where the first order fails; called only
        where it matters.
    lost : Array or float
        Change of the determinant by the errors of the inputs, where its columns hold any.
    """
    n1, n2 = jacobian.c1.norm(), jacobian.c2.norm()
    inverse = 1.0 / np.maximum(np.abs(jacobian.det) - lost, 0.0)
    e1, e2 = n2 * residual * inverse, n1 * residual * inverse
    m11, m12, m22 = curvature
    share = 4.0 * (0.5 * m11 * e1 * e1 + m12 * e1 * e2 + 0.5 * m22 * e2 * e2) / residual
    valid = share <= 1.0
    # The error is at most x times the first order, where x = 1 + (share / 4) x^2.
    grown = 1.01 + share
    e1, e2 = grown * e1, grown * e2
    if np.all(valid):
        return e1, e2
    fold1, fold2 = folds()
    return np.where(valid, e1, fold1), np.where(valid, e2, fold2)
