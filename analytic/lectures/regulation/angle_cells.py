"""The cycle in cells of the driver's angle, between whose borders all that acts is smooth, and
polynomials through Gauss's nodes in them.

Source: E. Hairer, S. P. Norsett, G. Wanner, Solving Ordinary Differential Equations I, II.7, on
collocation: with s nodes the borders are right to the order 2 s.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from models.array import Array

NODES = 5
CELLS = 120
"""Cells of a turn, before it is cut where something is not smooth."""
APART = 1e-9
"""Borders nearer to each other than this, over the cycle, are one."""


def _lagrange() -> tuple[Array, Array]:
    """Gauss's nodes in (0, 1), and by row the coefficients, that of x^0 first, of the integrals
    from 0 of the polynomials that are 1 in one node and 0 in the others."""
    nodes = 0.5 * (np.polynomial.legendre.leggauss(NODES)[0] + 1.0)
    # Column j of the inverse of the Vandermonde matrix holds the coefficients of polynomial j.
    own = np.linalg.inv(np.vander(nodes, increasing=True)).T
    powers = np.arange(1, NODES + 1)
    return nodes, np.concatenate([np.zeros((NODES, 1)), own / powers], axis=1)


PLACES, INTEGRALS = _lagrange()


def integrals_to(share: Array) -> Array:
    """The integrals of the polynomials from 0 to shares of a cell, (..., NODES)."""
    return np.asarray(np.vander(np.ravel(share), NODES + 1, increasing=True) @ INTEGRALS.T).reshape(
        (*np.shape(share), NODES)
    )


INSIDE: Array = integrals_to(PLACES)
"""Butcher's matrix (NODES, NODES): the integrals to each node."""
WHOLE: Array = integrals_to(np.array(1.0))
"""The weights of Gauss's quadrature, (NODES,)."""
LEGENDRE: Array = (
    (2 * np.arange(NODES) + 1)
    * WHOLE[:, None]
    * np.polynomial.legendre.legvander(2.0 * PLACES - 1.0, NODES - 1)
)
"""The coefficients of Legendre's polynomials, by column, of a quantity at the nodes (by row)."""


@dataclass(frozen=True)
class AngleCells:
    """Cells between increasing ``borders`` (C + 1,) of the angle u [rad], the first of them 0."""

    borders: Array

    @staticmethod
    def of(cycle_rad: float, breaks: Array) -> AngleCells:
        """Even cells of a cycle, cut at ``breaks`` as well."""
        count = CELLS * max(1, round(cycle_rad / math.tau))
        every = np.unique(np.concatenate([np.linspace(0.0, cycle_rad, count + 1), breaks]))
        every = every[(every >= 0.0) & (every <= cycle_rad)]
        inner = every[np.concatenate([[True], np.diff(every) > APART * cycle_rad])]
        inner = inner[inner < cycle_rad * (1.0 - APART)]
        return AngleCells(np.append(inner, cycle_rad))

    @property
    def widths(self) -> Array:
        """(C,) [rad]."""
        return np.diff(self.borders)

    @property
    def nodes(self) -> Array:
        """Gauss's nodes (C, NODES) [rad]."""
        return self.borders[:-1, None] + self.widths[:, None] * PLACES

    def places(self, u: Array) -> tuple[NDArray[np.intp], Array]:
        """The cells that angles are in, and how far, as a share of the cell."""
        cell = np.clip(np.searchsorted(self.borders, u, side="right") - 1, 0, len(self.widths) - 1)
        return cell, (u - self.borders[cell]) / self.widths[cell]

    def integral(self, series: Array) -> float:
        """Of a quantity at the nodes (C, NODES), over the cycle."""
        return float(np.sum(self.widths[:, None] * WHOLE * series))

    def integrated(self, series: Array, u: Array) -> Array:
        """The integrals from 0 to angles u (T,) of a quantity at the nodes."""
        parts = self.widths * (series @ WHOLE)
        before = np.concatenate([[0.0], np.cumsum(parts)])
        cell, share = self.places(u)
        inner = np.sum(integrals_to(share) * series[cell], axis=1)
        return np.asarray(before[cell] + self.widths[cell] * inner)
