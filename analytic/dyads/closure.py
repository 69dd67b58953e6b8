"""The vector loop of a dyad: two unknowns, one 2 x 2 Jacobian, and what rounding does to them.

Every class II dyad closes one vector equation f(q1, q2) = 0 with df = c1 dq1 + c2 dq2. Rates and
accelerations follow from the same two columns::

    c1 q1' + c2 q2' = b_v          c1 q1'' + c2 q2'' = b_a

so that one determinant, c1 x c2, carries the conditioning of all three levels.

The certificate is a posteriori. The residual of the computed position, plus the rounding of its
evaluation, plus the errors of the inputs, is a bound on f at the exact inputs; multiplied by the
inverse of the Jacobian it bounds the error of the unknowns to first order, and up to twice that
bounds it fully as long as the curvature of f over that distance spends no more than the residual
itself (Newton-Kantorovich). Where that fails the dyad is within about the square root of rounding
of its toggle: each dyad then gives the width of its fold, and rates are not certain at all
(infinite).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from analytic.dyads.plane import EPS, Real, Vec

ROUNDING = 3 * EPS
"""Rounding of the rates that solve a loop equation, over the sum of the lengths of its terms: a
cross product takes 1, the quotient and the terms on its right side another 2."""


@dataclass(frozen=True, slots=True)
class Jacobian:
    """The columns c1, c2 of a dyad's loop equation, and their determinant c1 x c2."""

    c1: Vec
    c2: Vec
    det: Real

    def solve(self, b: Vec) -> tuple[Real, Real]:
        """The q1, q2 with c1 q1 + c2 q2 = b, by Cramer's rule."""
        return b.cross(self.c2) / self.det, self.c1.cross(b) / self.det


@dataclass(frozen=True, slots=True)
class Curvature:
    """Bounds on the second derivatives of f: q1 q1, q1 q2, q2 q2."""

    m11: Real
    m12: Real
    m22: Real

    def remainder(self, e1: Real, e2: Real) -> Real:
        """The largest second-order term over a box of half-widths e1, e2."""
        return 0.5 * self.m11 * e1 * e1 + self.m12 * e1 * e2 + 0.5 * self.m22 * e2 * e2


@dataclass(frozen=True, slots=True)
class Certificate:
    """Error bounds of a dyad's unknowns at position level, and the way to those above it.

    ``e1``, ``e2`` bound the unknowns; ``d1``, ``d2`` bound the columns of the Jacobian. ``skew`` is
    what rounding may put between the determinant that rates are divided by and that of the columns,
    where it is more than `ROUNDING` of their lengths.
    """

    jacobian: Jacobian
    e1: Real
    e2: Real
    d1: Real
    d2: Real
    skew: Real = 0.0

    def above(self, q1: Real, q2: Real, error_of_b: Real, size_of_b: Real) -> tuple[Real, Real]:
        """Bounds on rates (or accelerations) q1, q2 that solve the loop with right side b.

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
        # What comes from a singular dyad before this one may be 0 times infinity: not certain.
        sure = (left > 0.0) & (residual < np.inf)
        e1 = np.where(sure, ((n2 + self.d2) * residual + a1 * self.skew) / left, np.inf)
        e2 = np.where(sure, ((n1 + self.d1) * residual + a2 * self.skew) / left, np.inf)
        return e1, e2


def certify(
    jacobian: Jacobian,
    residual: Real,
    curvature: Curvature,
    folds: Callable[[], tuple[Real, Real]],
    lost: Real = 0.0,
) -> tuple[Real, Real]:
    """Bounds on the errors of a dyad's two unknowns at position level.

    Parameters
    ----------
    jacobian : Jacobian
        At the computed position.
    residual : Array or float
        Bound on |f| at the computed position and the exact inputs [m].
    curvature : Curvature
        Bounds on the second derivatives of f nearby.
    folds : Callable
        What the errors of the unknowns are at most beside the toggle, where the first order
        no longer says anything; asked for only where it matters.
    lost : Array or float
        What the errors of the inputs may take off the determinant, where its columns hold any.
    """
    n1, n2 = jacobian.c1.norm(), jacobian.c2.norm()
    inverse = 1.0 / np.maximum(np.abs(jacobian.det) - lost, 0.0)
    e1, e2 = n2 * residual * inverse, n1 * residual * inverse
    share = 4.0 * curvature.remainder(e1, e2) / residual
    valid = share <= 1.0
    # The error is at most x times the first order, where x = 1 + (share / 4) x^2.
    grown = 1.01 + share
    e1, e2 = grown * e1, grown * e2
    if np.all(valid):
        return e1, e2
    fold1, fold2 = folds()
    return np.where(valid, e1, fold1), np.where(valid, e2, fold2)
