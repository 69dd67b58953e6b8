r"""Systems of linear equations in time, solved with bounds of their errors.

::

    A x0 + f = 0      A x1 + A' x0 + f' = 0      A x2 + 2 A' x1 + A'' x0 + f'' = 0

x1 and x2 are the derivatives of x by time, and one matrix solves all three. With C, a computed
inverse, the error e of a computed x obeys::

    e = C (residual of x) + (1 - C A) e

in which everything is known but for its bounds. Where 1 - C A is certainly below 1 as a map, that
bounds e; elsewhere, next to a singular position, nothing is certain, and the bound is infinite.
Source: S. M. Rump, Verification methods, Acta Numerica 19 (2010), section 10 (linear systems).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from analytic.dyads.plane import EPS
from models.array import Array, Mask

TERMS = 10
"""Rounding units of a product of a row, which has eight numbers but zeros, and of three sums."""


@dataclass(frozen=True)
class LinearSystem:
    """Equations at T samples: matrices (3, T, n, n) and right sides ``f`` (3, T, n, m) of m
    parameters, with their derivatives by time; ``off_matrix`` and ``off_f`` bound their errors.
    ``units`` are the sizes of the unknowns (n,)."""

    matrix: Array
    off_matrix: Array
    f: Array
    off_f: Array
    units: Array

    def solved(self) -> tuple[Array, Array]:
        """Return the unknowns and bounds of their errors, (3, T, n, m) each."""
        inverse = _inverse(self.matrix[0])
        growth, weight, spread = self._growth(inverse)
        share = (spread / (1.0 - spread))[:, None, None]
        size = np.abs(inverse)
        x, e = np.zeros_like(self.f), np.zeros_like(self.f)
        for k in range(3):
            for _ in range(2):  # the second time what rounding has left
                x[k] -= inverse @ self._residual(x, k)
            row = TERMS * EPS * self._sizes(np.abs(self.matrix), np.abs(self.f), np.abs(x), k)
            row += np.abs(self._residual(x, k))
            row += self._sizes(self.off_matrix, self.off_f, np.abs(x), k)
            row += self._sizes(np.abs(self.matrix) + self.off_matrix, 0.0 * self.f, e, k)
            first = size @ row
            most = (first / weight).max(axis=1, keepdims=True)
            bound = (first + growth @ first + (growth @ weight) * most * share) * (1.0 + 64 * EPS)
            sure = (spread < 0.9)[:, None, None] & np.isfinite(bound)
            e[k] = np.where(sure, bound, np.inf)
        return x, e

    def _residual(self, x: Array, k: int) -> Array:
        """Return what is left of the equations of order k, (T, n, m)."""
        return self._sizes(self.matrix, self.f, x, k)

    def _sizes(self, matrix: Array, f: Array, x: Array, k: int) -> Array:
        total = f[k] + matrix[0] @ x[k]
        if k == 1:
            total = total + matrix[1] @ x[0]
        if k == 2:
            total = total + 2.0 * (matrix[1] @ x[1]) + matrix[2] @ x[0]
        return np.asarray(total)

    def _growth(self, inverse: Array) -> tuple[Array, Array, Array]:
        """Return a bound of the entries of 1 - C A (T, n, n), sizes of the unknowns (T, n, 1) in
        which it is least as a map, nearly, and its size in them (T,)."""
        a, n = self.matrix[0], len(self.units)
        off = self.off_matrix[0] + (n + 2) * EPS * np.abs(a)
        growth = np.abs(np.eye(n) - inverse @ a) + np.abs(inverse) @ off
        units = self.units[:, None]
        weight = np.broadcast_to(units, (len(a), n, 1))
        for _ in range(5):  # to its largest eigenvector
            ahead = growth @ weight
            weight = ahead / (ahead / units).max(axis=1, keepdims=True) + 1e-3 * units
        return growth, weight, (growth @ weight / weight).max(axis=(1, 2))


def _inverse(matrix: Array) -> Array:
    """Return the inverses (T, n, n), not a number where there is none."""
    sound: Mask = np.asarray(np.isfinite(matrix).all(axis=(1, 2), keepdims=True))
    size = np.linalg.det(np.where(sound, matrix, 0.0)).reshape(sound.shape)
    sound = sound & (size != 0.0)
    return np.where(sound, np.linalg.inv(np.where(sound, matrix, np.eye(matrix.shape[-1]))), np.nan)
