"""The linear system of accelerations and multipliers, factored once for several right sides.

::

    | M      Phi_q^T |  | x      |     | top    |
    | Phi_q  -s      |  | lambda |  =  | bottom |

Where constraints are redundant the system with s = 0 is singular, though x is determined. A small s
makes it regular; a solution with s, put in again for what it leaves open, comes to that with s = 0
whose multipliers are the smallest (the proximal point method: each time what is open shrinks by s
over the least singular value of Phi_q M^-1 Phi_q^T that is not 0).
"""

from __future__ import annotations

import numpy as np
from scipy.linalg import lapack  # type: ignore[import-untyped]  # ships no stubs
from scipy.sparse import csc_array  # type: ignore[import-untyped]
from scipy.sparse.linalg import splu  # type: ignore[import-untyped]

from models.array import Array
from models.errors import CrankcheckError

SOFT = 1e-7
"""s of a redundant system, over the largest entry of its inverse mass."""
ROUNDS = 3
"""How often what a redundant system leaves open is put in again."""
SPARSE = 150
"""Unknowns from which on a factorisation that leaves out zeros is quicker."""


class Saddle:
    """One system, for a mass matrix (n, n) and a Jacobian (m, n); ``redundant`` if the rows of the
    Jacobian depend on each other. Raises CrankcheckError for one that is singular."""

    def __init__(self, mass: Array, jacobian: Array, *, redundant: bool) -> None:
        m, n = jacobian.shape
        self._count, self._redundant = n, redundant
        whole = np.zeros((n + m, n + m))
        whole[:n, :n], whole[n:, :n], whole[:n, n:] = mass, jacobian, jacobian.T
        self._soft = np.zeros(n + m)
        if redundant:
            lightest = np.diagonal(mass)[np.diagonal(mass) > 0.0].min()
            self._soft[n:] = SOFT / lightest
            whole[range(n, n + m), range(n, n + m)] = -self._soft[n:]
        self._whole = whole
        if len(whole) < SPARSE:
            *self._factors, singular = lapack.dgetrf(whole.T)  # symmetric: its rows are columns
            if singular > 0:
                raise singular_error()
        else:
            try:
                self._sparse = splu(csc_array(whole))
            except RuntimeError:
                raise singular_error() from None

    def solve(self, top: Array | float, bottom: Array | float) -> tuple[Array, Array]:
        """x (n,) and lambda (m,)."""
        right = np.empty(len(self._whole))
        right[: self._count], right[self._count :] = top, bottom
        found = self._once(right)
        if self._redundant:
            for _ in range(ROUNDS):
                left = right - self._whole @ found - self._soft * found
                found = found + self._once(left)
        return found[: self._count], found[self._count :]

    def _once(self, right: Array) -> Array:
        if len(self._whole) < SPARSE:
            return np.asarray(lapack.dgetrs(*self._factors, right)[0])
        return np.asarray(self._sparse.solve(right))


def singular_error() -> CrankcheckError:
    """What is said where the system has no one solution."""
    return CrankcheckError(
        "the equations of motion are singular: a freedom has no mass, or the mechanism is at a "
        "change point, where accelerations are not determined"
    )
