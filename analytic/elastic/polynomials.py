"""Polynomials over the whole link: what comes to a smooth deflection with the fewest functions.

Legendre's, integrated once, so that they are 0 at both ends; along the link a straight line is the
first. An even load and a linear one bend a beam to polynomials of degree 5, which four of these
hold exactly, where sines come to them as i^-5. Source: B. Szabo, I. Babuska, Finite Element
Analysis, chapter 3 (the p-version).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.polynomial import legendre

from analytic.elastic.whole_link import WholeLink
from models.array import Array


@dataclass(frozen=True)
class LegendrePolynomials(WholeLink):
    """``across`` polynomials of degrees 2, 3, ... and ``along`` ones of degrees 1, 2, ...
    (`Shapes`)."""

    @property
    def nodes(self) -> int:
        """Two slopes integrated are of degree 2 m + 1."""
        return 2 * max(self.across, self.along) + 2

    def deflections(self, x: Array, order: int) -> Array:
        return self._integrated(x, range(1, 1 + self.across), order)

    def extensions(self, x: Array, order: int) -> Array:
        return self._integrated(x, range(self.along), order)

    def _integrated(self, x: Array, degrees: range, order: int) -> Array:
        """Integrals from 0 of Legendre's polynomials of degrees, times the square root of 2 k + 1,
        or derivatives of these integrals."""
        share, values = 2.0 * x / self.length_m - 1.0, np.empty((len(x), len(degrees)))
        for column, degree in enumerate(degrees):
            whole = legendre.legint(np.eye(degree + 1)[degree], lbnd=-1)
            own = legendre.legder(whole, order) if order else whole
            values[:, column] = legendre.legval(share, own) * np.sqrt(2.0 * degree + 1.0)
        return np.asarray(values * (2.0 / self.length_m) ** order)
